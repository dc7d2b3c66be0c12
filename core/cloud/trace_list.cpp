#include "core/cloud/trace_list.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lightwalk {
namespace {

/// Of the audited pixels a second ray tells how much two rays differ.
constexpr double kFloorShare = 0.25;

float relative_error(const Rgb& value, const Rgb& truth) {
    const float is = brightness(value), should = brightness(truth);
    return std::abs(is - should) / std::max(should, 1e-9f);
}

/// Whether what the groups add makes up a radiance.
bool add_up(std::span<const Rgb> groups, const Rgb& radiance) {
    constexpr float kRounding = 1e-3f;
    Rgb left = radiance;
    for (const Rgb& value : groups) left -= value;
    return std::max(max_component(left), -min_component(left)) <=
           kRounding * max_component(radiance);
}

}  // namespace

void mix_pixel(const TracedPixel& traced, const PixelGroups& groups, std::size_t pixel,
               std::span<Rgb> ahead, TracedPixelResult& result) {
    const std::size_t count = ahead.size();
    const LightMixture& mixture = *groups.mixture;
    const std::span<const Rgb> whole = groups.whole.subspan(pixel * count, count);
    const std::span<const Rgb> mirrored = groups.mirrored.subspan(pixel * count, count);
    const Rgb traced_radiance = result.value.radiance;
    result.value.radiance = mixture(traced_radiance, whole);
    if (result.points.count == 1) result.points.points[0].radiance = result.value.radiance;
    if (result.points.count < 2) return;
    if (!add_up(mirrored, traced.mirrored)) {
        result.points.count = 0;
        return;
    }
    for (std::size_t g = 0; g < count; ++g) ahead[g] = whole[g] - mirrored[g];
    for (const auto& [point, values] :
         {std::pair{&result.points.points[0], std::span<const Rgb>(ahead)},
          std::pair{&result.points.points[1], mirrored}})
        point->radiance = mixture(point->radiance, values);
}

void TraceList::begin() {
    finest_ = next_finest_grid();
    uncached_.clear();
    noise_pairs_.clear();
    unanswered_ = left_ = answered_ = 0;
    expect();
}

int TraceList::next_finest_grid() const {
    constexpr std::size_t kEnough = 1024, kMoreThanTraced = 3;
    if (!(options_.budget > 0)) return kGridLevels - 1;
    int level = 0;
    for (std::size_t noted = left_ >> (2 * (kGridLevels - 1));
         noted < kEnough + kMoreThanTraced * answered_ && level < kGridLevels - 1; noted *= 4)
        ++level;
    return level;
}

/// None of them is traced. What earlier frames left in `traced_` does no harm, and clearing it
/// takes a millisecond.
void TraceList::expect() {
    if (traced_.size() < uncached_.size()) traced_.resize(uncached_.size());
    done_.assign(uncached_.size(), 0);
    pair_radiance_.resize(noise_pairs_.size());
    pair_done_.assign(noise_pairs_.size(), 0);
    const std::size_t values = uncached_.size() * options_.light_groups;
    if (groups_.size() < values) {
        groups_.resize(values);
        ahead_.resize(values);
    }
}

void TraceList::gather(std::span<BlockUncachedPixels> blocks, std::uint64_t frame,
                       const TaskRunner& task_runner) {
    const bool time_is_short = options_.budget > 0;
    const std::size_t first = time_is_short && !blocks.empty() ? frame % blocks.size() : 0;
    std::size_t count = 0;
    for (std::size_t rank = 0; rank < kTraceRanks; ++rank) {
        for (std::size_t k = 0; k < blocks.size(); ++k) {
            std::uint32_t& of_block = blocks[(first + k) % blocks.size()].ranked[rank];
            count += std::exchange(of_block, static_cast<std::uint32_t>(count));
        }
    }
    for (const BlockUncachedPixels& block : blocks) {
        unanswered_ += block.unanswered;
        left_ += block.left;
    }
    uncached_.resize(count);
    task_runner.run(blocks.size(), [&](std::size_t k) {
        BlockUncachedPixels& block = blocks[k];
        for (const UncachedPixel& pixel : block.uncached)
            uncached_[block.ranked[trace_rank(pixel, time_is_short)]++] = pixel;
    });
    choose_noise_pairs(frame);
    expect();
}

void TraceList::choose_noise_pairs(std::uint64_t frame) {
    for (std::size_t i = 0; i < uncached_.size(); ++i) {
        if (uncached_[i].cause != TraceCause::audited) continue;
        RandomStream random = audit_stream(options_.seed, frame, uncached_[i].place);
        (void)random.next();  // has decided that it is audited
        if (random.next() < kFloorShare) noise_pairs_.push_back(static_cast<std::uint32_t>(i));
    }
}

void TraceList::refine(std::span<const PixelPlace> places) {
    for (const PixelPlace& place : places) uncached_.push_back({place, TraceCause::refined});
    expect();
}

std::vector<PixelPlace> TraceList::places() const {
    std::vector<PixelPlace> places;
    places.reserve(uncached_.size() + noise_pairs_.size());
    for (const UncachedPixel& pixel : uncached_) places.push_back(pixel.place);
    for (const std::uint32_t i : noise_pairs_) places.push_back(uncached_[i].place);
    return places;
}

void TraceList::record(std::size_t first, std::span<const TracedPixelResult> traced,
                       std::span<const Rgb> groups, std::span<const Rgb> ahead) {
    if (first < uncached_.size()) {
        const auto at = static_cast<std::ptrdiff_t>(first);
        std::copy(traced.begin(), traced.end(), traced_.begin() + at);
        std::fill_n(done_.begin() + at, traced.size(), std::uint8_t{1});
        const auto values = static_cast<std::ptrdiff_t>(first * options_.light_groups);
        std::ranges::copy(groups, groups_.begin() + values);
        std::ranges::copy(ahead, ahead_.begin() + values);
        return;
    }
    std::size_t pair = first - uncached_.size();
    for (const TracedPixelResult& one : traced) {
        pair_radiance_[pair] = one.value.radiance;
        pair_done_[pair++] = 1;
    }
}

std::vector<std::optional<PixelValue>> TraceList::values() const {
    std::vector<std::optional<PixelValue>> values(uncached_.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        if (done_[i] != 0) values[i] = traced_[i].value;
    return values;
}

void TraceList::show(CloudFrame& frame, bool passing) {
    CloudReport& report = frame.report;
    report.reused = report.pixels - unanswered_;
    for (std::size_t i = 0; i < noise_pairs_.size(); ++i) {
        if (pair_done_[i] == 0 || done_[noise_pairs_[i]] == 0) continue;
        report.audit_floors.push_back(
            relative_error(pair_radiance_[i], traced_[noise_pairs_[i]].value.radiance));
    }
    for (std::size_t i = 0; i < uncached_.size(); ++i) {
        const UncachedPixel& pixel = uncached_[i];
        const std::size_t at = frame.area.index(pixel.place);
        if (done_[i] == 0) {
            if (pixel.cause != TraceCause::audited && frame.known[at] != 0) ++report.inferred;
            continue;
        }
        const PixelValue& traced = traced_[i].value;
        if (pixel.cause == TraceCause::audited)
            report.audit_errors.push_back(relative_error(frame.radiance[at], traced.radiance));
        else
            ++answered_;
        frame.radiance[at] = traced.radiance;
        frame.distance[at] = traced.distance;
        frame.causes[at] = pixel.cause;
        frame.known[at] = 1;
        if (!frame.surfaces.empty()) {
            const bool left = traced_[i].points.count > 0;
            frame.surfaces[at] = left ? traced_[i].points.points[0].surface : 0;
            frame.patterns[at] = left ? traced_[i].points.points[0].pattern : kNoPattern;
        }
        if (!frame.origins.empty())
            frame.origins[at] = passing ? PixelOrigin{PixelOrigin::Kind::reused, 0, kOldestAge}
                                        : PixelOrigin{PixelOrigin::Kind::traced, 1, 0};
        ++report.uncached[static_cast<std::size_t>(pixel.cause)];
    }
    report.filled = unanswered_ - answered_;
}

void TraceList::leave_points(RegionPoints& points) const {
    const std::size_t count = options_.light_groups;
    for (std::size_t i = 0; i < uncached_.size(); ++i)
        if (done_[i] != 0)
            points.leave(traced_[i].points, std::span(groups_).subspan(i * count, count),
                         std::span(ahead_).subspan(i * count, count));
}

}  // namespace lightwalk
