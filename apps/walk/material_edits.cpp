#include "apps/walk/material_edits.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "core/scene/seen_material.h"
#include "io/language/primitive_text.h"

namespace lightwalk {
namespace {

/// The modifier of a name that is the n-th to be defined.
std::optional<std::size_t> find_definition(const Model& model, const std::string& name,
                                           std::uint32_t n) {
    for (std::size_t i = 0; i < model.modifiers.size(); ++i)
        if (model.modifiers[i].name == name && n-- == 0) return i;
    return std::nullopt;
}

std::uint32_t definition_of(const Model& model, std::size_t modifier) {
    const std::string& name = model.modifiers[modifier].name;
    return static_cast<std::uint32_t>(std::count_if(
        model.modifiers.begin(), model.modifiers.begin() + static_cast<std::ptrdiff_t>(modifier),
        [&](const Primitive& earlier) { return earlier.name == name; }));
}

/// Why an edit cannot be made; nothing: it can.
std::optional<std::string> problem_of(const Model& built, const MaterialEdit& edit,
                                      std::optional<std::size_t> modifier) {
    if (!modifier) return "the scene's own files define no such material any more";
    const Primitive& primitive = built.modifiers[*modifier];
    if (to_string(primitive.type) != edit.kind)
        return "it is a " + std::string(to_string(primitive.type)) + " by now";
    return argument_problem(primitive, edit.reals);
}

/// "file:line"; nothing where it comes from no file.
std::string place_text(const SourceLocation& where) {
    std::string text = to_prefix(where);
    while (!text.empty() && (text.back() == ' ' || text.back() == ':')) text.pop_back();
    std::ranges::replace(text, '\n', ' ');
    return text;
}

std::string name_of(const Model& model, std::int32_t modifier) {
    return modifier < 0 ? "void" : model.modifiers[static_cast<std::size_t>(modifier)].name;
}

}  // namespace

CheckedEdits check_edits(const Model& built, const EditsRequest& request) {
    CheckedEdits checked;
    checked.reply.id = request.id;
    for (const MaterialEdit& edit : request.materials) {
        const std::optional<std::size_t> modifier =
            find_definition(built, edit.name, edit.definition);
        if (std::optional<std::string> why = problem_of(built, edit, modifier)) {
            checked.reply.refused.push_back({edit.name, edit.definition, *std::move(why)});
            continue;
        }
        if (edit.reals == built.modifiers[*modifier].reals) continue;
        checked.sound.push_back({*modifier, edit.reals});
        checked.reply.materials.push_back(edit);
    }
    std::ranges::sort(checked.sound, {}, &ModifierEdit::modifier);
    return checked;
}

std::string edited_materials(const Model& built, const std::vector<ModifierEdit>& edits) {
    std::string text =
        "# Changed materials of a walk: in the scene's files these stand in place of the "
        "modifiers\n"
        "# of the same names.\n";
    for (const ModifierEdit& edit : edits) {
        const Primitive& primitive = built.modifiers[edit.modifier];
        text += "\n# " + place_text(primitive.where) + '\n';
        append_primitive(name_of(built, primitive.modifier), to_string(primitive.type),
                         primitive.name, primitive.strings, edit.reals, kFullDigits, text);
    }
    return text;
}

namespace {

/// Collects the modifiers that something is made of.
class LayerList {
  public:
    LayerList(const Scene& scene, const Model& built) : scene_(scene), built_(built) {}

    /// A chain of modifiers, and what mixtures in it are made of.
    void add_chain(ModifierId first) {
        for (ModifierId m = first; m != kVoid && layers_.size() < kMostLayers;
             m = scene_.modifier(m).next) {
            if (!listed_.insert(m).second) return;
            layers_.push_back(layer_of(m));
            const ModifierRecord& record = scene_.modifier(m);
            if (!is_mixture(record.type)) continue;
            for (const ModifierId part : record.references) add_chain(part);
        }
    }
    [[nodiscard]] std::vector<MaterialLayer> release() { return std::move(layers_); }

  private:
    static constexpr std::size_t kMostLayers = 24, kMostStrings = 32;

    [[nodiscard]] MaterialLayer layer_of(ModifierId id) const {
        const ModifierRecord& record = scene_.modifier(id);
        MaterialLayer layer;
        layer.name = record.name;
        layer.kind = to_string(record.type);
        layer.modifier = record.next == kVoid ? "void" : scene_.modifier(record.next).name;
        if (record.primitive == nullptr) return layer;
        const Primitive& primitive = *record.primitive;
        layer.name = primitive.name;
        layer.strings.assign(
            primitive.strings.begin(),
            primitive.strings.begin() +
                static_cast<std::ptrdiff_t>(std::min(kMostStrings, primitive.strings.size())));
        layer.where = place_text(primitive.where);
        if (!is_material(record.type)) return layer;
        layer.names = argument_names(primitive);
        layer.reals = layer.built = primitive.reals;
        const std::optional<std::size_t> own = own_modifier(id);
        if (!own)
            layer.fixed = "It belongs to a file that the scene places: change it there.";
        else if (layer.names.empty())
            layer.fixed = "The numbers of a " + layer.kind + " cannot be changed here.";
        if (!own) return layer;
        layer.definition = definition_of(built_, *own);
        layer.built = built_.modifiers[*own].reals;
        return layer;
    }

    /// Where a modifier's numbers stand in the scene's own model, if they do.
    [[nodiscard]] std::optional<std::size_t> own_modifier(ModifierId id) const {
        auto at = static_cast<std::size_t>(index(id));
        if (at >= built_.modifiers.size()) return std::nullopt;
        while (built_.modifiers[at].type == PrimitiveType::alias)
            at = static_cast<std::size_t>(built_.modifiers[at].references[0]);
        return at;
    }

    const Scene& scene_;
    const Model& built_;
    std::vector<MaterialLayer> layers_;
    std::set<ModifierId> listed_;
};

}  // namespace

MaterialReply describe_material(const Scene& scene, const Model& built, const Hit& hit,
                                std::uint32_t id) {
    MaterialReply reply;
    reply.id = id;
    reply.hit = hit.exists();
    if (!reply.hit) return reply;
    reply.surface = scene.surface(hit.surface).name();
    LayerList layers(scene, built);
    if (const SeenMaterial seen = seen_material(scene, hit.modifier); seen.material)
        layers.add_chain(seen.first);
    layers.add_chain(hit.modifier);
    reply.layers = layers.release();
    return reply;
}

Primitive edited_primitive(const Model& built, const ModifierEdit& edit) {
    Primitive primitive = built.modifiers[edit.modifier];
    primitive.reals = edit.reals;
    return primitive;
}

std::vector<std::size_t> changed_modifiers(const std::vector<ModifierEdit>& before,
                                           const std::vector<ModifierEdit>& after) {
    std::vector<std::size_t> changed;
    const auto add_missing = [&](const std::vector<ModifierEdit>& some,
                                 const std::vector<ModifierEdit>& others) {
        for (const ModifierEdit& edit : some)
            if (std::ranges::find(others, edit) == others.end()) changed.push_back(edit.modifier);
    };
    add_missing(before, after);
    add_missing(after, before);
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    return changed;
}

bool lights_others(const Scene& scene, const std::vector<std::size_t>& modifiers) {
    return std::ranges::any_of(modifiers, [&](std::size_t i) {
        const ModifierRecord& record = scene.modifier(ModifierId{static_cast<std::int32_t>(i)});
        if (is_light(record.type) || record.type == PrimitiveType::mirror) return true;
        return record.node && !record.node->traits().blocks_shadow_rays;
    });
}

std::vector<bool> modifiers_with(const Scene& scene, const std::vector<std::size_t>& edited) {
    std::vector<bool> with(scene.modifier_count());
    std::set<const Primitive*> primitives;  // those of aliases are their targets'
    for (const std::size_t i : edited)
        primitives.insert(scene.modifier(ModifierId{static_cast<std::int32_t>(i)}).primitive);
    const auto is_with = [&](ModifierId id) {
        return id != kVoid && with[static_cast<std::size_t>(index(id))];
    };
    // What a modifier refers to was defined before it.
    for (std::size_t i = 0; i < with.size(); ++i) {
        const ModifierRecord& record = scene.modifier(ModifierId{static_cast<std::int32_t>(i)});
        with[i] = primitives.contains(record.primitive) || is_with(record.next) ||
                  std::ranges::any_of(record.references, is_with);
    }
    return with;
}

}  // namespace lightwalk
