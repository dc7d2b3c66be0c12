#pragma once
// How values that were computed with some options serve a run with others.
#include <optional>
#include <string>
#include <vector>

#include "core/ambient/ambient_record.h"
#include "core/transport/options.h"

namespace lightwalk {

/// Between the values of an ambient file, whose header names the options that they were made with,
/// and those of a run.
///
/// * -aa: radii are stored per unit of it, so that a value reaches as far as the run's -aa lets it.
///   The azimuths that a value has found to be obstructed stay those within the file's -aa.
/// * -ar: a radius that the file's -ar has raised to its least one shrinks to the run's least one
///   where that is smaller, for what it would have been is not known; none is larger than the run's
///   -ar allows.
/// * -ab: a value of level l holds (-ab - l) bounces of light. In a run with another -ab it serves
///   at the level that asks for as many; values with more bounces than the run follows serve
///   nowhere.
/// * All else changes how exact the values are (-ad -as), or what light they end with (-av -aw):
///   they serve as they are.
class AmbientFit {
  public:
    /// @param header  of the file; an option that it does not name is taken to be the run's
    /// @param limits  of the run: the scene's cube, -aa and -ar
    AmbientFit(const std::vector<std::string>& header, const RenderOptions& options,
               const AmbientLimits& limits);

    /// The file's value as it serves in the run; nothing when it serves nowhere.
    [[nodiscard]] std::optional<AmbientRecord> for_run(AmbientRecord record) const;
    /// The run's value as the file's own options mean it; nothing when they can't: the run follows
    /// more bounces, and the value holds them.
    [[nodiscard]] std::optional<AmbientRecord> for_file(AmbientRecord record) const;

    /// The options that differ, as "-aa 0.1 (not 0.2), -ab 1 (not 2)"; "" when none does.
    [[nodiscard]] const std::string& difference() const { return difference_; }
    /// Whether the run computes values that the file cannot keep.
    [[nodiscard]] bool loses_values() const { return level_shift_ > 0; }

  private:
    int level_shift_ = 0;  ///< the run's level is the file's plus this
    bool finer_ = false;   ///< the run's least radius is smaller than the file's
    double file_least_radius_ = 0;
    AmbientLimits limits_;
    std::string difference_;
};

/// The header line of a file made with these options, as Radiance orders them.
[[nodiscard]] std::string ambient_option_line(const RenderOptions& options);

}  // namespace lightwalk
