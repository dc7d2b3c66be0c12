#include "core/model/model_difference.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace lightwalk {
namespace {

/// Of each modifier of one model its index in another one's; kUndefinedIndex: it has none there.
using IndexMap = std::vector<std::int32_t>;

std::int32_t mapped(const IndexMap& map, std::int32_t index) {
    return index < 0 ? index : map[static_cast<std::size_t>(index)];
}

/// Modifiers with the same names, the first with the first and so on.
IndexMap match_modifiers(const Model& before, const Model& after) {
    std::map<std::string_view, std::vector<std::int32_t>> named;
    for (std::size_t i = 0; i < before.modifiers.size(); ++i)
        named[before.modifiers[i].name].push_back(static_cast<std::int32_t>(i));
    std::map<std::string_view, std::size_t> met;
    IndexMap map;
    for (const Primitive& modifier : after.modifiers) {
        const auto found = named.find(modifier.name);
        const std::size_t n = met[modifier.name]++;
        const bool known = found != named.end() && n < found->second.size();
        map.push_back(known ? found->second[n] : kUndefinedIndex);
    }
    return map;
}

/// Whether a primitive of the model after is one of the model before.
bool is_same(const Primitive& before, const Primitive& after, const IndexMap& map) {
    return before.type == after.type && before.name == after.name &&
           before.modifier == mapped(map, after.modifier) && before.strings == after.strings &&
           before.reals == after.reals &&
           std::ranges::equal(before.references, after.references,
                              [&](std::int32_t a, std::int32_t b) { return a == mapped(map, b); });
}

bool is_same(const RealArguments& a, const RealArguments& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] != b[i]) return false;
    return true;
}

bool is_same(const SurfacePrimitive& before, const SurfacePrimitive& after, const IndexMap& map) {
    return before.type == after.type && before.name == after.name &&
           before.modifier == mapped(map, after.modifier) && is_same(before.reals, after.reals) &&
           before.strings.size() == after.strings.size() &&
           (before.strings.empty() || before.strings.to_strings() == after.strings.to_strings());
}

// The model after with the indices of the model before.

/// Those that the model before has not come behind its own.
IndexMap places_behind(const Model& before, const IndexMap& map) {
    IndexMap places = map;
    auto next = static_cast<std::int32_t>(before.modifiers.size());
    for (std::int32_t& place : places)
        if (place < 0) place = next++;
    return places;
}

/// False: a modifier would refer to a later one.
bool place_modifiers(const Model& after, const IndexMap& places, std::vector<Primitive>& placed) {
    for (std::size_t i = 0; i < places.size(); ++i) {
        Primitive modifier = after.modifiers[i];
        modifier.modifier = mapped(places, modifier.modifier);
        bool in_order = modifier.modifier < places[i];
        for (std::int32_t& reference : modifier.references) {
            reference = mapped(places, reference);
            in_order = in_order && reference < places[i];
        }
        if (!in_order) return false;
        const auto place = static_cast<std::size_t>(places[i]);
        if (place >= placed.size()) placed.resize(place + 1);
        placed[place] = std::move(modifier);
    }
    return true;
}

/// False: what one generator has written would not stay together.
bool place_skies(const Model& after, const IndexMap& places, std::vector<GeneratedPart>& skies) {
    skies = after.skies;
    for (GeneratedPart& sky : skies) {
        const std::int32_t count = sky.last_modifier - sky.first_modifier;
        if (count == 0) continue;
        const std::int32_t first = mapped(places, sky.first_modifier);
        for (std::int32_t i = 0; i < count; ++i)
            if (mapped(places, sky.first_modifier + i) != first + i) return false;
        sky.first_modifier = first;
        sky.last_modifier = first + count;
    }
    return true;
}

bool is_identity(const IndexMap& map, std::size_t size) {
    if (map.size() < size) return false;
    for (std::size_t i = 0; i < map.size(); ++i)
        if (map[i] != static_cast<std::int32_t>(i)) return false;
    return true;
}

/// Null where it is not possible.
std::shared_ptr<const Model> placed_model(const Model& before,
                                          const std::shared_ptr<const Model>& after,
                                          const IndexMap& places) {
    if (is_identity(places, before.modifiers.size())) return after;
    auto model = std::make_shared<Model>();
    model->modifiers = before.modifiers;
    if (!place_modifiers(*after, places, model->modifiers) ||
        !place_skies(*after, places, model->skies))
        return nullptr;
    model->header = after->header;
    model->cube = after->cube;
    for (std::size_t i = 0; i < after->surfaces.size(); ++i) {
        SurfacePrimitive surface = after->surfaces[i];
        surface.modifier = mapped(places, surface.modifier);
        model->surfaces.add(surface);
    }
    model->surfaces.trim();
    return model;
}

// What differs.

/// The next place of a surface that is, or is not, a source at infinity.
std::size_t next_of(const SurfaceList& list, std::size_t i, bool source) {
    while (i < list.size() && (list.type(i) == PrimitiveType::source) != source) ++i;
    return i;
}

/// How many of those surfaces differ that are sources, or that are not, in their order.
std::size_t count_others(const SurfaceList& before, const SurfaceList& after, const IndexMap& map,
                         bool sources) {
    std::size_t others = 0;
    std::size_t a = next_of(before, 0, sources), b = next_of(after, 0, sources);
    while (a < before.size() || b < after.size()) {
        const bool both = a < before.size() && b < after.size();
        if (!both || !is_same(before[a], after[b], map)) ++others;
        if (a < before.size()) a = next_of(before, a + 1, sources);
        if (b < after.size()) b = next_of(after, b + 1, sources);
    }
    return others;
}

void find_range(const SurfaceList& before, const SurfaceList& after, const IndexMap& map,
                ModelDifference& difference) {
    const std::size_t most = std::min(before.size(), after.size());
    std::size_t first = 0, last = 0;
    while (first < most && is_same(before[first], after[first], map)) ++first;
    while (last < most - first &&
           is_same(before[before.size() - 1 - last], after[after.size() - 1 - last], map))
        ++last;
    difference.first = first;
    difference.before_count = before.size() - first - last;
    difference.after_count = after.size() - first - last;
}

/// Where as many have come as are gone each is compared with the one in its place.
void list_surfaces(const SurfaceList& before, const SurfaceList& after, const IndexMap& map,
                   ModelDifference& difference) {
    const bool pairs = difference.before_count == difference.after_count;
    const auto list = [&](const SurfaceList& some, std::size_t count,
                          std::vector<std::size_t>& into) {
        for (std::size_t i = difference.first; i < difference.first + count; ++i) {
            if (some.type(i) == PrimitiveType::source) continue;
            if (!pairs || !is_same(before[i], after[i], map)) into.push_back(i);
        }
    };
    list(before, difference.before_count, difference.gone);
    list(after, difference.after_count, difference.come);
}

bool have_sources_in_place(const SurfaceList& before, const SurfaceList& after) {
    if (before.size() != after.size()) return false;
    for (std::size_t i = 0; i < before.size(); ++i)
        if ((before.type(i) == PrimitiveType::source) != (after.type(i) == PrimitiveType::source))
            return false;
    return true;
}

bool places_models(const SurfaceList& list) {
    for (std::size_t i = 0; i < list.size(); ++i)
        if (is_placement(list.type(i))) return true;
    return false;
}

ModelDifference difference_of(const Model& before, const Model& after, const IndexMap& map) {
    ModelDifference difference;
    for (std::size_t i = 0; i < after.modifiers.size(); ++i) {
        const std::int32_t same = map[i];
        if (same < 0 ||
            !is_same(before.modifiers[static_cast<std::size_t>(same)], after.modifiers[i], map))
            difference.modifiers.push_back(i);
    }
    difference.sources = count_others(before.surfaces, after.surfaces, map, true);
    find_range(before.surfaces, after.surfaces, map, difference);
    if (count_others(before.surfaces, after.surfaces, map, false) > 0)
        list_surfaces(before.surfaces, after.surfaces, map, difference);
    difference.sources_in_place = have_sources_in_place(before.surfaces, after.surfaces);
    return difference;
}

}  // namespace

ComparedModel compare_models(const Model& before, std::shared_ptr<const Model> after) {
    const IndexMap map = match_modifiers(before, *after);
    std::shared_ptr<const Model> placed = placed_model(before, after, places_behind(before, map));
    ComparedModel compared;
    if (!placed) {
        compared.difference = difference_of(before, *after, map);
        compared.difference.modifiers_in_place = compared.difference.same_geometry = false;
        compared.model = std::move(after);
        return compared;
    }
    IndexMap same(placed->modifiers.size());
    for (std::size_t i = 0; i < same.size(); ++i)
        same[i] = i < before.modifiers.size() ? static_cast<std::int32_t>(i) : kUndefinedIndex;
    compared.difference = difference_of(before, *placed, same);
    // Ids of modifiers that have come would be those of the models that the scene places.
    const bool have_come = placed->modifiers.size() > before.modifiers.size();
    compared.difference.same_geometry =
        !compared.difference.has_surfaces() && !(have_come && places_models(before.surfaces));
    compared.model = std::move(placed);
    return compared;
}

}  // namespace lightwalk
