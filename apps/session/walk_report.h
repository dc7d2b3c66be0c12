#pragma once
// What a walk's frames took, for --stats: its size grows by some 300 bytes a frame, whatever the
// frames' audits found.
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "core/cloud/cloud_frame.h"
#include "core/cloud/error_histogram.h"

namespace lightwalk {

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
