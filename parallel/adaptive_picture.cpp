#include "parallel/adaptive_picture.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace lightwalk {
namespace {

constexpr int kLeastSamples = 4;      ///< of a pair: two in each half
constexpr double kDarkest = 0.01;     ///< share of the mean luminance below which errors are its
constexpr double kRound = 1;          ///< share of all samples so far that a round adds, at most
constexpr double kLeastRound = 0.1;   ///< the same, at least
constexpr double kTimeToSpare = 0.9;  ///< share of the time left that is planned for

}  // namespace

AdaptivePicture::AdaptivePicture(int width, int height, int samples, std::uint64_t seed,
                                 const SampleGoal& goal)
    : width_(width),
      height_(height),
      seed_(seed),
      goal_(goal),
      grid_(width, height),
      counts_(grid_.size()),
      tile_errors_(grid_.size()),
      bad_pixels_(grid_.size()) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    for (std::vector<Rgb>& half : halves_) half.resize(pixels);
    errors_.resize(pixels);
    Group all{std::max(kLeastSamples, samples + samples % 2), {}};
    all.tiles.resize(grid_.size());
    std::iota(all.tiles.begin(), all.tiles.end(), std::size_t{0});
    plan_.push_back(std::move(all));
}

std::size_t AdaptivePicture::pixels_of(std::size_t tile) const {
    const auto columns = static_cast<std::size_t>(grid_.columns());
    const auto side = [](std::size_t at, int size) {
        const auto first = static_cast<int>(at) * TileMask::kSide;
        return static_cast<std::size_t>(std::min(TileMask::kSide, size - first));
    };
    return side(tile % columns, width_) * side(tile / columns, height_);
}

std::optional<SamplePass> AdaptivePicture::next(double seconds) {
    if (passes_ == 0) began_ = seconds;
    if (half_done_) {
        const Group group = *std::exchange(half_done_, std::nullopt);
        return pass_of(group);
    }
    if (plan_.empty()) plan(seconds);
    while (!plan_.empty()) {
        Group group = std::move(plan_.front());
        plan_.pop_front();
        if (passes_ > 0) fit_into_time(group, seconds);
        if (group.tiles.empty()) continue;
        half_done_ = group;
        return pass_of(group);
    }
    return std::nullopt;
}

SamplePass AdaptivePicture::pass_of(const Group& group) {
    // Seeds in a row are as good as any: they are mixed before use.
    SamplePass pass{seed_ + passes_++, group.samples / 2, TileMask(width_, height_)};
    for (const std::size_t tile : group.tiles) pass.tiles.set(tile);
    return pass;
}

void AdaptivePicture::add(const SamplePass& pass, const Frame& frame) {
    assert(frame.radiance.size() == errors_.size());
    if (frame_.distance.empty()) {
        frame_.distance = frame.distance;
        frame_.groups.assign(frame.groups.size(), std::vector<Rgb>(errors_.size()));
    }
    add_to_half(pass, frame);
    for (std::size_t tile = 0; tile < counts_.size(); ++tile) {
        if (!pass.tiles[tile]) continue;
        traced_ += static_cast<double>(pass.samples) * static_cast<double>(pixels_of(tile));
        if (!half_done_) counts_[tile] += pass.samples;
    }
    if (!half_done_) estimate();
}

/// Each half is a mean by numbers of samples, as each of its passes is.
void AdaptivePicture::add_to_half(const SamplePass& pass, const Frame& frame) {
    std::vector<Rgb>& half = halves_[half_done_ ? 0 : 1];
    const auto samples = static_cast<float>(pass.samples);
    std::size_t at = 0;
    for (int y = height_; y-- > 0;) {
        for (int x = 0; x < width_; ++x, ++at) {
            const std::size_t tile = grid_.tile(x, y);
            if (!pass.tiles[tile]) continue;
            const float before = static_cast<float>(counts_[tile]);
            const float share = samples / (before + samples);
            half[at] += (frame.radiance[at] - half[at]) * share;
            // Groups have one buffer, to which the first half's samples have been added already.
            const float both = samples / (2 * before + (half_done_ ? samples : 2 * samples));
            for (std::size_t g = 0; g < frame_.groups.size(); ++g)
                frame_.groups[g][at] += (frame.groups[g][at] - frame_.groups[g][at]) * both;
        }
    }
}

void AdaptivePicture::estimate() {
    double mean = 0;
    for (std::size_t i = 0; i < errors_.size(); ++i)
        mean += static_cast<double>(brightness(halves_[0][i] + halves_[1][i])) / 2;
    const double darkest = kDarkest * mean / static_cast<double>(errors_.size());
    std::fill(tile_errors_.begin(), tile_errors_.end(), 0.0);
    std::fill(bad_pixels_.begin(), bad_pixels_.end(), 0.0);
    std::size_t at = 0;
    for (int y = height_; y-- > 0;) {
        for (int x = 0; x < width_; ++x, ++at) {
            const auto one = static_cast<double>(brightness(halves_[0][at]));
            const auto other = static_cast<double>(brightness(halves_[1][at]));
            const double scale = std::max((one + other) / 2, darkest);
            const double error = scale > 0 ? std::abs(one - other) / 2 / scale : 0;
            errors_[at] = static_cast<float>(error);
            tile_errors_[grid_.tile(x, y)] += error;
            bad_pixels_[grid_.tile(x, y)] += error > goal_.error ? 1 : 0;
        }
    }
    for (std::size_t tile = 0; tile < tile_errors_.size(); ++tile)
        tile_errors_[tile] /= static_cast<double>(pixels_of(tile));
    std::vector<float> sorted = errors_;
    const auto nth = static_cast<std::size_t>(kShare * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(nth),
                     sorted.end());
    error_ = static_cast<double>(sorted[nth]);
    smooth_tiles();
}

/// What is seen through a hole of a tile's few samples is found by the tiles beside it.
void AdaptivePicture::smooth_tiles() {
    const std::vector<double> own = tile_errors_;
    const int columns = grid_.columns(), rows = grid_.rows();
    const auto at = [&](int column, int row) {
        return own[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(column)];
    };
    std::size_t tile = 0;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column, ++tile) {
            double sum = 0;
            int count = 0;
            for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
                const int x = column + dx, y = row + dy;
                if (x < 0 || x >= columns || y < 0 || y >= rows) continue;
                sum += at(x, y);
                ++count;
            }
            if (count > 0) tile_errors_[tile] = std::max(own[tile], sum / (2 * count));
        }
    }
}

bool AdaptivePicture::reached() const {
    return goal_.error <= 0 || (error_ && *error_ <= goal_.error);
}

/// More samples a pixel, in both halves, that a tile should get where tiles have `scale` of them in
/// proportion to the standard deviation of one: the least sum of squared errors for all samples
/// together. 0, or a power of two, of a few times what it has at most, since the estimate is rough.
int AdaptivePicture::wanted(std::size_t tile, double scale) const {
    const double have = 2 * counts_[tile];
    if (have >= kMostSamples) return 0;
    const double more = scale * tile_errors_[tile] * std::sqrt(have) - have;
    if (!(more > have / 2)) return 0;
    return static_cast<int>(
        std::bit_ceil(static_cast<unsigned>(std::ceil(std::min(more, 3 * have)))));
}

/// So many samples more.
double AdaptivePicture::cost(double scale) const {
    double samples = 0;
    for (std::size_t tile = 0; tile < counts_.size(); ++tile)
        samples += static_cast<double>(wanted(tile, scale)) * static_cast<double>(pixels_of(tile));
    return samples;
}

/// What `samples` are enough for.
double AdaptivePicture::scale_of(double samples) const {
    double low = 1e-3, high = 1e12;
    for (int i = 0; i < 60; ++i) {
        const double middle = std::sqrt(low * high);
        (cost(middle) <= samples ? low : high) = middle;
    }
    return low;
}

/// A picture of few tiles, all alike, goes on as well.
void AdaptivePicture::add_worst(FunctionRef<void(std::size_t tile, int samples)> add) const {
    std::optional<std::size_t> worst;
    for (std::size_t tile = 0; tile < counts_.size(); ++tile)
        if (2 * counts_[tile] < kMostSamples &&
            (!worst || tile_errors_[tile] > tile_errors_[*worst]))
            worst = tile;
    if (worst && tile_errors_[*worst] > 0)
        add(*worst, static_cast<int>(std::bit_ceil(2U * static_cast<unsigned>(counts_[*worst]))));
}

void AdaptivePicture::plan(double seconds) {
    if (goal_.error > 0 && reached()) return;
    double budget = kRound * traced_;
    if (goal_.error > 0 && error_) {  // errors fall with the root of the number of samples
        const double ratio = *error_ / goal_.error;
        budget = std::min(budget, traced_ * std::max(ratio * ratio - 1, kLeastRound));
    }
    if (goal_.seconds > 0) {
        const double rate = traced_ / std::max(seconds - began_, 1e-6);
        budget = std::min(budget, kTimeToSpare * (goal_.seconds - seconds) * rate);
    }
    const double scale = scale_of(budget);
    std::map<int, Group> groups;
    const auto add = [&](std::size_t tile, int samples) {
        groups[samples].samples = samples;
        groups[samples].tiles.push_back(tile);
    };
    for (std::size_t tile = 0; tile < counts_.size(); ++tile)
        if (const int samples = wanted(tile, scale); samples > 0) add(tile, samples);
    if (groups.empty() && goal_.error > 0 && !(goal_.seconds > 0)) add_worst(add);
    for (auto& [samples, group] : groups) plan_.push_back(std::move(group));
}

/// Leaves out the tiles of least error that there is no time for.
void AdaptivePicture::fit_into_time(Group& group, double seconds) const {
    if (!(goal_.seconds > 0)) return;
    const double rate = traced_ / std::max(seconds - began_, 1e-6);
    double left = (goal_.seconds - seconds) * rate;
    std::stable_sort(group.tiles.begin(), group.tiles.end(), [&](std::size_t a, std::size_t b) {
        return tile_errors_[a] > tile_errors_[b];
    });
    std::size_t kept = 0;
    for (; kept < group.tiles.size(); ++kept) {
        left -=
            static_cast<double>(group.samples) * static_cast<double>(pixels_of(group.tiles[kept]));
        if (left < 0) break;
    }
    group.tiles.resize(kept);
}

double AdaptivePicture::done(double seconds) {
    double share = 0;
    if (goal_.seconds > 0) share = seconds / goal_.seconds;
    if (goal_.error > 0 && error_) {
        double left = 0;
        for (std::size_t tile = 0; tile < counts_.size(); ++tile)
            left += 2 * counts_[tile] * bad_pixels_[tile];
        if (traced_ + left > 0) share = std::max(share, traced_ / (traced_ + left));
    }
    return done_ = std::max(done_, std::min(share, 1.0));
}

AdaptivePicture::Samples AdaptivePicture::samples() const {
    const auto [least, most] = std::minmax_element(counts_.begin(), counts_.end());
    return {traced_ / static_cast<double>(errors_.size()), 2 * *least, 2 * *most};
}

Frame AdaptivePicture::finish() {
    constexpr int kAround = 2;
    frame_.width = width_;
    frame_.height = height_;
    frame_.radiance.resize(errors_.size());
    frame_.error.resize(errors_.size());
    const auto width = static_cast<std::size_t>(width_);
    for (int y = 0; y < height_; ++y) {
        for (int x = 0; x < width_; ++x) {
            const std::size_t at =
                static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            frame_.radiance[at] = (halves_[0][at] + halves_[1][at]) * 0.5F;
            double squares = 0;
            int count = 0;
            for (int v = std::max(y - kAround, 0); v <= std::min(y + kAround, height_ - 1); ++v)
                for (int u = std::max(x - kAround, 0); u <= std::min(x + kAround, width_ - 1);
                     ++u, ++count) {
                    const auto error = static_cast<double>(
                        errors_[static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u)]);
                    squares += error * error;
                }
            frame_.error[at] = static_cast<float>(std::sqrt(squares / count));
        }
    }
    frame_.half = std::move(halves_[0]);
    frame_.complete = true;
    return std::move(frame_);
}

}  // namespace lightwalk
