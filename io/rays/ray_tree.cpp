#include "io/rays/ray_tree.h"

#include <algorithm>
#include <utility>

#include "core/light/light_sources.h"
#include "io/options/option_words.h"

namespace lightwalk {
namespace {

int count_ancestors(const Ray& ray) {
    int count = 0;
    for (const Ray* at = ray.parent; at != nullptr; at = at->parent) ++count;
    return count;
}

/// A ray from a surface to a light source, as the direct calculation sends it. In a mist they have
/// both kinds.
bool is_first_shadow_ray(const Ray& ray) {
    return ray.kind == kShadowSame || ray.kind == kShadowThrough;
}

}  // namespace

OutputFields parse_output_fields(std::string_view letters) {
    constexpr std::string_view kTree = "tT";
    OutputFields fields;
    if (!letters.empty() && kTree.find(letters.back()) != std::string_view::npos)
        letters.remove_suffix(1);
    const std::size_t first = letters.find_first_of(kTree);
    fields.record = letters.substr(0, first);
    if (first == std::string_view::npos) return fields;
    fields.tree = letters.substr(letters.find_last_of(kTree) + 1);
    fields.unshadowed = letters.find('T') != std::string_view::npos;
    return fields;
}

void TreeSelection::add(Kind kind_of_names, const std::vector<std::string>& names) {
    if (kind != kind_of_names) *this = {kind_of_names, {}};
    modifiers.insert(modifiers.end(), names.begin(), names.end());
}

bool TreeSelection::takes(const std::string* modifier) const {
    const bool listed =
        modifier && std::find(modifiers.begin(), modifiers.end(), *modifier) != modifiers.end();
    return listed ? kind == Kind::include : kind != Kind::include;
}

RayTree::RayTree(const OutputFields& fields, NumberFormat format, ColorOutput color,
                 TreeSelection selection, bool sensor)
    : records_(fields.tree, format, color),
      selection_(std::move(selection)),
      unshadowed_(fields.unshadowed),
      sensor_(sensor) {
    if (format == NumberFormat::rgbe)
        throw UsageError("option -f: format c needs exactly one colour field, v, r or x");
}

bool RayTree::is_selected(const Ray& ray) const {
    if (!ray.hit.exists() || ray.hit.modifier == kVoid) return selection_.takes(nullptr);
    return selection_.takes(&tracer_->scene().modifier(ray.hit.modifier).name);
}

bool RayTree::meets_source(const Ray& ray) const {
    return ray.target != kNoTarget && ray.hit.exists() &&
           ray.hit.surface == tracer_->lights()[ray.target].object;
}

/// Take back the lines of a shadow ray of this level, the last one, and its descendants when all of
/// them went from one source or mirror straight to the next.
void RayTree::forget_unhindered(int level) {
    auto from = lines_.end();
    do --from;
    while (from != lines_.begin() && (from - 1)->level > level);
    if (!std::all_of(from, lines_.end(), [](const Line& line) { return line.meets_source; }))
        return;
    text_.resize(from->begin);
    lines_.erase(from, lines_.end());
}

void RayTree::finished(const Ray& ray, const Hit& first) {
    if (sensor_ && ray.parent == nullptr) return;
    const int level = count_ancestors(ray);
    lines_.push_back({text_.size(), level, meets_source(ray)});
    if (is_selected(ray)) {
        text_.append(static_cast<std::size_t>(level), '\t');
        records_.append({ray, first, false}, tracer_->scene(), text_);
    }
    if (!unshadowed_ && is_first_shadow_ray(ray)) forget_unhindered(level);
}

std::string RayTree::take() {
    lines_.clear();
    return std::exchange(text_, {});
}

}  // namespace lightwalk
