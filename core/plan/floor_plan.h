#pragma once
// A floor plan: what a horizontal section at the eye's height cuts, and what is seen below it.
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/task_runner.h"
#include "core/plan/plan_sight.h"
#include "core/plan/plan_surroundings.h"
#include "core/scene/scene.h"

namespace lightwalk {

// What a cell of a plan shows. From 1 to kPlanDeepest it is the highest surface below the section,
// in hundredths of an eye height below it, kPlanDeepest also where that lies deeper.
inline constexpr std::uint8_t kPlanEmpty = 0;  ///< nothing: sky or void
inline constexpr std::uint8_t kPlanDeepest = 250;
inline constexpr std::uint8_t kPlanEdge = 253;  ///< the upper side of a jump in height
inline constexpr std::uint8_t kPlanPane = 254;  ///< the section cuts glass or the like
inline constexpr std::uint8_t kPlanWall = 255;  ///< the section cuts something else

inline constexpr int kMostPlanCells = 384;  ///< along each side of a plan

struct FloorPlan {
    int width = 0, height = 0;        ///< [cells]; 0 where there is nothing to draw
    double left = 0, bottom = 0;      ///< x and y of its lower left corner [m]
    double cell = 0;                  ///< side of a cell [m]
    double z = 0;                     ///< of the section [m]
    std::vector<std::uint8_t> cells;  ///< width x height, rows from the top, where y is largest
};

/// Draws plans of a scene in small steps, so that nobody waits long for one of them, and keeps the
/// last one. Lengths are relative to the eye's height: a scene whose unit is another one has the
/// same plans. A plan shows what is large to the eye within 40 eye heights, and what hangs
/// together with it: of a house in a landscape the house. The same plan whatever runs the tasks.
class PlanSurvey {
  public:
    /// @param scene       must outlive this
    /// @param back_faces  whether surfaces are seen from behind (-bv)
    PlanSurvey(const Scene& scene, bool back_faces) : sight_(scene, back_faces) {}

    /// Ask for the plan of a place. Keeps what is drawn, or being drawn, if that shows the place:
    /// its section is within a quarter of an eye height of the eye, and the eye over its cells.
    /// @param eye_height  above the floor; not positive, or not finite: the plan is empty [m]
    void aim(const Vec3& eye, double eye_height);
    /// Do some of the work: some 50,000 rays, which take milliseconds. True: all is done.
    [[nodiscard]] bool step(const TaskRunner& task_runner);
    /// The plan that was aimed at, when step() has returned true.
    [[nodiscard]] const FloorPlan& plan() const { return plan_; }

  private:
    enum class Stage { extent, below, cut, done };
    /// What is seen from a cell downward.
    struct Below {
        float depth = HUGE_VALF;         ///< [eye heights]
        float slope_x = 0, slope_y = 0;  ///< by which the surface rises
    };
    [[nodiscard]] bool shows(const Vec3& eye) const;
    [[nodiscard]] bool look_around();
    void set_extent();
    void look_down(int row);
    void cut(bool along_x, int line);
    void mark(bool along_x, int line, double from, double to, PlanLook look);
    [[nodiscard]] bool is_edge(const Below& a, const Below& b, double rise_a, double rise_b) const;
    void find_edges(int row);
    [[nodiscard]] std::size_t place(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(plan_.width) +
               static_cast<std::size_t>(column);
    }
    [[nodiscard]] double x_of(int column) const { return plan_.left + (column + 0.5) * plan_.cell; }
    [[nodiscard]] double y_of(int row) const {
        return plan_.bottom + (plan_.height - row - 0.5) * plan_.cell;
    }

    PlanSight sight_;
    Stage stage_ = Stage::done;
    Vec3 eye_;
    double eye_height_ = 0;
    int directions_done_ = 0, rows_done_ = 0;
    std::optional<PlanSurroundings> surroundings_;  ///< while the extent is sought
    FloorPlan plan_;
    std::vector<Below> below_;
};

}  // namespace lightwalk
