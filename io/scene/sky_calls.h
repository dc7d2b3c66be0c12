#pragma once
// The skies that generators have written into a scene, at other times.
#include <optional>
#include <string>
#include <vector>

#include "core/model/model_change.h"
#include "core/model/primitive.h"
#include "io/files/library_path.h"
#include "io/generators/sky_command.h"

namespace lightwalk {

/// All calls of gensky and gendaylit in a scene, which follow one clock.
class SkyCalls {
  public:
    /// @param model  as it was read; must outlive this
    SkyCalls(const Model& model, LibraryPath library);

    /// Whether no generator has written a sky.
    [[nodiscard]] bool empty() const { return model_.skies.empty(); }
    /// "file:line: why" the time cannot be changed; "": it can.
    [[nodiscard]] const std::string& refusal() const { return refusal_; }

    // Of the first call; where there is one, and no refusal.
    [[nodiscard]] const SkyCommand& first() const { return calls_.front().command; }
    /// Whether one of them knows types of sky.
    [[nodiscard]] bool has_types() const;

    /// Puts what the generators write for another time in place of what they have written: patterns
    /// and lights of the same names by their indices, and the suns. What the files make of these,
    /// as skies of glow, stays. Throws InputError where a generator fails.
    /// @param change  of the model, with its sources as they were read
    void apply(const SkyTime& time, ModelChange& change) const;
    /// What the generators write for that time, as scene text.
    [[nodiscard]] std::string text(const SkyTime& time) const;

  private:
    struct Call {
        const GeneratedPart* part;
        SkyCommand command;
        std::vector<std::vector<std::string>> pipe;     ///< commands behind it
        std::size_t first_source = 0, last_source = 0;  ///< of ModelChange::sources
        std::size_t before = 0;                         ///< see PlacedSource
    };
    [[nodiscard]] Call read(const GeneratedPart& part) const;
    void find_sources();
    [[nodiscard]] std::string run(const Call& call, const SkyTime& time) const;

    const Model& model_;
    LibraryPath library_;
    std::vector<Call> calls_;
    std::string refusal_;
};

}  // namespace lightwalk
