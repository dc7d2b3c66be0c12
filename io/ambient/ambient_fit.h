#pragma once
// Ambient values that were computed with some options, converted for a run with other options.
#include <optional>
#include <string>
#include <vector>

#include "core/ambient/ambient_record.h"
#include "core/transport/options.h"

namespace lightwalk {

/// Converts between the values of an ambient file, whose header names the options that they were
/// computed with, and the values of a run.
///
/// * -aa: validity radii are stored divided by it, so a value reaches as far as the run's -aa lets
///   it. The azimuths in which a value has found obstructions stay those within the file's -aa.
/// * -ar: a radius that equals the least one of the file's -ar may have been smaller before it was
///   raised to that; it shrinks to the run's least radius where that is smaller. No radius is
///   larger than the run's -ar allows.
/// * -ab: a value of level l holds (-ab - l) bounces of light. In a run with another -ab it is used
///   at the level that needs as many bounces; values with more bounces than the run follows are not
///   used.
/// * The other options change how exact the values are (-ad -as), or the constant that replaces
///   further bounces (-av -aw): values are used unchanged.
class AmbientFit {
  public:
    /// @param header  the file's header; an option that it does not name counts as the run's
    /// @param limits  limits of the run: the scene's cube, -aa and -ar
    AmbientFit(const std::vector<std::string>& header, const RenderOptions& options,
               const AmbientLimits& limits);

    /// A value of the file, converted for the run; nothing when the run cannot use it.
    [[nodiscard]] std::optional<AmbientRecord> for_run(AmbientRecord record) const;
    /// A value of the run, converted for the file; nothing when the value holds more bounces than
    /// the file's -ab has.
    [[nodiscard]] std::optional<AmbientRecord> for_file(AmbientRecord record) const;

    /// The options that differ, e.g. "-aa 0.1 (not 0.2), -ab 1 (not 2)"; "" when all are equal.
    [[nodiscard]] const std::string& difference() const { return difference_; }
    /// Whether the run computes values that for_file() cannot convert.
    [[nodiscard]] bool loses_values() const { return level_shift_ > 0; }

  private:
    int level_shift_ = 0;  ///< the run's level is the file's plus this
    bool finer_ = false;   ///< the run's least radius is smaller than the file's
    double file_least_radius_ = 0;
    AmbientLimits limits_;
    std::string difference_;
};

/// The header line that names the options of an ambient file, in Radiance's order.
[[nodiscard]] std::string ambient_option_line(const RenderOptions& options);

}  // namespace lightwalk
