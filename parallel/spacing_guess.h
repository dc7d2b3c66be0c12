#pragma once
// How far from each other values will be needed, as the values tell that are there.
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "core/ambient/ambient_point.h"
#include "core/ambient/ambient_record.h"

namespace lightwalk {

/// Learns from values, in cells of several sizes, how large their neighbours are.
class SpacingGuess {
  public:
    explicit SpacingGuess(const AmbientLimits& limits);
    /// Learn.
    void add(const AmbientRecord& record);
    /// Distance up to which a value at the point is likely to serve [m]: the (geometric) mean of
    /// those in the smallest cell around it that holds any; the greatest possible where there are
    /// none.
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

/// Points that were chosen, none within the reach of one before it.
class ApartSet {
  public:
    ApartSet(double least, double greatest);
    /// Whether a point lies within the reach of a chosen one, whose normal is much the same.
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
