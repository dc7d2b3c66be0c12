#pragma once
// Reuse of points: which points of the cloud can be shown in a pixel.
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/cloud/depth_grid.h"
#include "core/cloud/point.h"
#include "core/cloud/primary_visibility.h"
#include "core/cloud/projection.h"

namespace lightwalk {

/// Why a pixel has to be traced, the worst cause first.
enum class TraceCause : std::uint8_t {
    none,          ///< it need not be traced
    uncovered,     ///< no point is projected there
    hidden,        ///< the points there are not of the surface that the ray meets
    never_reused,  ///< its colour holds for this ray only
    turned,        ///< the point was seen from a too different direction
    uneven,        ///< the points around it differ, and none is near enough
    audited,       ///< points answer it, but it is traced to measure their error
    refined,       ///< points answer it, but the view stands still, and there is time to refine it
};
inline constexpr std::size_t kTraceCauses = 8;

/// Conditions under which a pixel may reuse a point.
struct ReuseRules {
    /// Search around the pixel for the nearest point of what its ray meets; false: only the point
    /// projected onto the pixel counts (forward projection alone).
    bool look_back = true;
    float near = 1;      ///< a point within this distance of the ray is always reused [pixels]
    float reach = 1.5f;  ///< a point within this distance is reused where the points around agree;
                         ///< in between, the less they agree the nearer it has to be [pixels]
    float contrast =
        0.1f;              ///< largest difference of points that agree, as a share of the brightest
    double tightness = 1;  ///< factor of CloudPoint::max_view_angle, 0 ... 1
    // For pixels that are not checked by a ray:
    bool drop_hidden =
        true;  ///< ignore a point far behind most of those around it: it is seen through a gap
    bool drop_lonely = true;  ///< ignore a point far from all those around it: it may be stale
};

/// The points that a pixel reuses: up to two, whose sum it shows.
struct PixelAnswer {
    TraceCause cause = TraceCause::uncovered;
    std::uint32_t ahead = kNoPoint, mirrored = kNoPoint;
    float apart = 0;  ///< distance of the farther point from the pixel's ray [pixels]
    Rgb radiance;     ///< of these points; where none is near, of points around [W/(m² sr)]
    [[nodiscard]] bool found() const { return cause == TraceCause::none; }
};

/// The state of the grids in a square of 8 x 8 pixels, aligned to multiples of 8, and of the cells
/// adjacent to it.
struct PixelSquare {
    PixelPlace corner;
    DepthGrid::Surroundings ahead;
    bool mirrors = false;  ///< whether it holds points seen in mirrors

    [[nodiscard]] std::size_t at(const PixelPlace& pixel) const {
        return static_cast<std::size_t>(pixel.y - corner.y) * DepthGrid::Surroundings::kSide +
               static_cast<std::size_t>(pixel.x - corner.x);
    }
    /// Whether no point is near enough for a pixel, whatever its ray sees.
    [[nodiscard]] bool is_blank(const PixelPlace& pixel) const {
        return !mirrors && ahead.known[at(pixel)] == 0;
    }
};

/// Finds points for the pixels of one frame. All arguments must outlive it; many threads may use it
/// at once.
class PointFinder {
  public:
    PointFinder(const PointProjector& projector, std::span<const CloudPoint> points,
                const CloudGrids& grids, std::span<const ImagePlace> places,
                const ReuseRules& rules)
        : projector_(projector), points_(points), grids_(grids), places_(places), rules_(rules) {}

    /// Prefetch the cells of a pixel that will be checked soon.
    [[gnu::always_inline]] void expect(const PixelPlace& pixel) const {
        grids_.ahead.prefetch(pixel.x, pixel.y);
        grids_.mirrored.prefetch(pixel.x, pixel.y);
    }
    /// The surface of the point that is projected onto a pixel; nothing where there is none.
    [[nodiscard]] std::optional<std::uint32_t> surface_at(const PixelPlace& pixel) const {
        const std::uint32_t index = grids_.ahead.winner(pixel.x, pixel.y);
        if (index == kNoPoint) return std::nullopt;
        return points_[index].surface;
    }
    /// The answer for a pixel whose ray has been probed.
    [[nodiscard]] PixelAnswer checked(const PixelPlace& pixel,
                                      const PixelVisibility& visibility) const;
    /// The answers for many probed pixels: faster than one by one, as their memory is prefetched
    /// together.
    void checked(std::span<const PixelPlace> pixels, std::span<const PixelVisibility> visibility,
                 std::span<PixelAnswer> answers) const;
    /// The answer for a pixel that is not probed: the point projected onto it.
    [[nodiscard]] PixelAnswer unchecked(const PixelPlace& pixel) const;
    /// The square that a pixel lies in.
    [[nodiscard]] PixelSquare square_of(const PixelPlace& pixel) const;
    /// Approximate answers for pixels of a square that are shown for a moment only: the points
    /// projected onto them, whatever direction they were seen from, or, in the interior of a
    /// surface, points around.
    void unverified(const PixelSquare& square, std::span<const PixelPlace> pixels,
                    std::span<PixelAnswer> answers) const;
    /// Answers by temporal coherence, for pixels that are not probed: in the interior of a surface
    /// (depths around do not jump, nothing is reflected) whose points the last frame has shown,
    /// these points are assumed to be visible still. Elsewhere TraceCause::uncovered. A point that
    /// a probe finds hidden is not used, and supports no such inference in the next frame.
    /// @param pixels  inside the square
    void temporal(const PixelSquare& square, std::span<const PixelPlace> pixels,
                  std::span<PixelAnswer> answers) const;
    /// Whether something new may come into view at the pixel: at the edge of the picture, beside a
    /// pixel without a point, or where depths jump.
    [[nodiscard]] bool is_edge(const PixelPlace& pixel) const;

    /// Whether an answer that was not found has all points of its pixel, though not near enough,
    /// seen from elsewhere, or of another leaf of the tree: the best guess until the pixel is
    /// traced.
    [[nodiscard]] bool is_guess(const PixelAnswer& answer) const;
    /// The distance along the ray of an answer: of what lies ahead, or of the reflection where that
    /// is brighter [m].
    [[nodiscard]] float distance(const PixelAnswer& answer) const;

  private:
    struct Search;
    void check(const PixelPlace& pixel, const PixelVisibility& visibility,
               PixelAnswer& answer) const;
    [[nodiscard]] TraceCause search(const DepthGrid& grid, const PixelPlace& pixel,
                                    const PixelVisibility& visibility,
                                    const PrimaryVisibility& primary, std::uint32_t& best,
                                    PixelAnswer& answer) const;
    void search_around(const DepthGrid& grid, const PixelPlace& pixel, float near,
                       const PixelVisibility& visibility, const PrimaryVisibility& primary,
                       Search& found) const;
    void consider(std::uint32_t index, float squared, const PixelVisibility& visibility,
                  const PrimaryVisibility& primary, Search& found) const;
    void expect(std::span<const PixelPlace> pixels) const;
    [[nodiscard]] TraceCause without_image(const PixelAnswer& answer, TraceCause cause) const;
    void find_own(const PixelPlace& pixel, bool mirrors, PixelAnswer& answer) const;
    void find_around(const PixelPlace& pixel, PixelAnswer& answer) const;
    void fill_unverified(const PixelSquare& square, const PixelPlace& pixel,
                         PixelAnswer& answer) const;
    [[nodiscard]] bool is_amidst(const PixelSquare& square, const PixelPlace& pixel) const;
    [[nodiscard]] PixelAnswer inferred(const PixelPlace& pixel) const;
    [[nodiscard]] bool holds(const CloudPoint& point, const PixelPlace& pixel) const;
    [[nodiscard]] float squared_distance(std::uint32_t index,
                                         const PixelVisibility& visibility) const;
    [[nodiscard]] float squared_reach(float contrast) const;
    [[nodiscard]] bool contradicts(const PixelPlace& pixel, const DepthGrid& grid) const;
    [[nodiscard]] std::array<float, 9> depths(const PixelPlace& pixel, const DepthGrid& grid) const;
    [[nodiscard]] bool inside(int x, int y) const {
        return x >= 0 && x < projector_.width() && y >= 0 && y < projector_.height();
    }

    const PointProjector& projector_;
    std::span<const CloudPoint> points_;
    const CloudGrids& grids_;
    std::span<const ImagePlace> places_;
    ReuseRules rules_;
};

}  // namespace lightwalk
