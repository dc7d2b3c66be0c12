#pragma once
// Prediction of the spacing of ambient values from existing values.
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/ambient/ambient_point.h"
#include "core/ambient/ambient_record.h"

namespace lightwalk {

/// Predicts the radius of ambient values from those of neighbouring values, averaged in grid cells
/// of several sizes.
class SpacingGuess {
  public:
    explicit SpacingGuess(const AmbientLimits& limits);
    /// Add a known value.
    void add(const AmbientRecord& record);
    /// @param reach  distance up to which a known value is usable [m]
    void add(const Vec3& position, const Vec3& normal, int level, double reach);
    /// The predicted distance up to which a value at the point will be usable [m]: the geometric
    /// mean over the known values in the smallest cell around the point that holds any; the largest
    /// possible distance where there are none.
    [[nodiscard]] double operator()(const AmbientQuery& query) const;

    [[nodiscard]] double least() const { return least_; }
    [[nodiscard]] double greatest() const { return greatest_; }

  private:
    struct Mean {
        double log_sum = 0;
        double count = 0;
    };
    [[nodiscard]] std::uint64_t key(std::size_t scale, int level, const Vec3& position,
                                    const Vec3& normal) const;

    double accuracy_, least_, greatest_;
    std::size_t scales_;
    std::unordered_map<std::uint64_t, Mean> cells_;
};

/// The set of points chosen for a round, none within the reach of an earlier one.
class ApartSet {
  public:
    ApartSet(double least, double greatest);
    /// Whether a point lies within the reach of a chosen point with a similar normal.
    [[nodiscard]] bool reached(const AmbientQuery& query) const;
    void add(const AmbientQuery& query, double reach);

  private:
    struct Member {
        Vec3 position, normal;
        double reach2 = 0;
    };
    [[nodiscard]] std::size_t scale_of(double reach) const;
    [[nodiscard]] double edge(std::size_t scale) const {
        return 2 * least_ * static_cast<double>(std::uint64_t{1} << scale);
    }

    double least_;
    std::vector<std::unordered_map<std::uint64_t, std::vector<Member>>> scales_;
};

}  // namespace lightwalk
