#include "core/cloud/reuse.h"

#include <algorithm>
#include <cmath>

#include "core/cloud/point_order.h"
#include "core/math/prefetch.h"

namespace lightwalk {
namespace {

/// Points of one surface whose distances differ by more belong to different parts of it. A plane
/// seen at a grazing angle changes its distance by as much within a pixel.
constexpr float kSameDepth = 0.05f;

/// Larger relative differences of depth are discontinuities.
constexpr float kDepthJump = 0.1f;

/// Points around a pixel that differ by this share of the brightest belong to lines and edges.
constexpr float kSteepContrast = 0.6f;

/// Squared distance from a pixel's ray up to which a single point is shown; of farther points an
/// interpolated mean is more accurate [pixels²].
constexpr float kOwnPixel2 = 0.49f;

/// Reflections that add at most this share of the rest need not be found.
constexpr float kFaint = 0.05f;

/// Up to so many points are too few to judge the contrast of a neighbourhood.
constexpr int kFewPoints = 3;

bool depths_jump(float a, float b) {
    return std::abs(a - b) > kDepthJump * std::min(a, b);
}

/// Conditions of temporal answers, in the 3 x 3 cells around a pixel: least number of points,
/// largest difference of depths [steps of .4 to .8 %], least number of points that the last frame
/// has shown.
constexpr int kWellKnown = 5, kSmooth = 4, kWitnesses = 3;

/// Direction from where the pixel's ray begins to a point beside it.
Vec3 toward(const CloudPoint& point, const PixelVisibility& visibility,
            const PrimaryVisibility& primary) {
    const double scale = 1 / std::max(static_cast<double>(primary.distance), kEpsilon);
    return normalize(visibility.direction + (point.place() - primary.position) * scale);
}

}  // namespace

/// The squared distance up to which points may lie from a pixel's ray [pixels²], by the relative
/// contrast of the points around: the grain of a wall may shift by a pixel, a line may not.
float PointFinder::squared_reach(float contrast) const {
    const float steep = std::max(kSteepContrast, rules_.contrast);
    const float share =
        std::clamp((steep - contrast) / (steep - rules_.contrast + 1e-6f), 0.0f, 1.0f);
    const float reach = rules_.near + (std::max(rules_.reach, rules_.near) - rules_.near) * share;
    return reach * reach;
}

/// The points around a pixel, as far as they show what its ray sees.
struct PointFinder::Search {
    float faint = -1;  ///< radiance that is negligible, whatever its surface
    std::uint32_t best = kNoPoint;
    float squared = HUGE_VALF;  ///< distance of the best one [pixels²]
    Rgb sum;                    ///< weighted sum of points farther than kOwnPixel2
    float weight = 0;
    float darkest = HUGE_VALF, brightest = 0;
    int points = 0;       ///< number of usable points
    bool any = false;     ///< there is any point
    bool turned = false;  ///< some points were seen from a too different direction:
    std::uint32_t nearest_turned = kNoPoint;
    float turned_squared = HUGE_VALF;  ///< distance of the nearest of them [pixels²]
    std::uint32_t kin = kNoPoint;      ///< nearest point that is_kin()
    float kin_squared = HUGE_VALF;     ///< its distance [pixels²]
};

inline float PointFinder::squared_distance(std::uint32_t index,
                                           const PixelVisibility& visibility) const {
    const float dx = places_[index].x - visibility.x, dy = places_[index].y - visibility.y;
    return dx * dx + dy * dy;
}

/// @param squared  the point's squared_distance()
inline void PointFinder::consider(std::uint32_t index, float squared,
                                  const PixelVisibility& visibility,
                                  const PrimaryVisibility& primary, Search& found) const {
    found.any = true;
    const CloudPoint& point = points_[index];
    const float light = brightness(point.radiance);
    if (light > found.faint) {
        const float distance = places_[index].distance;
        if (point.surface != primary.surface) {
            if (squared < found.kin_squared &&
                is_kin(point.surface, distance, primary.surface, primary.distance)) {
                found.kin_squared = squared;
                found.kin = index;
            }
            return;
        }
        if (std::abs(distance - primary.distance) > kSameDepth * primary.distance) return;
        if (point.max_view_angle != kAnyViewAngle &&
            !holds_from(point, toward(point, visibility, primary), rules_.tightness)) {
            found.turned = true;
            if (squared < found.turned_squared) {
                found.turned_squared = squared;
                found.nearest_turned = index;
            }
            return;
        }
    }
    ++found.points;
    found.darkest = std::min(found.darkest, light);
    found.brightest = std::max(found.brightest, light);
    if (squared > kOwnPixel2) {
        const float weight = 1 / (squared * squared);
        found.sum += point.radiance * weight;
        found.weight += weight;
    }
    // Ties are broken by content, so that the result is deterministic.
    if (squared > found.squared ||
        (squared == found.squared && !precedes(point, points_[found.best])))
        return;
    found.squared = squared;
    found.best = index;
}

/// Considers the points around a pixel. Points that are not near are considered only where no near
/// one shows what the ray sees, as they would not change the result otherwise.
/// @param near  squared, at most kOwnPixel2 [pixels²]
void PointFinder::search_around(const DepthGrid& grid, const PixelPlace& pixel, float near,
                                const PixelVisibility& visibility, const PrimaryVisibility& primary,
                                Search& found) const {
    std::array<std::uint32_t, 8> far;
    std::array<float, 8> far_squared;
    std::size_t count = 0;
    const int x1 = std::min(pixel.x + 1, projector_.width() - 1);
    const int y1 = std::min(pixel.y + 1, projector_.height() - 1);
    for (int y = std::max(pixel.y - 1, 0); y <= y1; ++y) {
        for (int x = std::max(pixel.x - 1, 0); x <= x1; ++x) {
            const std::uint32_t index = grid.winner(x, y);
            if (index == kNoPoint || (x == pixel.x && y == pixel.y)) continue;
            const float squared = squared_distance(index, visibility);
            if (squared <= near) {
                consider(index, squared, visibility, primary, found);
            } else {
                far[count] = index;
                far_squared[count++] = squared;
            }
        }
    }
    if (found.points > 0) return;
    for (std::size_t i = 0; i < count; ++i)
        consider(far[i], far_squared[i], visibility, primary, found);
}

/// Adds the found points to the answer. Their contrast is judged relative to the sum of both points
/// of the pixel. Values between points are weighted by the inverse fourth power of the distance
/// (Shepard, "A two-dimensional interpolation function for irregularly-spaced data", ACM 1968).
TraceCause PointFinder::search(const DepthGrid& grid, const PixelPlace& pixel,
                               const PixelVisibility& visibility, const PrimaryVisibility& primary,
                               std::uint32_t& best, PixelAnswer& answer) const {
    Search found;
    const float base = brightness(answer.radiance);
    if (base > 0) found.faint = kFaint * base;
    const float near = rules_.near * rules_.near;
    const std::uint32_t own = grid.winner(pixel.x, pixel.y);
    if (own != kNoPoint)
        consider(own, squared_distance(own, visibility), visibility, primary, found);
    // A point projected onto the pixel is as good a sample as its ray.
    const bool inside_pixel = found.points > 0;
    if (rules_.look_back && !inside_pixel)
        search_around(grid, pixel, std::min(near, kOwnPixel2), visibility, primary, found);
    best = found.best;
    answer.apart = std::max(answer.apart, std::sqrt(found.squared));
    if (found.points == 0 && found.turned) {
        best = found.nearest_turned;
        answer.radiance += points_[best].radiance;
        return TraceCause::turned;
    }
    if (found.points == 0 && found.kin != kNoPoint) {
        best = found.kin;
        answer.radiance += points_[best].radiance;
        return TraceCause::uneven;
    }
    if (found.points == 0) return found.any ? TraceCause::hidden : TraceCause::uncovered;
    const bool sharp = inside_pixel || found.squared <= kOwnPixel2;
    answer.radiance += sharp ? points_[best].radiance : found.sum * (1 / found.weight);
    if (!rules_.look_back || inside_pixel || found.squared <= near) return TraceCause::none;
    if (found.brightest <= found.faint) return TraceCause::none;
    if (found.points < kFewPoints) return TraceCause::uneven;
    const float contrast =
        (found.brightest - found.darkest) / std::max(found.brightest + base, 1e-30f);
    return found.squared <= squared_reach(contrast) ? TraceCause::none : TraceCause::uneven;
}

/// Why a pixel is traced whose point ahead is there, but not what it reflects. What is seen through
/// a pane is a guess of both.
TraceCause PointFinder::without_image(const PixelAnswer& answer, TraceCause cause) const {
    const bool through =
        answer.ahead != kNoPoint && points_[answer.ahead].kind == PointKind::through;
    return through ? TraceCause::uneven : cause;
}

inline void PointFinder::check(const PixelPlace& pixel, const PixelVisibility& visibility,
                               PixelAnswer& answer) const {
    answer = {TraceCause::none, kNoPoint, kNoPoint, 0, {}};
    if ((visibility.ahead.seen && visibility.ahead.slope == kNeverReuse) ||
        (visibility.mirrored.seen && visibility.mirrored.slope == kNeverReuse)) {
        answer.cause = TraceCause::never_reused;
        return;
    }
    if (visibility.ahead.seen) {
        answer.cause =
            search(grids_.ahead, pixel, visibility, visibility.ahead, answer.ahead, answer);
        if (answer.ahead == kNoPoint) return;
    }
    if (!visibility.mirrored.seen) return;
    const TraceCause cause =
        search(grids_.mirrored, pixel, visibility, visibility.mirrored, answer.mirrored, answer);
    if (answer.found())
        answer.cause = cause == TraceCause::none ? cause : without_image(answer, cause);
}

/// Prefetch the points of the pixels.
void PointFinder::expect(std::span<const PixelPlace> pixels) const {
    for (const PixelPlace& pixel : pixels) {
        const std::uint32_t index = grids_.ahead.winner(pixel.x, pixel.y);
        if (index == kNoPoint) continue;
        prefetch(&points_[index]);
        prefetch(&points_[index].pattern);  // the last member, which may lie in the next cache line
        prefetch(&places_[index]);
    }
}

void PointFinder::checked(std::span<const PixelPlace> pixels,
                          std::span<const PixelVisibility> visibility,
                          std::span<PixelAnswer> answers) const {
    expect(pixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) check(pixels[i], visibility[i], answers[i]);
}

PixelAnswer PointFinder::checked(const PixelPlace& pixel, const PixelVisibility& visibility) const {
    PixelAnswer answer;
    checked({&pixel, 1}, {&visibility, 1}, {&answer, 1});
    return answer;
}

/// The points projected onto the pixel, without further tests; TraceCause::uncovered where one of a
/// pair is missing. @param mirrors  whether there may be a point seen in a mirror
void PointFinder::find_own(const PixelPlace& pixel, bool mirrors, PixelAnswer& answer) const {
    const std::uint32_t ahead = grids_.ahead.winner(pixel.x, pixel.y);
    const std::uint32_t mirrored = mirrors ? grids_.mirrored.winner(pixel.x, pixel.y) : kNoPoint;
    const bool lone_mirror = mirrored != kNoPoint && !points_[mirrored].paired;
    answer.cause = TraceCause::uncovered;
    answer.ahead = answer.mirrored = kNoPoint;
    if (ahead == kNoPoint && !lone_mirror) return;
    answer.cause = TraceCause::none;
    answer.ahead = ahead;
    answer.apart = 0;
    answer.radiance = {};
    if (ahead == kNoPoint || points_[ahead].paired) {
        answer.mirrored = mirrored;
        if (mirrored == kNoPoint) answer.cause = without_image(answer, TraceCause::uncovered);
    }
    for (const std::uint32_t index : {answer.ahead, answer.mirrored})
        if (index != kNoPoint) answer.radiance += points_[index].radiance;
}

PixelAnswer PointFinder::unchecked(const PixelPlace& pixel) const {
    PixelAnswer answer;
    find_own(pixel, true, answer);
    if (!answer.found()) return answer;
    if (contradicts(pixel, answer.ahead == kNoPoint ? grids_.mirrored : grids_.ahead)) {
        answer.cause = TraceCause::hidden;
        return answer;
    }
    for (const std::uint32_t index : {answer.ahead, answer.mirrored})
        if (index != kNoPoint && !holds(points_[index], pixel)) answer.cause = TraceCause::turned;
    return answer;
}

/// Whether the pixel has a ray, and the colour of the point holds along it.
bool PointFinder::holds(const CloudPoint& point, const PixelPlace& pixel) const {
    const Camera& camera = projector_.camera();
    const auto ray =
        camera.ray((pixel.x + 0.5) / projector_.width(), (pixel.y + 0.5) / projector_.height());
    return ray && holds_from(point, normalize(point.place() - ray->origin), rules_.tightness);
}

/// The answer from the pixel's point, or where it has none from those around it, assuming that the
/// ray sees their surface: provided that they are of one surface, and that the last frame has shown
/// some of them.
PixelAnswer PointFinder::inferred(const PixelPlace& pixel) const {
    PixelVisibility visibility;
    float sum = 0;
    int count = 0, fresh = 0;
    for (int y = pixel.y - 1; y <= pixel.y + 1; ++y) {
        for (int x = pixel.x - 1; x <= pixel.x + 1; ++x) {
            const std::uint32_t index = inside(x, y) ? grids_.ahead.winner(x, y) : kNoPoint;
            if (index == kNoPoint) continue;
            const CloudPoint& point = points_[index];
            if (point.paired || (count > 0 && point.surface != visibility.ahead.surface)) return {};
            visibility.ahead.surface = point.surface;
            sum += places_[index].distance;
            ++count;
            if (point.age == 0) ++fresh;
        }
    }
    if (fresh < kWitnesses) return {};
    const double h = pixel.x + 0.5, v = pixel.y + 0.5;
    const auto ray = projector_.camera().ray(h / projector_.width(), v / projector_.height());
    if (!ray) return {};
    visibility.x = static_cast<float>(h);
    visibility.y = static_cast<float>(v);
    visibility.direction = ray->direction;
    visibility.ahead.seen = true;
    visibility.ahead.distance = sum / static_cast<float>(count);
    visibility.ahead.position =
        ray->origin + ray->direction * static_cast<double>(visibility.ahead.distance);
    PixelAnswer answer;
    check(pixel, visibility, answer);
    return answer;
}

PixelSquare PointFinder::square_of(const PixelPlace& pixel) const {
    constexpr int kSide = DepthGrid::Surroundings::kSide;
    const PixelPlace corner{pixel.x - pixel.x % kSide, pixel.y - pixel.y % kSide};
    return {corner, grids_.ahead.surroundings(corner), !grids_.mirrored.is_empty(corner)};
}

/// Whether a pixel lies in the interior of a surface without reflections, judged by depths.
bool PointFinder::is_amidst(const PixelSquare& square, const PixelPlace& pixel) const {
    const std::size_t at = square.at(pixel);
    return square.ahead.known[at] >= kWellKnown && square.ahead.spread[at] <= kSmooth &&
           (!square.mirrors || grids_.mirrored.winner(pixel.x, pixel.y) == kNoPoint);
}

void PointFinder::temporal(const PixelSquare& square, std::span<const PixelPlace> pixels,
                           std::span<PixelAnswer> answers) const {
    expect(pixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const PixelPlace& pixel = pixels[i];
        PixelAnswer& answer = answers[i];
        answer = {};
        if (!is_amidst(square, pixel)) continue;
        const std::uint32_t own = grids_.ahead.winner(pixel.x, pixel.y);
        if (own == kNoPoint || points_[own].age > 0)
            answer = inferred(pixel);
        else if (const CloudPoint& point = points_[own];
                 !point.paired && (point.max_view_angle == kAnyViewAngle || holds(point, pixel)))
            answer = {TraceCause::none, own, kNoPoint, 0, point.radiance};
    }
}

/// The nearest of the points projected onto the pixels around, without further tests.
void PointFinder::find_around(const PixelPlace& pixel, PixelAnswer& answer) const {
    const float centre_x = static_cast<float>(pixel.x) + 0.5f;
    const float centre_y = static_cast<float>(pixel.y) + 0.5f;
    std::uint32_t best = kNoPoint;
    float least = HUGE_VALF;
    for (int y = pixel.y - 1; y <= pixel.y + 1; ++y) {
        for (int x = pixel.x - 1; x <= pixel.x + 1; ++x) {
            const std::uint32_t index = inside(x, y) ? grids_.ahead.winner(x, y) : kNoPoint;
            if (index == kNoPoint) continue;
            const float dx = places_[index].x - centre_x, dy = places_[index].y - centre_y;
            if (dx * dx + dy * dy >= least) continue;
            least = dx * dx + dy * dy;
            best = index;
        }
    }
    if (best == kNoPoint || points_[best].paired) return;
    answer.cause = TraceCause::none;
    answer.ahead = best;
    answer.apart = std::sqrt(least);
    answer.radiance = points_[best].radiance;
}

void PointFinder::fill_unverified(const PixelSquare& square, const PixelPlace& pixel,
                                  PixelAnswer& answer) const {
    find_own(pixel, square.mirrors, answer);
    if (answer.cause == TraceCause::uncovered) {
        if (is_amidst(square, pixel)) find_around(pixel, answer);
        return;
    }
    const DepthGrid& grid = answer.ahead == kNoPoint ? grids_.mirrored : grids_.ahead;
    const bool level =
        answer.ahead != kNoPoint && square.ahead.spread[square.at(pixel)] <= DepthGrid::kBehind;
    if (!level && grid.is_behind(pixel.x, pixel.y)) answer.cause = TraceCause::hidden;
}

void PointFinder::unverified(const PixelSquare& square, std::span<const PixelPlace> pixels,
                             std::span<PixelAnswer> answers) const {
    expect(pixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) fill_unverified(square, pixels[i], answers[i]);
}

/// Distances of the points in the 3 x 3 cells around a pixel, from below, left to right; 0: no
/// point.
std::array<float, 9> PointFinder::depths(const PixelPlace& pixel, const DepthGrid& grid) const {
    std::array<float, 9> result{};
    std::size_t i = 0;
    for (int y = pixel.y - 1; y <= pixel.y + 1; ++y) {
        for (int x = pixel.x - 1; x <= pixel.x + 1; ++x, ++i) {
            if (!inside(x, y)) continue;
            const std::uint32_t index = grid.winner(x, y);
            if (index != kNoPoint) result[i] = places_[index].distance;
        }
    }
    return result;
}

/// Whether the points around contradict the pixel's point: it is probably hidden or stale.
bool PointFinder::contradicts(const PixelPlace& pixel, const DepthGrid& grid) const {
    const std::array<float, 9> around = depths(pixel, grid);
    constexpr std::size_t kOwn = 4;
    const float own = around[kOwn];
    int known = 0, nearer = 0, different = 0;
    for (std::size_t i = 0; i < around.size(); ++i) {
        if (i == kOwn || !(around[i] > 0)) continue;
        ++known;
        if (!depths_jump(around[i], own)) continue;
        ++different;
        if (around[i] < own) ++nearer;
    }
    if (rules_.drop_hidden && 2 * nearer > known) return true;
    return rules_.drop_lonely && known > 0 && different == known;
}

bool PointFinder::is_edge(const PixelPlace& pixel) const {
    if (!inside(pixel.x - 1, pixel.y - 1) || !inside(pixel.x + 1, pixel.y + 1)) return true;
    const std::array<float, 9> around = depths(pixel, grids_.ahead);
    const auto [least, most] = std::minmax_element(around.begin(), around.end());
    return !(*least > 0) || depths_jump(*least, *most);
}

bool PointFinder::is_guess(const PixelAnswer& answer) const {
    if (answer.cause != TraceCause::uneven && answer.cause != TraceCause::turned) return false;
    if (answer.ahead == kNoPoint || answer.mirrored != kNoPoint) return true;
    const CloudPoint& ahead = points_[answer.ahead];
    return !ahead.paired || ahead.kind == PointKind::through;
}

float PointFinder::distance(const PixelAnswer& answer) const {
    if (answer.ahead == kNoPoint)
        return answer.mirrored != kNoPoint ? places_[answer.mirrored].distance : 0;
    // The same rule as for traced rays, see Ray::effective_distance().
    const bool mirror =
        answer.mirrored != kNoPoint &&
        brightness(points_[answer.mirrored].radiance) > 0.5f * brightness(answer.radiance);
    return places_[mirror ? answer.mirrored : answer.ahead].distance;
}

}  // namespace lightwalk
