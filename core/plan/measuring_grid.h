#pragma once
// Grids of points where illuminance is measured: the part of a plane that belongs to one room, or
// to one surface.
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/task_runner.h"
#include "core/plan/plan_sight.h"

namespace lightwalk {

inline constexpr int kMostMeasuringPoints = 48;  ///< along each side of a grid

/// Points in the middle of the equal cells of a rectangle.
struct MeasuringGrid {
    int columns = 0, rows = 0;         ///< 0: no plane was found
    Vec3 origin;                       ///< the first point [m]
    Vec3 across, along;                ///< from a point to the next of its row, and to the next row
    Vec3 normal;                       ///< unit: across x along points there
    std::vector<std::uint8_t> counts;  ///< by rows: 1 where a point is of the plane, else 0

    [[nodiscard]] Vec3 point(int column, int row) const {
        return origin + column * across + row * along;
    }
    [[nodiscard]] bool counts_at(int column, int row) const {
        return counts[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column)] != 0;
    }
};

/// Finds the points in small steps, so that nobody waits long for one of them. A grid covers what
/// is seen from its start along the plane, within 20 eye heights; of that those points count which
/// are reached from the start without crossing anything that can be seen, panes included. Its sides
/// are parallel to most of the walls around a level plane, else one of them is level. The same grid
/// whatever runs the tasks.
class MeasuringSurvey {
  public:
    // Both: `sight` must outlive the survey. `unit` is the eye's height above the floor, which
    // tells what is small; where it is not positive, or not finite, there is no grid [m].
    /// The plane through a point of a surface: only points that lie on a surface count.
    /// @param normal  unit, on the side where light is measured
    [[nodiscard]] static MeasuringSurvey on_surface(const PlanSight& sight, double unit,
                                                    const Vec3& position, const Vec3& normal);
    /// A level plane above the floor of the room that an eye is in. The floor is at the height that
    /// most places around the eye have; points count that have something below, no deeper than it.
    /// @param height  above the floor [m]
    [[nodiscard]] static MeasuringSurvey above_floor(const PlanSight& sight, double unit,
                                                     const Vec3& eye, double height);
    /// Do some of the work: at most some 13,000 rays. True: all is done.
    [[nodiscard]] bool step(const TaskRunner& task_runner);
    /// When step() has returned true.
    [[nodiscard]] const MeasuringGrid& grid() const { return grid_; }

  private:
    MeasuringSurvey(const PlanSight& sight, double unit) : sight_(sight), unit_(unit) {}
    enum class Stage { start, survey, done };
    struct Box {
        double x0 = 0, x1 = 0, y0 = 0, y1 = 0;  ///< along the axes, from the start [m]
        [[nodiscard]] double width() const { return x1 - x0; }
        [[nodiscard]] double height() const { return y1 - y0; }
    };
    [[nodiscard]] bool find_start();
    [[nodiscard]] bool stand_above_floor();
    void look_around();
    void turn_axes(const std::vector<Vec3>& reached, const std::vector<std::optional<Vec3>>& walls);
    [[nodiscard]] bool belongs(const Vec3& point) const;
    [[nodiscard]] bool is_clear(const Vec3& from, const Vec3& to) const;
    /// The points of a box that belong to the plane and are reached from the start.
    [[nodiscard]] MeasuringGrid survey(const Box& box, int most_points,
                                       const TaskRunner& task_runner) const;
    void fill_from_start(const Box& box, MeasuringGrid& grid,
                         const std::vector<std::array<bool, 2>>& ways) const;
    /// The box around the points that count, and the start.
    [[nodiscard]] Box around(const MeasuringGrid& grid) const;

    const PlanSight& sight_;
    double unit_;
    Stage stage_ = Stage::start;
    bool above_floor_ = false;
    Vec3 eye_;           ///< above the floor: where it is looked for
    double height_ = 0;  ///< above the floor
    Vec3 start_, normal_, x_axis_, y_axis_;
    double lift_ = 0;  ///< rays along the plane pass so high above it
    Box box_;
    int rounds_ = 0;
    MeasuringGrid grid_;
};

}  // namespace lightwalk
