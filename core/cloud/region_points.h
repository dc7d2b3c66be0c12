#pragma once
// The points of a region of a picture, from frame to frame: where a frame shows them, which of them
// it uses, and which are kept for the next one.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/cloud/ageing.h"
#include "core/cloud/primary_visibility.h"
#include "core/cloud/projection.h"
#include "core/cloud/reuse.h"
#include "core/cloud/shown_materials.h"
#include "core/cloud/sleeping_points.h"
#include "core/math/prefetch.h"
#include "core/math/task_runner.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Pixels whose points were used.
struct UsedPixels {
    std::vector<PixelPlace> ahead, mirrored;  ///< by the grid that the points are in (CloudGrids)
};

/// The steps of a frame, in this order: begin, project, [leaving, add,] use, [used_beside,
/// mark_used,] leave for each traced pixel, age, keep; of a view that rests: begin, leave, rest,
/// keep. Those in brackets are for regions that have others beside them. Results depend on no
/// order: neither of points nor of calls of add, use and mark_used.
class RegionPoints {
  public:
    /// @param area  of a picture of width x height pixels
    RegionPoints(const PixelRectangle& area, int width, int height);

    /// Start with the points of a picture of another size.
    void adopt(RegionPoints&& other) {
        points_ = std::move(other.points_);
        asleep_ = std::move(other.asleep_);
        group_count_ = other.group_count_;
        groups_ = std::move(other.groups_);
        mixture_ = std::move(other.mixture_);
    }
    /// Points of another region that the picture does not show.
    void take_asleep(const RegionPoints& other) { asleep_.add(other.points_, other.groups_); }
    /// Show another mixture of the light groups from now on, of which points keep the light.
    void mix(const LightMixture& mixture, const TaskRunner& task_runner);
    /// Between two frames, of which the second one is not of a view that rests: forget the points
    /// that may show some materials.
    void drop(const ShownMaterials& materials) {
        drop_points(materials, points_, groups_);
        asleep_.drop(materials);
    }
    /// A new frame. The camera must outlive it.
    void begin(const Camera& camera);
    /// Find the places of all points, after those have woken that the picture may show.
    void project(const TaskRunner& task_runner);
    /// Points that the picture shows outside the region, or at its edge: others need them. Calls
    /// take(point, pixel, what each light group adds to it).
    template <class Take>
    void leaving(Take take) const {
        const PixelRectangle inner = inside_of_area();
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (!(places_[i].distance > 0)) continue;
            const PixelPlace place = pixel_of(places_[i], width_, height_);
            if (!inner.contains(place)) take(points_[i], place, groups_of(i));
        }
    }
    /// Points of other regions that lie in this one, or a pixel beside it.
    /// @param groups  what each light group adds to them, by point, then group; empty: not kept
    void add(std::span<const CloudPoint> points, std::span<const Rgb> groups = {});

    /// Finds points for pixels of the region; valid until points are added.
    [[nodiscard]] PointFinder finder(const ReuseRules& rules) const {
        return {*projector_, points_, grids_, places_, rules};
    }
    /// A pixel uses a point. From any thread: many pixels may use one.
    void use(std::uint32_t point) {
        std::atomic_ref<std::uint8_t>(used_[point]).store(1, std::memory_order_relaxed);
    }
    /// A point will be used soon.
    void expect_use(std::uint32_t point) const { prefetch(&used_[point]); }
    /// Pixels beside the region whose points answered pixels of it.
    [[nodiscard]] UsedPixels used_beside() const;
    /// What others' used_beside() says of this one.
    void mark_used(const UsedPixels& used);

    /// Points that a traced pixel leaves for the next frame.
    /// @param groups  what each light group adds to the pixel; empty: they are not kept
    /// @param ahead   the same of the first of two points
    void leave(const PixelPoints& left, std::span<const Rgb> groups = {},
               std::span<const Rgb> ahead = {}) {
        fresh_.insert(fresh_.end(), left.points.begin(),
                      left.points.begin() + static_cast<std::ptrdiff_t>(left.count));
        if (!groups.empty()) leave_groups(left.count, groups, ahead);
    }
    /// Points grow older, and fall asleep. The ages of all that may be kept, new ones included.
    [[nodiscard]] AgeCounts age(const CloudLife& life, const TaskRunner& task_runner);
    /// The same where the view rests: points stay as they are.
    [[nodiscard]] AgeCounts rest();
    /// The points of the next frame: those that there is room for.
    /// @param frame  the number of this one
    void keep(const AgeLimit& room, std::uint64_t frame, const TaskRunner& task_runner);
    /// Forget those that have slept longest, where more than `most` are asleep.
    void limit_asleep(std::size_t most) { asleep_.limit(most); }

    [[nodiscard]] std::span<const CloudPoint> all() const { return points_; }
    [[nodiscard]] const Camera& camera() const { return projector_->camera(); }
    [[nodiscard]] int width() const { return width_; }  ///< of the picture
    [[nodiscard]] int height() const { return height_; }

  private:
    [[nodiscard]] PixelRectangle inside_of_area() const;
    [[nodiscard]] std::span<const Rgb> groups_of(std::size_t point) const {
        return std::span(groups_).subspan(point * group_count_, group_count_);
    }
    void put_to_sleep(std::span<const std::vector<std::uint32_t>> parts);
    void leave_groups(std::size_t points, std::span<const Rgb> groups, std::span<const Rgb> ahead);
    void mix_from(std::size_t first, std::size_t last);
    void drop_old_fresh(const AgeLimit& room, std::uint64_t frame);
    /// Point `to` becomes what point `from` of others is.
    void replace(std::size_t to, std::span<const CloudPoint> others, std::span<const Rgb> groups,
                 std::size_t from);

    PixelRectangle area_;
    int width_, height_;
    std::optional<PointProjector> projector_;
    CloudGrids grids_;
    std::vector<CloudPoint> points_;
    std::vector<ImagePlace> places_;  ///< of the points in this frame
    std::vector<std::uint8_t> used_;  ///< by point
    std::vector<PointFate> fates_;    ///< by point
    std::vector<CloudPoint> fresh_;   ///< that this frame leaves
    // Where light groups are kept: what each adds to a point, by point, then group.
    std::size_t group_count_ = 0;
    std::vector<Rgb> groups_, fresh_groups_;
    LightMixture mixture_;  ///< of them in the points' radiance
    SleepingPoints asleep_;
};

}  // namespace lightwalk
