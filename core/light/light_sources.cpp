#include "core/light/light_sources.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "core/light/emission.h"
#include "core/light/hit_rates.h"
#include "core/light/source_setup.h"
#include "core/light/spot.h"

namespace lightwalk {

LightSources::LightSources(const Scene& scene, const RenderOptions& options, WarningSink& warnings)
    : scene_(scene), options_(options), sources_(collect_sources(scene, warnings)) {
    for (const LightSource& source : sources_)
        shapes_.push_back(scene.surface(source.object).shape());
    index_sources();
}

void LightSources::index_sources() {
    sampled_.clear();
    distant_.clear();
    for (std::size_t i = 0; i < sources_.size(); ++i) {
        const LightSource& source = sources_[i];
        if (!source.unusable) sampled_.push_back(static_cast<std::int32_t>(i));
        if (source.is_distant() && !source.is_virtual())
            distant_.push_back(static_cast<std::int32_t>(i));
    }
    each_.resize(sampled_.size());
    std::iota(each_.begin(), each_.end(), 0U);
    boxes_ = SourceBoxes(sources_, sampled_, options_.ablation.sample_lanes);
    virtual_count_ = static_cast<std::size_t>(std::count_if(
        sources_.begin(), sources_.end(), [](const LightSource& s) { return s.is_virtual(); }));
}

void LightSources::finalize(const LightTransport& tracer, WarningSink& warnings,
                            const TaskRunner& task_runner, const LightMeasures* known) {
    index_sources();
    find_scattered(warnings);
    const bool many = options_.sample_lights > 0 &&
                      sampled_.size() - virtual_count_ >
                          kManyLights * static_cast<std::size_t>(options_.sample_lights);
    const bool chosen = many || (options_.ambient_bounces > 0 && options_.ambient_lights > 0);
    if (known != nullptr) measures_ = *known;
    const auto are_of_all = [&](const std::vector<float>& numbers) {
        assert(numbers.empty() || numbers.size() == sources_.size());
        return numbers.size() == sources_.size();
    };
    if (options_.shadow_threshold > 0 || chosen) {
        if (!are_of_all(measures_.hit_rates))
            measures_.hit_rates = measure_hit_rates(*this, tracer, warnings, task_runner);
        for (std::size_t i = 0; i < measures_.hit_rates.size(); ++i)
            sources_[i].hit_rate = measures_.hit_rates[i];
    }
    if (!chosen) return;
    if (!are_of_all(measures_.emissions)) measures_.emissions = mean_emissions(*this, tracer);
    for (std::size_t i = 0; i < measures_.emissions.size(); ++i)
        sources_[i].worth = measures_.emissions[i] * visible_share(sources_[i]);
    boxes_.set_worths(sources_, sampled_);
    many_for_samples_ = many;
}

bool LightSources::shine() const {
    const bool sampled = std::any_of(sources_.begin(), sources_.end(), [](const LightSource& s) {
        return s.material_type != PrimitiveType::glow || !s.is_distant();
    });
    return sampled || (options_.ambient_bounces > 0 && has_glow(scene_));
}

bool LightSources::inside_spot(const LightSource& source, const Vec3& origin,
                               const Vec3& direction) const {
    return !source.spot || !outside_spot(*source.spot, origin, direction);
}

bool LightSources::answers_to(const LightSource& source, std::string_view identifier) const {
    const LightSource* at = &source;
    for (;; at = &(*this)[at->parent]) {
        const std::string_view name = scene_.surface(at->object).name();
        if (!at->is_virtual()) return identifier == name;
        if (!identifier.starts_with(name) || !identifier.substr(name.size()).starts_with('>'))
            return false;
        identifier.remove_prefix(name.size() + 1);
    }
}

std::optional<std::int32_t> LightSources::find(std::string_view identifier) const {
    for (std::size_t i = sources_.size(); i-- > 0;) {
        if (answers_to(sources_[i], identifier)) return static_cast<std::int32_t>(i);
    }
    return std::nullopt;
}

void LightSources::find_scattered(WarningSink& warnings) {
    for (std::size_t i = 0; i < scene_.modifier_count(); ++i) {
        const auto id = static_cast<std::int32_t>(i);
        const ModifierRecord& mist = scene_.modifier(ModifierId{id});
        if (mist.type != PrimitiveType::mist || !mist.node) continue;
        ScatterList list;
        for (const std::string& identifier : mist.primitive->strings) {
            const std::optional<std::int32_t> source = find(identifier);
            if (!source) {
                warnings.warn(to_prefix(mist.primitive->where) + "mist \"" + mist.name +
                              "\": unknown source \"" + identifier + "\"");
            } else if (!list.contains(*source)) {
                list.sources.push_back(*source);
            }
        }
        if (!list.sources.empty()) scattered_.emplace(id, std::move(list));
    }
}

const ScatterList* LightSources::scattered_by(ModifierId mist) const {
    const auto found = scattered_.find(index(mist));
    return found == scattered_.end() ? nullptr : &found->second;
}

}  // namespace lightwalk
