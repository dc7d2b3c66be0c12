#pragma once
// What a walk's frames took, for --stats: its size grows by some 300 bytes a frame, whatever the
// frames' audits found.
#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/cloud/cloud_frame.h"

namespace lightwalk {

/// Values counted by size, so that any number of them takes the same room.
class ErrorHistogram {
  public:
    void add(std::span<const float> values);
    [[nodiscard]] std::size_t count() const { return count_; }
    /// The value that a share (0 ... 1) of the values lies below, within 2 %; 0 where there are
    /// none. Values below 1e-5 count as 0, those above 1e5 as 1e5.
    [[nodiscard]] double quantile(double share) const;

  private:
    static constexpr std::size_t kBins = 1200;
    std::array<std::uint64_t, kBins + 1> bins_{};  ///< 120 a decade; the first: next to nothing
    std::size_t count_ = 0;
};

/// The frames of a walk that reused points.
class WalkReport {
  public:
    void add(CloudReport frame);
    [[nodiscard]] bool empty() const { return frames_.empty(); }
    /// "reused", "audit" and "frames"; the first frame, which has nothing to reuse, counts in the
    /// last one only.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    struct Audit {
        std::size_t pixels = 0;
        double median_error = 0, error_95 = 0, median_floor = 0, floor_95 = 0;
    };
    struct Drawn {
        CloudReport report;  ///< without the audit's pixels
        std::optional<Audit> audit;
    };
    [[nodiscard]] static nlohmann::ordered_json json_of(const Audit& audit);
    [[nodiscard]] static nlohmann::ordered_json json_of(const Drawn& frame);

    std::vector<Drawn> frames_;
    ErrorHistogram errors_, floors_;  ///< of all frames but the first
};

}  // namespace lightwalk
