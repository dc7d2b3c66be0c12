#include "core/cloud/progressive_light.h"

#include <algorithm>
#include <utility>

namespace lightwalk {
namespace {

// Choosing them takes a pass over the picture.
constexpr std::size_t kMostPixels = 65536;
constexpr int kOvertureSpacing = 8, kCoarsestOfDraft = 4;  // [pixels]
// Of a finer grid single pixels are shown only where it does not show that others are not: a wall
// with dots on it looks worse than a wall that waits [pixels].
constexpr int kUnseen = 2;
constexpr float kApart = 0.05f;      // of a distance: more is another surface
constexpr float kFarWeight = 0.01f;  // of its light; not 0, lest there be none at all

}  // namespace

void ProgressiveLight::begin(std::span<const Rgb> radiance, std::span<const float> distance,
                             std::span<const Rgb> groups, bool drafted) {
    coarsest_ = drafted ? kCoarsestOfDraft : 1 << (kGridLevels - 1);
    before_.assign(radiance.begin(), radiance.end());
    groups_before_.assign(groups.begin(), groups.end());
    left_.assign(kGridLevels, 0);
    std::vector<PixelOrigin> origins(radiance.size());
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            const int level = grid_level({x, y});
            origins[at(x, y)] = {PixelOrigin::Kind::reused, 0, static_cast<std::uint32_t>(level)};
            ++left_[static_cast<std::size_t>(level)];
        }
    }
    work_.begin(radiance, distance, origins, groups);
    chosen_ = {};
    overture_ = true;
    for (int y = 0; y < height_; y += kOvertureSpacing)
        for (int x = 0; x < width_; x += kOvertureSpacing) chosen_.places.push_back({x, y});
}

void ProgressiveLight::mix(const LightMixture& mixture) {
    if (!work_.knows_groups()) return;
    const std::size_t count = groups_before_.size() / before_.size();
    for (std::size_t i = 0; i < before_.size(); ++i)
        before_[i] = mixture.sum(std::span(groups_before_).subspan(i * count, count));
    work_.mix(mixture);
}

bool ProgressiveLight::step(Trace trace) {
    if (chosen_.places.empty()) {
        overture_ = false;
        chosen_ = work_.next(kMostPixels);
    }
    if (chosen_.places.empty()) return false;
    const ProgressiveWork work = std::move(chosen_);
    chosen_ = {work.sample, {}};
    const TracedValues traced = trace(work);
    const std::vector<std::optional<PixelValue>>& values = traced.values;
    if (!overture_) work_.record(work, values, traced.groups);
    for (std::size_t i = 0; i < work.places.size(); ++i) {
        const PixelPlace& place = work.places[i];
        if (!values[i])
            chosen_.places.push_back(place);
        else if (!overture_ && work.sample == 0)
            --left_[static_cast<std::size_t>(grid_level(place))];
    }
    return true;
}

/// Spacing of the finest grid that is traced as a whole; 0: none is, or none that is to be shown.
int ProgressiveLight::whole_grid() const {
    int spacing = 0;
    for (int level = 0; level < kGridLevels && left_[static_cast<std::size_t>(level)] == 0; ++level)
        spacing = 1 << (kGridLevels - 1 - level);
    return spacing <= coarsest_ ? spacing : 0;
}

/// What the grid's pixels around have won, weighted as near as they are, in the picture and in the
/// room: the light of what is far behind an edge says little.
Rgb ProgressiveLight::difference(int x, int y, int spacing) const {
    Rgb sum;
    float weights = 0;
    const float here = work_.distance()[at(x, y)];
    const int left = x - x % spacing, below = y - y % spacing;
    for (const int gy : {below, below + spacing}) {
        for (const int gx : {left, left + spacing}) {
            if (gx >= width_ || gy >= height_) continue;
            const auto near =
                static_cast<float>((spacing - std::abs(gx - x)) * (spacing - std::abs(gy - y)));
            const float there = work_.distance()[at(gx, gy)];
            const bool apart = std::abs(here - there) > kApart * std::min(here, there);
            const float weight = apart ? kFarWeight * near : near;
            sum += weight * (work_.radiance()[at(gx, gy)] - before_[at(gx, gy)]);
            weights += weight;
        }
    }
    return sum * (1 / weights);
}

std::vector<Rgb> ProgressiveLight::picture() const {
    const int spacing = whole_grid();
    if (spacing == 0) return before_;
    std::vector<Rgb> shown(work_.radiance().begin(), work_.radiance().end());
    if (spacing == 1) return shown;
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            const bool of_grid = x % spacing == 0 && y % spacing == 0;
            if (of_grid || (spacing <= kUnseen && is_traced(x, y))) continue;
            Rgb& pixel = shown[at(x, y)];
            pixel = before_[at(x, y)] + difference(x, y, spacing);
            // A brighter neighbour's loss may be more than this one has.
            pixel = {std::max(pixel.r, 0.0f), std::max(pixel.g, 0.0f), std::max(pixel.b, 0.0f)};
        }
    }
    return shown;
}

double ProgressiveLight::share() const {
    std::size_t left = 0;
    for (const std::size_t count : left_) left += count;
    return before_.empty() ? 1
                           : 1 - static_cast<double>(left) / static_cast<double>(before_.size());
}

}  // namespace lightwalk
