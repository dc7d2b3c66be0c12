#include "io/contributions/contribution_tally.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/light/light_sources.h"

namespace lightwalk {
namespace {

constexpr std::size_t kBits = 64;  ///< of a word

/// The type of the material at the end of a modifier's chain; nothing where there is none.
std::optional<PrimitiveType> material_type(const Scene& scene, ModifierId modifier) {
    const std::optional<ModifierId> material = scene.material_of(modifier);
    if (!material) return std::nullopt;
    return scene.modifier(*material).type;
}

/// A placed octree may have modifiers of names that the scene has, too.
std::vector<ModifierId> modifiers_named(const Scene& scene, const std::string& name) {
    std::vector<ModifierId> found;
    for (std::size_t i = 0; i < scene.modifier_count(); ++i) {
        const ModifierId id{static_cast<std::int32_t>(i)};
        if (scene.modifier(id).name == name) found.push_back(id);
    }
    return found;
}

}  // namespace

std::size_t column_count(const std::vector<TrackedModifier>& tracked) {
    std::size_t columns = 0;
    for (const TrackedModifier& modifier : tracked) columns += modifier.bins;
    return columns;
}

std::vector<std::string> missing_modifiers(const Scene& scene,
                                           const std::vector<TrackedModifier>& tracked) {
    std::vector<std::string> missing;
    for (const TrackedModifier& modifier : tracked)
        if (modifiers_named(scene, modifier.name).empty()) missing.push_back(modifier.name);
    return missing;
}

ContributionTally::ContributionTally(const Tracer& tracer,
                                     const std::vector<TrackedModifier>& tracked, bool values,
                                     WarningSink& warnings)
    : tracer_(tracer),
      places_(tracer.scene().modifier_count()),
      sums_(3 * column_count(tracked)),
      counted_(column_count(tracked) / kBits + 1),
      warnings_(warnings),
      values_(values) {
    const Scene& scene = tracer.scene();
    if (tracer.coefficients()) records_.emplace(*tracer.coefficients());
    std::size_t first = 0;
    for (const TrackedModifier& modifier : tracked) {
        for (const ModifierId id : modifiers_named(scene, modifier.name)) {
            if (!scene.modifier(id).node) continue;  // no surface has it
            const std::optional<PrimitiveType> type = material_type(scene, id);
            const bool emits = type && is_light(*type);
            const bool watched = !emits || type == PrimitiveType::illum;
            places_[static_cast<std::size_t>(index(id))] = {&modifier, first, emits, watched};
            watches_ = watches_ || watched;
            if (watched && records_)
                throw InputError("option --cache: modifier \"" + modifier.name +
                                 "\" is not of light, glow or spotlight");
        }
        first += modifier.bins;
    }
}

const ContributionTally::Place* ContributionTally::place_of(ModifierId modifier) const {
    if (modifier == kVoid) return nullptr;
    const Place& place = places_[static_cast<std::size_t>(index(modifier))];
    return place.tracked ? &place : nullptr;
}

void ContributionTally::add(const Contribution& term) {
    const Place* const place = place_of(term.modifier);
    if (place && place->emits)
        count(*place, term.direction, term.position, values_ ? term.value : term.coefficient);
}

void ContributionTally::add_record(std::uint32_t record, const Rgb& coefficient) {
    records_->add(record, coefficient);
}

void ContributionTally::finished(const Ray& ray, const Hit& /*first*/) {
    if (!ray.hit.exists()) return;
    const Place* const place = place_of(ray.hit.modifier);
    if (!place || !place->watched) return;
    // Of an illum a shadow ray's emission was told.
    if (ray.in(kShadow) && (place->emits || !meets_target(ray))) return;
    count(*place, ray.direction, ray.hit.position,
          values_ ? path_coefficient(ray) * ray.value : path_throughput(ray));
}

/// Whether a ray hits what it was sent to.
bool ContributionTally::meets_target(const Ray& ray) const {
    return ray.target != kNoTarget && ray.hit.surface == tracer_.lights()[ray.target].object;
}

void ContributionTally::count(const Place& place, const Vec3& direction, const Vec3& position,
                              const Rgb& amount) {
    const auto bin = chooser_.choose(place.tracked->bin, direction, position);
    if (!bin) return;
    if (*bin >= place.tracked->bins) {
        if (!std::exchange(warned_, true))
            warnings_.warn("what modifier \"" + place.tracked->name + "\" brings to bin " +
                           std::to_string(*bin) + " of " + std::to_string(place.tracked->bins) +
                           " (-bn) is left out, as to others beyond");
        return;
    }
    const std::size_t column = place.first + *bin;
    counted_[column / kBits] |= std::uint64_t{1} << column % kBits;
    double* const sum = &sums_[3 * column];
    for (std::size_t k = 0; k < 3; ++k) {
        const auto part = static_cast<double>(amount[k]);
        if (std::isfinite(part)) sum[k] += part;
    }
}

void ContributionTally::take(std::string& bytes) {
    if (records_) records_->take(sums_);
    bytes.append(reinterpret_cast<const char*>(sums_.data()), sums_.size() * sizeof(double));
    std::fill(sums_.begin(), sums_.end(), 0.0);
    std::fill(counted_.begin(), counted_.end(), 0);
}

/// Of a fine sky most columns are empty: only others are looked at.
std::vector<CoefficientTerm> ContributionTally::take_terms() {
    std::vector<CoefficientTerm> terms;
    for (std::size_t word = 0; word < counted_.size(); ++word) {
        for (std::uint64_t left = std::exchange(counted_[word], 0); left != 0; left &= left - 1) {
            const std::size_t column =
                kBits * word + static_cast<std::size_t>(std::countr_zero(left));
            double* const own = &sums_[3 * column];
            const Rgb sum(static_cast<float>(own[0]), static_cast<float>(own[1]),
                          static_cast<float>(own[2]));
            if (sum != Rgb{}) terms.push_back({static_cast<std::uint32_t>(column), sum});
            std::fill_n(own, 3, 0.0);
        }
    }
    return terms;
}

}  // namespace lightwalk
