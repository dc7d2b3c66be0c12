#pragma once
// What differs between two descriptions of a scene, one read before and one after its files were
// edited.
#include <cstddef>
#include <memory>
#include <vector>

#include "core/model/primitive.h"

namespace lightwalk {

/// Where a primitive stands in a file makes no difference. Modifiers of the two are the same ones
/// where they have the same name and are defined as the same of several of that name.
struct ModelDifference {
    /// Of the model after: those that are others, or that the one before has not.
    std::vector<std::size_t> modifiers;
    std::size_t sources = 0;  ///< sources at infinity that are others, have come, or are gone
    /// Surfaces but for these: those of the model before that are gone, those of the model after
    /// that have come. One that has moved, or has another modifier, is in both.
    std::vector<std::size_t> gone, come;
    /// The part of the lists of all surfaces outside of which they are the same.
    std::size_t first = 0, before_count = 0, after_count = 0;
    /// Whether both models' modifiers have the same indices, as far as both have them.
    bool modifiers_in_place = true;
    /// Whether a walk knows the surfaces of the scene before by keys (SurfaceKeys) that go on.
    bool keys_kept = true;
    /// Whether in both lists the same places are those of sources.
    bool sources_in_place = true;
    /// Whether a scene of the model after can be one of the model before under other modifiers and
    /// sources (ModelChange).
    bool same_geometry = true;

    [[nodiscard]] bool has_surfaces() const { return !gone.empty() || !come.empty(); }
    [[nodiscard]] bool is_none() const {
        return modifiers.empty() && sources == 0 && !has_surfaces();
    }
};

struct ComparedModel {
    /// The model after, with the modifiers of the model before at their indices where that is
    /// possible: `after` itself, or a copy. What is not defined any more then stays as it was.
    std::shared_ptr<const Model> model;
    ModelDifference difference;  ///< from the model before to `model`
};

/// Compares in time proportional to the models' sizes.
[[nodiscard]] ComparedModel compare_models(const Model& before, std::shared_ptr<const Model> after);

}  // namespace lightwalk
