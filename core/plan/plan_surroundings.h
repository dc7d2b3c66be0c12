#pragma once
// What is around the eye of a plan, and which of it the plan shows.
#include <vector>

#include "core/geometry/geometry.h"

namespace lightwalk {

/// Places around an eye where there is something, in groups: what is less than about one eye height
/// apart hangs together.
class PlanSurroundings {
  public:
    static constexpr double kReach = 40;  ///< farther places are not taken [eye heights]

    /// @param eye_height  unit of all lengths, positive [m]
    PlanSurroundings(const Vec3& eye, double eye_height);

    /// @param nearest  nothing lies between the eye and the place
    void add(const Vec3& place, bool nearest);
    /// The bounds of all groups with so many nearest places, such as a house around the eye without
    /// the trees behind its walls; of all groups where there is no such one. Empty for no places.
    [[nodiscard]] Bounds part(double nearest);

  private:
    struct Square {
        Bounds bounds;  ///< of the places in it
        int nearest = 0;
        bool grouped = false;
    };
    struct Group {
        Bounds bounds;
        int nearest = 0;
    };
    [[nodiscard]] Group group_of(std::size_t first);

    Vec3 eye_;
    double side_;  ///< of a square [m]
    std::vector<Square> squares_;
};

}  // namespace lightwalk
