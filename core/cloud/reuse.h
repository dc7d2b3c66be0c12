#pragma once
// Which points of the cloud answer a pixel truthfully.
#include <array>
#include <cstdint>
#include <span>

#include "core/cloud/depth_grid.h"
#include "core/cloud/point.h"
#include "core/cloud/primary_visibility.h"
#include "core/cloud/projection.h"

namespace lightwalk {

/// Why a pixel has to be traced, the worst first.
enum class TraceCause : std::uint8_t {
    none,          ///< it has not
    uncovered,     ///< no point lies there
    hidden,        ///< what lies there belongs to another surface, or is not what the ray meets
    never_reused,  ///< its colour holds for this ray only
    turned,        ///< its colour was seen from too different a side
    uneven,        ///< the points around disagree, and none of them is near enough
    audited,       ///< it is not an uncached pixel, but traced all the same
    refined,       ///< it is not an uncached pixel, but the view stands still, and there is time
};
inline constexpr std::size_t kTraceCauses = 8;

/// When a point answers a pixel.
struct ReuseRules {
    /// Search around the pixel for the nearest point of what its ray meets; false: only the point
    /// that fell onto the pixel counts (forward projection alone).
    bool look_back = true;
    float near = 1;         ///< a point as near as this to the ray is as good as its own [pixels]
    float reach = 1.5f;     ///< and where the points around agree, one as near as this [pixels];
                            ///< in between, the less they agree the nearer it has to be
    float contrast = 0.1f;  ///< they agree when they differ by no more, as a share of the brightest
    double tightness = 1;   ///< factor of how far view directions may turn, 0 ... 1
    // Where no ray says what is there:
    bool drop_hidden = true;  ///< a point far behind most of those around it shows through a gap
    bool drop_lonely = true;  ///< a point far from all those around it may be left over
};

/// What answers a pixel: the sum of up to two points.
struct PixelAnswer {
    TraceCause cause = TraceCause::uncovered;
    std::uint32_t ahead = kNoPoint, mirrored = kNoPoint;
    float apart = 0;  ///< of the farther one from the pixel's ray [pixels]
    Rgb radiance;     ///< theirs; where none is near, of what lies around [W/(m² sr)]
    [[nodiscard]] bool found() const { return cause == TraceCause::none; }
};

/// What the grids hold in a square of 8 x 8 pixels, with corners at multiples of 8, and around it.
struct PixelSquare {
    PixelPlace corner;
    DepthGrid::Surroundings ahead;
    bool mirrors = false;  ///< whether there are points of what is mirrored

    [[nodiscard]] std::size_t at(const PixelPlace& pixel) const {
        return static_cast<std::size_t>(pixel.y - corner.y) * DepthGrid::Surroundings::kSide +
               static_cast<std::size_t>(pixel.x - corner.x);
    }
    /// Whether no point is near enough for a pixel, whatever its ray sees.
    [[nodiscard]] bool is_blank(const PixelPlace& pixel) const {
        return !mirrors && ahead.known[at(pixel)] == 0;
    }
};

/// Finds points for the pixels of one frame. All arguments must outlive it; many threads may ask.
class PointFinder {
  public:
    PointFinder(const PointProjector& projector, std::span<const CloudPoint> points,
                const CloudGrids& grids, std::span<const ImagePlace> places,
                const ReuseRules& rules)
        : projector_(projector), points_(points), grids_(grids), places_(places), rules_(rules) {}

    /// A pixel will be checked soon: fetch its cell into the cache.
    [[gnu::always_inline]] void expect(const PixelPlace& pixel) const {
        grids_.ahead.prefetch(pixel.x, pixel.y);
        grids_.mirrored.prefetch(pixel.x, pixel.y);
    }
    /// For a pixel of which a ray has told what it sees.
    [[nodiscard]] PixelAnswer checked(const PixelPlace& pixel,
                                      const PixelVisibility& visibility) const;
    /// For many of them, which is faster: what they need is fetched into the cache together.
    void checked(std::span<const PixelPlace> pixels, std::span<const PixelVisibility> visibility,
                 std::span<PixelAnswer> answers) const;
    /// For a pixel of which nothing is known: the point that fell onto it.
    [[nodiscard]] PixelAnswer unchecked(const PixelPlace& pixel) const;
    /// The square that a pixel lies in.
    [[nodiscard]] PixelSquare square_of(const PixelPlace& pixel) const;
    /// For pixels of a square, which are shown for a moment only: the points that fell onto them,
    /// though they may have been seen from elsewhere, or, in the midst of a surface, those around.
    void unverified(const PixelSquare& square, std::span<const PixelPlace> pixels,
                    std::span<PixelAnswer> answers) const;
    /// For pixels of which no ray has told, in the midst of a surface: where no depth around steps,
    /// nothing is mirrored, and the last frame has shown what lies there, what is there still.
    /// Elsewhere TraceCause::uncovered, and nothing is known. A point that a ray finds hidden is
    /// not used, and vouches for nothing in the next frame.
    /// @param pixels  of the square
    void temporal(const PixelSquare& square, std::span<const PixelPlace> pixels,
                  std::span<PixelAnswer> answers) const;
    /// Whether something may come into view beside the pixel: at the picture's edge, beside a pixel
    /// without a point, where depths jump.
    [[nodiscard]] bool is_edge(const PixelPlace& pixel) const;

    /// Whether an answer that was not found still has all points that its pixel is made of, though
    /// not near enough: the best guess until it is traced.
    [[nodiscard]] bool is_guess(const PixelAnswer& answer) const;
    /// Along the ray: of what lies ahead, or of what is mirrored where that dominates [m].
    [[nodiscard]] float distance(const PixelAnswer& answer) const;

  private:
    struct Search;
    void check(const PixelPlace& pixel, const PixelVisibility& visibility,
               PixelAnswer& answer) const;
    [[nodiscard]] TraceCause search(const DepthGrid& grid, const PixelPlace& pixel,
                                    const PixelVisibility& visibility,
                                    const PrimaryVisibility& seen_thing, std::uint32_t& best,
                                    PixelAnswer& answer) const;
    void search_around(const DepthGrid& grid, const PixelPlace& pixel, float near,
                       const PixelVisibility& visibility, const PrimaryVisibility& seen_thing,
                       Search& found) const;
    void consider(std::uint32_t index, float squared, const PixelVisibility& visibility,
                  const PrimaryVisibility& seen_thing, Search& found) const;
    void expect(std::span<const PixelPlace> pixels) const;
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
