#include "core/light/find_light_groups.h"

#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <set>
#include <variant>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr float kWidestSun = 0.0239f;  ///< solid angle of 10 degrees [sr]
constexpr std::size_t kMostNamed = 20;

bool sends_light(PrimitiveType type) {
    return type == PrimitiveType::light || type == PrimitiveType::glow ||
           type == PrimitiveType::spotlight || type == PrimitiveType::illum;
}

/// A modifier on its own, or what surfaces of it look like by way of others.
class EmittingModifiers {
  public:
    explicit EmittingModifiers(const Scene& scene)
        : scene_(scene), known_(scene.modifier_count(), kUnknown) {}

    bool operator()(ModifierId modifier) {
        if (modifier == kVoid) return false;
        char& known = known_[static_cast<std::size_t>(index(modifier))];
        if (known != kUnknown) return known == kYes;
        known = kNo;  // while it is looked at: modifiers may refer to each other in a circle
        const ModifierRecord& record = scene_.modifier(modifier);
        bool emits = sends_light(record.type) || (*this)(record.next);
        for (const ModifierId other : record.references) emits = (*this)(other) || emits;
        known_[static_cast<std::size_t>(index(modifier))] = emits ? kYes : kNo;
        return emits;
    }

  private:
    static constexpr char kUnknown = 0, kNo = 1, kYes = 2;
    const Scene& scene_;
    std::vector<char> known_;
};

/// A modifier that emits.
struct GroupMember {
    ModifierId modifier = kVoid;
    std::string own;    ///< its name
    std::string name;   ///< what it is called by
    std::string usual;  ///< its usual group
};

/// The name of what lies below textures and patterns: generators of smooth surfaces put some of
/// names of their own on top (gensurf -s), the same one for all.
const std::string& name_of(const Scene& scene, ModifierId modifier) {
    ModifierId at = modifier;
    for (std::size_t i = 0; i < scene.modifier_count(); ++i) {  // there may be circles
        const ModifierRecord& record = scene.modifier(at);
        const PrimitiveKind kind = kind_of(record.type);
        if (kind != PrimitiveKind::texture && !is_pattern(kind)) return record.name;
        if (record.next == kVoid) break;
        at = record.next;
    }
    return scene.modifier(modifier).name;
}

bool is_glow(const Scene& scene, ModifierId modifier) {
    const std::optional<ModifierId> material = scene.material_of(modifier);
    return material && scene.modifier(*material).type == PrimitiveType::glow;
}

/// In the order of their surfaces. Aliases and copies of octrees may have one name: they are one
/// emitter for who names groups.
std::vector<GroupMember> members_of(const Scene& scene) {
    EmittingModifiers emits(scene);
    std::map<std::int32_t, std::size_t> places;
    std::vector<GroupMember> emitters;
    const SurfaceTable& surfaces = scene.surfaces();
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const Surface surface = scene.surface(SurfaceId{static_cast<std::int32_t>(i)});
        const ModifierId modifier = surface.modifier();
        if (!emits(modifier)) continue;
        const auto [place, is_new] = places.try_emplace(index(modifier), emitters.size());
        if (is_new) {
            const std::string& name = name_of(scene, modifier);
            emitters.push_back({modifier, scene.modifier(modifier).name, name, name});
        }
        if (surface.type() != PrimitiveType::source) continue;
        const Shape shape = surface.shape();
        const auto* at_infinity = std::get_if<SourceShape>(&shape);
        const bool sun =
            at_infinity && at_infinity->solid_angle < kWidestSun && !is_glow(scene, modifier);
        emitters[place->second].usual = sun ? "sun" : "sky";
    }
    return emitters;
}

std::string names_of(const std::vector<GroupMember>& emitters) {
    std::set<std::string> names;
    for (const GroupMember& emitter : emitters) names.insert(emitter.name);
    std::string text;
    std::size_t count = 0;
    for (const std::string& name : names) {
        if (count++ == kMostNamed) return text + " ...";
        text += (text.empty() ? "" : " ") + name;
    }
    return text.empty() ? "nothing" : text;
}

/// In the name of a file or of a channel.
std::string fit_name(std::string name) {
    for (char& c : name) {
        if (c == '/' || static_cast<unsigned char>(c) <= ' ') c = '_';
    }
    return name == kRestGroup ? name + "_light" : name;
}

bool matches(const LightGroupPattern& group, const GroupMember& emitter) {
    return std::ranges::any_of(group.patterns, [&](const std::string& pattern) {
        return fnmatch(pattern.c_str(), emitter.name.c_str(), 0) == 0 ||
               fnmatch(pattern.c_str(), emitter.own.c_str(), 0) == 0;
    });
}

/// Names of the groups that emitters belong to: `wanted` or the usual ones.
class GroupNames {
  public:
    std::size_t number_of(const std::string& name) {
        const auto [place, is_new] = numbers_.try_emplace(name, names.size());
        if (is_new) names.push_back(name);
        if (names.size() > kMostLightGroups)
            throw InputError("more than " + std::to_string(kMostLightGroups) +
                             " light groups: gather them by patterns, --light-group NAME=PATTERN");
        return place->second;
    }
    std::vector<std::string> names;

  private:
    std::map<std::string, std::size_t> numbers_;
};

}  // namespace

void check_group_names(const std::vector<LightGroupPattern>& wanted) {
    std::set<std::string> names;
    for (const LightGroupPattern& group : wanted) {
        if (group.name.empty() || group.patterns.empty())
            throw InputError("a light group needs a name and a pattern: NAME=PATTERN");
        if (group.name == kRestGroup)
            throw InputError("light group \"rest\" is what no pattern names: choose another name");
        if (fit_name(group.name) != group.name)
            throw InputError("light group \"" + group.name +
                             "\": a name is part of a file's, without / and blanks");
        if (!names.insert(group.name).second)
            throw InputError("light group \"" + group.name +
                             "\" is there twice: name its patterns at once, NAME=PATTERN,PATTERN");
    }
    if (wanted.size() >= kMostLightGroups)
        throw InputError("more than " + std::to_string(kMostLightGroups - 1) + " light groups");
}

LightGroups find_light_groups(const Scene& scene, const RenderOptions& light,
                              const std::vector<LightGroupPattern>& wanted) {
    const std::vector<GroupMember> emitters = members_of(scene);
    GroupNames groups;
    std::vector<std::size_t> members(wanted.size());
    check_group_names(wanted);
    for (const LightGroupPattern& group : wanted) (void)groups.number_of(group.name);
    LightGroups found;
    constexpr std::uint8_t kRest = 0xff;
    found.of_modifier.assign(scene.modifier_count(), kRest);
    bool rest = light.ambient_value != Rgb{} || light.ambient_weight > 0;
    for (const GroupMember& emitter : emitters) {
        std::uint8_t& group = found.of_modifier[static_cast<std::size_t>(index(emitter.modifier))];
        if (wanted.empty()) {
            group = static_cast<std::uint8_t>(groups.number_of(fit_name(emitter.usual)));
            continue;
        }
        const auto first = std::ranges::find_if(
            wanted, [&](const LightGroupPattern& one) { return matches(one, emitter); });
        if (first == wanted.end()) {
            rest = true;
            continue;
        }
        group = static_cast<std::uint8_t>(first - wanted.begin());
        ++members[group];
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
        if (members[i] == 0)
            throw InputError("light group \"" + wanted[i].name +
                             "\": nothing that emits light has such a modifier; there is " +
                             names_of(emitters));
    }
    if (rest || groups.names.empty()) (void)groups.number_of(kRestGroup);
    found.names = std::move(groups.names);
    // Without a group for the rest nothing but what has one is told of.
    found.of_constant = static_cast<std::uint8_t>(found.names.size() - 1);
    std::ranges::replace(found.of_modifier, kRest, found.of_constant);
    return found;
}

}  // namespace lightwalk
