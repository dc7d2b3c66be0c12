#include "apps/walk/depth_piece.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <string_view>

#include "io/net/depth_patches.h"

namespace lightwalk {
namespace {

constexpr double kReach = 0.15;     // how far pages draw from a frame's eye [eye heights]
constexpr std::size_t kParts = 16;  // that are copied side by side
constexpr std::uint64_t kMix = 0x9E3779B97F4A7C15U;

/// A page unprojects pixels of perspective views; clipped ones begin elsewhere than at the eye.
bool is_drawable(const View& view) {
    return view.type == 'v' && view.fore == 0 && view.aft == 0;
}

}  // namespace

void DepthPiece::keep(const LivePicture& picture, const View& view, double eye_height,
                      Executor& executor) {
    view_ = view;
    width_ = picture.width;
    height_ = picture.height;
    content_ = 0;
    if (!is_drawable(view) || picture.distance.size() != picture.radiance.size()) return;
    step_ = coarseness_ * depth_step(view, width_, kReach * eye_height);
    distance_.resize(picture.distance.size());
    std::vector<std::uint64_t> hashes(kParts);
    executor.for_each(kParts, [&](std::size_t part, int) {
        const std::size_t size = distance_.size(), begin = part * size / kParts;
        const std::span<float> to =
            std::span(distance_).subspan(begin, (part + 1) * size / kParts - begin);
        std::copy_n(picture.distance.begin() + static_cast<std::ptrdiff_t>(begin), to.size(),
                    to.begin());
        hashes[part] = std::hash<std::string_view>{}(
            {reinterpret_cast<const char*>(to.data()), to.size_bytes()});
    });
    content_ = std::bit_cast<std::uint32_t>(step_);
    for (const std::uint64_t hash : hashes) content_ = content_ * kMix + hash;
    content_ |= 1;  // 0 means that there is none
}

const std::string& DepthPiece::bytes(Executor& executor) {
    if (coded_ == content_) return bytes_;
    coded_ = content_;
    bytes_.clear();
    if (content_ == 0) return bytes_;
    const DepthPicture picture{view_, width_, height_, distance_, step_};
    const auto bands = static_cast<std::size_t>(depth_bands(height_));
    std::vector<std::string> coded(bands);
    std::vector<std::size_t> patches(bands);
    executor.for_each(bands, [&](std::size_t band, int) {
        const std::vector<DepthPatch> cut = depth_patches(picture, static_cast<int>(band));
        coded[band] = encode_depth_band(cut, band + 1 == bands);
        patches[band] = cut.size();
    });
    std::size_t all = 0;
    for (const std::size_t count : patches) all += count;
    bytes_ = encode_depth(step_, all, coded);
    adapt_step();
    return bytes_;
}

/// Where things are as rough as leaves and grass the next pieces have coarser steps, so that they
/// are no larger than their share of a link; finer ones are tried again once in a while only, for
/// they may be as many times larger.
void DepthPiece::adapt_step() {
    constexpr float kCoarsest = 8;
    constexpr int kTried = 16;  // pieces
    const std::size_t most = distance_.size() / 8;
    if (bytes_.size() > most) {
        coarseness_ = std::min(2 * coarseness_, kCoarsest);
        small_ = 0;
    } else if (bytes_.size() < most / 3 && ++small_ >= kTried) {
        coarseness_ = std::max(coarseness_ / 2, 1.0f);
        small_ = 0;
    }
}

}  // namespace lightwalk
