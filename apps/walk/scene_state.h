#pragma once
// What a walk has changed in its scene: the description it was read from, with other modifiers and
// sources.
#include <cstdint>
#include <map>
#include <optional>

#include "core/model/model_change.h"
#include "io/scene/sky_calls.h"

namespace lightwalk {

/// By default as the scene was read. Each is all that differs from that, not from the state before.
struct SceneState {
    /// When the generators' skies are seen; nothing: as the files have it.
    std::optional<SkyTime> time;
    /// Modifiers that are others now, by their indices in the model.
    std::map<std::int32_t, Primitive> replaced;
};

/// A scene's description, and what it is in other states.
class SceneStates {
  public:
    /// @param model    as it was read; must outlive this
    /// @param library  by which generators run again
    SceneStates(const Model& model, const LibraryPath& library)
        : read_(unchanged(model)), own_modifiers_(model.modifiers.size()), skies_(model, library) {}

    /// The change that turns the model into this state of it. Throws InputError for indices that
    /// the model has not, and where the time cannot be changed.
    [[nodiscard]] ModelChange change_of(const SceneState& state) const;
    [[nodiscard]] const SkyCalls& skies() const { return skies_; }

  private:
    ModelChange read_;
    std::size_t own_modifiers_;
    SkyCalls skies_;
};

}  // namespace lightwalk
