#pragma once
// Modifiers: materials, textures, patterns and mixtures, compiled for evaluation.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/model/ids.h"
#include "core/model/primitive.h"
#include "core/model/resources.h"

namespace lightwalk {

struct Ray;
struct TraceContext;
class FunctionBinding;
class FunctionEnvironment;

/// How what a material sends to the eye changes when the eye moves.
enum class Appearance : std::uint8_t {
    unknown,   ///< nobody knows
    constant,  ///< not at all
    glossy,    ///< it has a rough lobe
    polished,  ///< constant, dimmed a little by the mirror-like reflection on top of it
    mirror,    ///< a mirror-like reflection is all there is
    pane,      ///< what lies behind, straight on, with a mirror-like reflection on top of it
    absent,    ///< what lies behind, as if the surface were not there
    another,   ///< as another modifier looks (MaterialTraits::seen)
};

/// What others have to know of a material before they shade it.
struct MaterialTraits {
    /// Nominally: light goes through it (trans, glass, ...), however little.
    bool transparent = false;
    /// No shadow ray gets through, so that none needs to be shaded. A material that is neither has
    /// to be asked ray by ray.
    bool blocks_shadow_rays = false;
    /// To primary rays, unless textures turn its normals.
    Appearance appearance = Appearance::unknown;
    /// Specular reflectance; of polished ones and mirrors when seen from straight above.
    double gloss = 0;
    double roughness = 0;     ///< of glossy ones: rms slope of their facets
    double diffuse = 0;       ///< of glossy ones: reflectance, where that of the lobe is `gloss`
    ModifierId seen = kVoid;  ///< what the eye sees instead (Appearance::another)
};

/// Evaluates one modifier on a ray whose hit is set. Immutable; called from many threads at once.
/// A texture adds to ray.hit.perturbation, a pattern multiplies ray.pattern; both return false. A
/// material sets ray.value (and mirrored, distances, ...) and returns true; so does a mixture that
/// holds a material.
class Modifier {
  public:
    virtual ~Modifier() = default;
    [[nodiscard]] virtual bool shade(Ray& ray, TraceContext& context) const = 0;
    /// Of a material, whatever its textures do.
    [[nodiscard]] virtual MaterialTraits traits() const { return {}; }
    /// Of a pattern that does nothing but multiply ray.pattern by a function's value in single
    /// precision (unless it has an error): that function. Else null.
    [[nodiscard]] virtual const FunctionBinding* brightness_function() const { return nullptr; }
};

/// What a factory may use while the scene is built.
struct ModifierBuild {
    const Primitive& primitive;  ///< for an alias: the primitive it stands for
    ModifierId self;             ///< the modifier under construction (the alias, if it is one)
    ModifierId next;             ///< the modifier's own modifier
    Resources& resources;
    FunctionEnvironment& functions;
    WarningSink& warnings;
    /// Global id of primitive.references[i]; kVoid for void. `undefined` tells names that nothing
    /// defines.
    std::function<ModifierId(std::size_t)> reference;
    std::function<bool(std::size_t)> undefined;
    /// Nominally transparent material at the end of a modifier's chain.
    std::function<bool(ModifierId)> is_transparent;
};

/// Throws InputError for bad arguments; MissingFile makes the scene warn, and fail when the
/// modifier is first shaded.
using ModifierFactory = std::unique_ptr<const Modifier> (*)(const ModifierBuild&);

/// The factory for a type; null for types that are no modifiers, or recognised and refused.
using FindModifierFactory = ModifierFactory (*)(PrimitiveType type);

/// A modifier of a scene, as the tracer walks it.
struct ModifierRecord {
    PrimitiveType type{};     ///< what it acts as (an alias: its target's type)
    ModifierId next = kVoid;  ///< its own modifier
    std::string name;
    bool named_phong = false;  ///< named exactly "Phong": transmitted rays are not bent by textures
    const Primitive* primitive = nullptr;  ///< arguments (an alias: its target's)
    std::unique_ptr<const Modifier> node;  ///< null when no surface uses it
    std::vector<ModifierId>
        references;  ///< global ids of primitive->references (kVoid: void or undefined)
};

}  // namespace lightwalk
