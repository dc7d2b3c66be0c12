#include <algorithm>
#include <cassert>
#include <set>
#include <string>

#include "core/model/transform_args.h"
#include "core/scene/scene_tables.h"

namespace lightwalk {
namespace {

using enum PrimitiveType;

/// The primitive an alias stands for, at the end of the trail.
const Primitive& alias_target(const std::vector<Primitive>& modifiers, const Primitive& primitive) {
    const Primitive* p = &primitive;
    while (p->type == alias) {
        if (p->references.empty() || p->references[0] < 0) {
            throw InputError(p->where, "alias \"" + p->name + "\": bad reference");
        }
        p = &modifiers[static_cast<std::size_t>(p->references[0])];  // always an earlier one
    }
    return *p;
}

/// Replaces a modifier whose file is missing, so that a scene can be rendered in which no ray meets
/// it.
class UnavailableModifier final : public Modifier {
  public:
    explicit UnavailableModifier(std::string problem) : problem_(std::move(problem)) {}
    [[nodiscard]] bool shade(Ray&, TraceContext&) const override { throw InputError(problem_); }
    [[nodiscard]] const std::string* problem() const override { return &problem_; }

  private:
    std::string problem_;
};

/// Whether two records say the same, but for what they refer to.
bool is_same(const ModifierRecord& a, const ModifierRecord& b) {
    return a.type == b.type && a.next == b.next && a.name == b.name &&
           a.references == b.references && a.primitive->type == b.primitive->type &&
           a.primitive->strings == b.primitive->strings &&
           a.primitive->reals == b.primitive->reals &&
           a.primitive->references == b.primitive->references;
}

}  // namespace

ModifierTable::ModifierTable(const std::vector<LoadedModel>& models) {
    std::size_t count = 1;  // the Lambertian material of the irradiance modes
    for (const LoadedModel& loaded : models)
        count += std::max(loaded.modifiers().size(), loaded.contents().modifiers.size());
    records_.reserve(count);
    for (const LoadedModel& loaded : models) add(loaded, 0, loaded.contents().modifiers.size());
    for (const LoadedModel& loaded : models)
        add(loaded, loaded.contents().modifiers.size(), loaded.modifiers().size());
    used_.assign(records_.size(), false);
}

/// Modifiers first ... last - 1 of a model.
void ModifierTable::add(const LoadedModel& loaded, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
        const Primitive& primitive = loaded.modifiers()[i];
        ModifierRecord record;
        record.name = primitive.name;
        record.named_phong = primitive.name == "Phong";
        record.next = loaded.global(primitive.modifier);
        const Primitive& acts_as = alias_target(loaded.modifiers(), primitive);
        record.type = acts_as.type;
        record.primitive = &acts_as;
        for (const std::int32_t r : acts_as.references)
            record.references.push_back(loaded.global(r));
        records_.push_back(std::move(record));
    }
}

/// What a modifier refers to comes before it, but for circles of antimatter.
void ModifierTable::adopt(const ModifierTable& base) {
    std::vector<bool> same(records_.size(), false);
    const auto is_kept = [&](ModifierId id) {
        return id == kVoid || same[static_cast<std::size_t>(index(id))];
    };
    const std::size_t common = std::min(records_.size(), base.records_.size() - 1);
    for (std::size_t i = 0; i < common; ++i) {
        ModifierRecord& record = records_[i];
        same[i] = is_same(record, base.records_[i]) && is_kept(record.next) &&
                  std::ranges::all_of(record.references, is_kept);
        if (same[i]) record.node = base.records_[i].node;
    }
}

void ModifierTable::use(ModifierId id) {
    std::vector<ModifierId> todo{id};
    while (!todo.empty()) {
        const ModifierId next = todo.back();
        todo.pop_back();
        if (next == kVoid || used_[static_cast<std::size_t>(index(next))]) continue;
        used_[static_cast<std::size_t>(index(next))] = true;
        const ModifierRecord& record = (*this)[next];
        todo.push_back(record.next);
        if (record.type == antimatter) {
            has_antimatter_ = true;
            if (!record.references.empty()) todo.push_back(record.references[0]);
        } else {
            todo.insert(todo.end(), record.references.begin(), record.references.end());
        }
    }
}

std::vector<NamedFile> ModifierTable::pictures() const {
    constexpr std::size_t kPictureOfColorpict = 3;  // string argument after three functions
    std::vector<NamedFile> files;
    std::set<std::string> seen;
    for (std::size_t i = 0; i < records_.size(); ++i) {
        const ModifierRecord& record = records_[i];
        if (!used_[i] || record.node || record.type != PrimitiveType::colorpict) continue;
        const std::vector<std::string>& strings = record.primitive->strings;
        if (strings.size() > kPictureOfColorpict &&
            seen.insert(strings[kPictureOfColorpict]).second)
            files.push_back({NamedFile::Kind::picture, strings[kPictureOfColorpict]});
    }
    return files;
}

void ModifierTable::compile(FindModifierFactory modifier_factory, Resources& resources,
                            WarningSink& warnings, const TaskRunner& task_runner) {
    resources.prepare(pictures(), task_runner);
    TransformMemo transforms;
    for (std::size_t i = 0; i < records_.size(); ++i) {
        if (used_[i] && !records_[i].node)
            compile(ModifierId{static_cast<std::int32_t>(i)}, modifier_factory, resources,
                    transforms, warnings);
    }
}

void ModifierTable::compile(ModifierId id, FindModifierFactory modifier_factory,
                            Resources& resources, TransformMemo& transforms,
                            WarningSink& warnings) {
    ModifierRecord& record = records_[static_cast<std::size_t>(index(id))];
    const Primitive& primitive = *record.primitive;
    const ModifierFactory factory = modifier_factory(record.type);
    assert(factory);  // every modifier has one
    const ModifierBuild build{
        primitive,
        id,
        record.next,
        resources,
        functions_,
        transforms,
        warnings,
        [&record](std::size_t k) {
            return k < record.references.size() ? record.references[k] : kVoid;
        },
        [&primitive](std::size_t k) {
            return k >= primitive.references.size() || primitive.references[k] == kUndefinedIndex;
        },
        [this](ModifierId m) { return is_transparent(m); }};
    try {
        record.node = factory(build);
    } catch (const MissingFile& missing) {
        warnings.warn(missing.what());
        record.node = std::make_unique<UnavailableModifier>(missing.what());
    }
}

std::optional<ModifierId> ModifierTable::material_of(ModifierId first) const {
    for (ModifierId m = first; m != kVoid; m = (*this)[m].next) {
        if (is_material((*this)[m].type) || is_mixture((*this)[m].type)) return m;
    }
    return std::nullopt;
}

MaterialTraits ModifierTable::material_traits(ModifierId material) const {
    const std::shared_ptr<const Modifier>& node = (*this)[material].node;
    return node ? node->traits() : MaterialTraits{};
}

bool ModifierTable::is_transparent(ModifierId first) const {
    const auto material = material_of(first);
    return material && material_traits(*material).transparent;
}

SurfaceTraits ModifierTable::traits(ModifierId first) const {
    const auto material = material_of(first);
    if (!material) return {};
    const MaterialTraits traits = material_traits(*material);
    // Antimatter can cut any surface away.
    const bool blocks = traits.blocks_shadow_rays && !has_antimatter_;
    const bool clear = traits.clear_from_behind && !has_antimatter_;
    return {true, traits.transparent,
            blocks  ? ShadowClass::blocks
            : clear ? ShadowClass::clear_from_behind
                    : ShadowClass::needs_shading};
}

ModifierTraits ModifierTable::all_traits() const {
    std::vector<SurfaceTraits> all(records_.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (used_[i]) all[i] = traits(ModifierId{static_cast<std::int32_t>(i)});
    }
    return {std::move(all), traits(kVoid)};
}

ModifierId ModifierTable::add(ModifierRecord record) {
    records_.push_back(std::move(record));
    used_.push_back(true);
    return ModifierId{static_cast<std::int32_t>(records_.size()) - 1};
}

}  // namespace lightwalk
