#include "apps/session/walk_report.h"

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/cloud/reuse_error_controller.h"

namespace lightwalk {
namespace {

constexpr std::array<const char*, kTraceCauses> kCauseNames{
    "none", "uncovered", "hidden", "unsteady", "turned", "uneven", "audited", "refined"};

}  // namespace

void WalkReport::add(CloudReport frame) {
    Drawn drawn;
    const std::vector<float> errors = std::exchange(frame.audit_errors, {});
    const std::vector<float> floors = std::exchange(frame.audit_floors, {});
    if (!errors.empty())
        drawn.audit = Audit{errors.size(), quantile(errors, 0.5), quantile(errors, 0.95),
                            quantile(floors, 0.5), quantile(floors, 0.95)};
    if (!frames_.empty()) {
        errors_.add(errors);
        floors_.add(floors);
    }
    drawn.report = std::move(frame);
    frames_.push_back(std::move(drawn));
}

nlohmann::ordered_json WalkReport::json_of(const Audit& audit) {
    return {{"pixels", audit.pixels},
            {"median_error", audit.median_error},
            {"error_95", audit.error_95},
            {"median_floor", audit.median_floor},
            {"floor_95", audit.floor_95}};
}

nlohmann::ordered_json WalkReport::json_of(const Drawn& frame) {
    const CloudReport& report = frame.report;
    nlohmann::ordered_json uncached;
    for (std::size_t cause = 1; cause < kTraceCauses; ++cause)
        uncached[kCauseNames[cause]] = report.uncached[cause];
    nlohmann::ordered_json json{{"reused", report.reused},
                                {"traced", uncached},
                                {"filled", report.filled},
                                {"inferred", report.inferred},
                                {"points", report.points},
                                {"tightness", report.tightness},
                                {"seconds",
                                 {{"project", report.project_seconds},
                                  {"check", report.check_seconds},
                                  {"trace", report.trace_seconds},
                                  {"infer", report.infer_seconds},
                                  {"keep", report.keep_seconds}}}};
    if (frame.audit) json["audit"] = json_of(*frame.audit);
    return json;
}

nlohmann::ordered_json WalkReport::json() const {
    nlohmann::ordered_json json;
    double reused = 0, pixels = 0;
    for (std::size_t i = 1; i < frames_.size(); ++i) {
        reused += static_cast<double>(frames_[i].report.reused);
        pixels += static_cast<double>(frames_[i].report.pixels);
    }
    json["reused"] = pixels > 0 ? reused / pixels : 0;
    if (errors_.count() > 0)
        json["audit"] =
            json_of(Audit{errors_.count(), errors_.quantile(0.5), errors_.quantile(0.95),
                          floors_.quantile(0.5), floors_.quantile(0.95)});
    for (const Drawn& frame : frames_) json["frames"].push_back(json_of(frame));
    return json;
}

}  // namespace lightwalk
