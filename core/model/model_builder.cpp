#include "core/model/model_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace lightwalk {
namespace {

/// Comparing definitions follows modifiers; beyond this many pairs two definitions count as
/// different.
constexpr std::size_t kMaxComparedPairs = 4096;
constexpr std::size_t kLongestSuggestion = 64;

/// Edit distance (Levenshtein 1966): fewest insertions, deletions and substitutions between two
/// words.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
    }
    return row[b.size()];
}

/// Equal to 1e-6, relative to the second number, or absolutely where that is 0.
bool nearly_equal(double a, double b) {
    if (b == 0) return std::abs(a) <= 1e-6;
    return std::abs(a / b - 1) <= 1e-6;
}

/// Which strings of a primitive name modifiers.
std::vector<std::size_t> reference_strings(const Primitive& primitive) {
    std::vector<std::size_t> places;
    switch (primitive.type) {
        case PrimitiveType::illum:
        case PrimitiveType::mirror:
        case PrimitiveType::alias:
            places = {0};
            break;
        case PrimitiveType::antimatter:
            for (std::size_t i = 0; i < primitive.strings.size(); ++i) places.push_back(i);
            break;
        case PrimitiveType::wgmdfunc:
            places = {0, 4, 8};
            break;
        default:
            if (is_mixture(primitive.type)) places = {0, 1};
    }
    std::erase_if(places, [&](std::size_t i) { return i >= primitive.strings.size(); });
    return places;
}

void check_name(std::string_view name, bool names_modifier, const SourceLocation& where) {
    if (name.find('\t') != std::string_view::npos) {
        throw InputError(where, "identifier \"" + std::string(name) + "\" holds a tab");
    }
    if (names_modifier && (name == "void" || name == "inherit")) {
        throw InputError(where, "illegal modifier name \"" + std::string(name) + "\"");
    }
}

/// Types, counts, numbers and plain strings; modifiers and references are compared by the caller.
bool same_arguments(const Primitive& a, const Primitive& b) {
    if (a.type != b.type || a.strings.size() != b.strings.size() ||
        a.reals.size() != b.reals.size() || a.references.size() != b.references.size()) {
        return false;
    }
    const std::vector<std::size_t> names = reference_strings(a);
    for (std::size_t i = 0; i < a.strings.size(); ++i) {
        if (a.strings[i] != b.strings[i] && std::ranges::find(names, i) == names.end())
            return false;
    }
    return std::equal(a.reals.begin(), a.reals.end(), b.reals.begin(), nearly_equal);
}

}  // namespace

std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& known) {
    if (name.empty() || name.size() > kLongestSuggestion) return {};
    std::size_t best = std::max<std::size_t>(1, name.size() / 3) + 1;
    std::string_view nearest;
    for (const std::string_view candidate : known) {
        if (candidate.size() > kLongestSuggestion) continue;
        const std::size_t distance = edit_distance(name, candidate);
        // The order of `known` must not matter: equally near names go by the alphabet.
        if (distance < best || (distance == best && !nearest.empty() && candidate < nearest)) {
            best = distance;
            nearest = candidate;
        }
    }
    if (nearest.empty()) return {};
    return ", did you mean \"" + std::string(nearest) + "\"?";
}

std::shared_ptr<Model> growable_copy(const Model& model) {
    auto copy = std::make_shared<Model>();
    copy->modifiers = model.modifiers;
    copy->surfaces = model.surfaces.own_copy();
    copy->header = model.header;
    copy->cube = model.cube;
    return copy;
}

ModelBuilder::ModelBuilder(std::shared_ptr<Model> model) : model_(std::move(model)) {
    model_->shapes.reset();  // those of a part of the surfaces
    if (model_->cube) model_->cube->holds_all = false;
    for (std::size_t i = 0; i < model_->modifiers.size(); ++i)
        enter_name(static_cast<std::int32_t>(i));
}

std::string ModelBuilder::suggestion(std::string_view name) const {
    std::vector<std::string_view> known;
    known.reserve(names_.size());
    for (const auto& entry : names_) known.push_back(entry.first);
    return did_you_mean(name, known);
}

std::int32_t ModelBuilder::modifier(const std::string& name, const SourceLocation& where) const {
    const std::int32_t found = reference(name);
    if (found != kUndefinedIndex) return found;
    throw InputError(where, "undefined modifier \"" + name + "\"" + suggestion(name));
}

std::int32_t ModelBuilder::alias_target(const std::string& name,
                                        const SourceLocation& where) const {
    const auto found = names_.find(name);
    if (found != names_.end()) return found->second;
    throw InputError(
        where, "bad reference \"" + name + "\": no modifier has this name" + suggestion(name));
}

std::int32_t ModelBuilder::reference(const std::string& name) const {
    if (name == "void") return kVoidIndex;
    const auto found = names_.find(name);
    return found == names_.end() ? kUndefinedIndex : found->second;
}

std::vector<std::int32_t> ModelBuilder::references(const Primitive& primitive) const {
    std::vector<std::int32_t> result;
    for (const std::size_t i : reference_strings(primitive))
        result.push_back(reference(primitive.strings[i]));
    return result;
}

void ModelBuilder::check_modifier(std::int32_t modifier, const SourceLocation& where) const {
    if (modifier == kVoidIndex) return;
    if (modifier < 0 || static_cast<std::size_t>(modifier) >= model_->modifiers.size()) {
        throw InputError(where,
                         "modifier number " + std::to_string(modifier) + " is not defined yet");
    }
}

bool ModelBuilder::equal(std::int32_t a, std::int32_t b) const {
    std::vector<std::pair<std::int32_t, std::int32_t>> open{{a, b}};
    std::set<std::pair<std::int32_t, std::int32_t>> seen;
    while (!open.empty()) {
        const std::pair<std::int32_t, std::int32_t> pair = open.back();
        open.pop_back();
        if (pair.first == pair.second || !seen.insert(pair).second) continue;
        if (pair.first < 0 || pair.second < 0 || seen.size() > kMaxComparedPairs) return false;
        const Primitive& p = model_->modifiers[static_cast<std::size_t>(pair.first)];
        const Primitive& q = model_->modifiers[static_cast<std::size_t>(pair.second)];
        if (!same_arguments(p, q)) return false;
        open.emplace_back(p.modifier, q.modifier);
        for (std::size_t i = 0; i < p.references.size(); ++i) {
            open.emplace_back(p.references[i], q.references[i]);
        }
    }
    return true;
}

std::int32_t ModelBuilder::add(Primitive primitive) {
    if (is_surface(primitive.type)) {
        check_name(primitive.name, false, primitive.where);
        check_modifier(primitive.modifier, primitive.where);
        return static_cast<std::int32_t>(model_->surfaces.add(primitive));
    }
    check_name(primitive.name, true, primitive.where);
    check_modifier(primitive.modifier, primitive.where);
    if (model_->modifiers.size() >= std::numeric_limits<std::int32_t>::max()) {
        throw InputError(primitive.where, "too many modifiers");
    }
    if (primitive.references.empty()) primitive.references = references(primitive);
    const auto index = static_cast<std::int32_t>(model_->modifiers.size());
    model_->modifiers.push_back(std::move(primitive));
    enter_name(index);
    return index;
}

/// From here on the name of a modifier means it.
void ModelBuilder::enter_name(std::int32_t index) {
    const std::string& name = model_->modifiers[static_cast<std::size_t>(index)].name;
    const auto [entry, is_new] = names_.try_emplace(name, index);
    if (!is_new && !equal(index, entry->second)) entry->second = index;
}

std::int32_t ModelBuilder::add(const SurfacePrimitive& surface) {
    const bool known = surface.modifier >= 0 &&
                       static_cast<std::size_t>(surface.modifier) < model_->modifiers.size();
    if (!known) check_modifier(surface.modifier, surface.where());
    if (surface.name.find('\t') != std::string_view::npos)
        check_name(surface.name, false, surface.where());
    return static_cast<std::int32_t>(model_->surfaces.add(surface));
}

std::int32_t ModelBuilder::add_alias(std::int32_t modifier, const std::string& name,
                                     std::int32_t target, const SourceLocation& where) {
    check_modifier(target, where);
    if (target == kVoidIndex) {
        throw InputError(where, "bad reference \"void\" in alias \"" + name + "\"");
    }
    const Primitive& named = model_->modifiers[static_cast<std::size_t>(target)];
    Primitive alias;
    alias.type = PrimitiveType::alias;
    alias.modifier = modifier;
    alias.name = name;
    alias.references = {named.type == PrimitiveType::alias ? named.references[0] : target};
    alias.strings = {model_->modifiers[static_cast<std::size_t>(alias.references[0])].name};
    alias.where = where;
    return add(std::move(alias));
}

std::int32_t ModelBuilder::rename(const std::string& name, std::int32_t target,
                                  const SourceLocation& where) {
    check_modifier(target, where);
    const std::int32_t own = target == kVoidIndex
                                 ? kVoidIndex
                                 : model_->modifiers[static_cast<std::size_t>(target)].modifier;
    return add_alias(own, name, target, where);
}

std::shared_ptr<Model> ModelBuilder::release() {
    std::shared_ptr<Model> result = std::exchange(model_, std::make_shared<Model>());
    names_.clear();
    result->modifiers.shrink_to_fit();
    result->surfaces.trim();
    return result;
}

}  // namespace lightwalk
