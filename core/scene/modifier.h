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
class Bsdf;
class FunctionBinding;
class FunctionEnvironment;
class TransformMemo;

/// How the appearance of a material changes when the eye moves.
enum class Appearance : std::uint8_t {
    unknown,   ///< cannot be predicted
    constant,  ///< does not change
    glossy,    ///< has a rough specular lobe
    polished,  ///< constant, dimmed a little by the mirror-like reflection on top of it
    mirror,    ///< only a mirror-like reflection
    pane,      ///< shows what lies straight behind it, with a mirror-like reflection on top
    absent,    ///< invisible: shows what lies behind it
    another,   ///< that of another modifier (MaterialTraits::seen)
};

/// Properties of a material that are needed before it is shaded.
struct MaterialTraits {
    /// Nominally transparent: of a type through which light passes (trans, glass, ...), however
    /// little.
    bool transparent = false;
    /// Blocks every shadow ray, so that none needs to be shaded. Where false, each shadow ray that
    /// meets the material has to be shaded.
    bool blocks_shadow_rays = false;
    /// Shadow rays that meet its back go on as if nothing were there.
    bool clear_from_behind = false;
    /// Appearance to primary rays, unless textures perturb its normals.
    Appearance appearance = Appearance::unknown;
    /// Specular reflectance; for polished ones and mirrors at normal incidence.
    double gloss = 0;
    double roughness = 0;     ///< for glossy ones: rms slope of the facets
    double diffuse = 0;       ///< for glossy ones: diffuse reflectance
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
    /// Traits of a material, without regard to its textures.
    [[nodiscard]] virtual MaterialTraits traits() const { return {}; }
    /// For a pattern that only multiplies ray.pattern by the value of one function in single
    /// precision (unless that has an error): that function. Else null.
    [[nodiscard]] virtual const FunctionBinding* brightness_function() const { return nullptr; }
    /// For a material of a BSDF file: what the file says. Else null.
    [[nodiscard]] virtual const Bsdf* bsdf() const { return nullptr; }
    /// For one that cannot be shaded, as its file is missing: what shade() throws. Else null.
    [[nodiscard]] virtual const std::string* problem() const { return nullptr; }
};

/// Arguments of a modifier factory.
struct ModifierBuild {
    const Primitive& primitive;  ///< for an alias: the primitive it stands for
    ModifierId self;             ///< the modifier under construction (the alias, if it is one)
    ModifierId next;             ///< the modifier's own modifier
    Resources& resources;
    FunctionEnvironment& functions;
    TransformMemo& transforms;
    WarningSink& warnings;
    /// Global id of primitive.references[i]; kVoid for void. `undefined`: whether that name is
    /// defined nowhere.
    std::function<ModifierId(std::size_t)> reference;
    std::function<bool(std::size_t)> undefined;
    /// Whether the material at the end of a modifier's chain is nominally transparent.
    std::function<bool(ModifierId)> is_transparent;
};

/// Throws InputError for bad arguments; MissingFile makes the scene warn, and fail when the
/// modifier is first shaded.
using ModifierFactory = std::unique_ptr<const Modifier> (*)(const ModifierBuild&);

/// The factory for a type; null for types that are no modifiers.
using FindModifierFactory = ModifierFactory (*)(PrimitiveType type);

/// A modifier of a scene, compiled, with its place in the chain.
struct ModifierRecord {
    PrimitiveType type{};     ///< what it acts as (an alias: its target's type)
    ModifierId next = kVoid;  ///< its own modifier
    std::string name;
    bool named_phong = false;  ///< named exactly "Phong": transmitted rays are not bent by textures
    const Primitive* primitive = nullptr;  ///< arguments (an alias: its target's)
    /// Null when no surface uses it. Scenes that are changes of one another share some.
    std::shared_ptr<const Modifier> node;
    std::vector<ModifierId>
        references;  ///< global ids of primitive->references (kVoid: void or undefined)
};

}  // namespace lightwalk
