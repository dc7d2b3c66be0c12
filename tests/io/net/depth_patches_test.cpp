#include "io/net/depth_patches.h"

#include <doctest/doctest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>

using namespace lightwalk;

namespace {

constexpr int kWidth = 150, kHeight = 100;

View room_view() {
    View view;
    view.position = {0, 0, 1.6};
    view.direction = {0.3, 1, -0.2};
    view.horizontal = 70;
    view.vertical = 50;
    return view;
}

/// Distances along pixels' rays to the nearest of what `hit` returns; 0 for rays without.
std::vector<float> distances(const View& view,
                             const std::function<double(const Camera::ViewRay&)>& hit) {
    const Camera camera(view);
    std::vector<float> all;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            all.push_back(static_cast<float>(
                hit(camera.perspective_ray((x + 0.5) / kWidth, 1 - (y + 0.5) / kHeight))));
    return all;
}

/// A floor at z = 0, and a post before it.
double room(const Camera::ViewRay& ray) {
    const bool post = ray.direction.x > 0.25 && ray.direction.x < 0.3;
    if (post) return 1.5 / ray.direction.y;
    return ray.direction.z < 0 ? -1.6 / ray.direction.z : kHuge;
}

/// Inverse depth of a pixel [1/m].
double inverse_depth(const View& view, std::span<const float> distance, int x, int y) {
    const Camera camera(view);
    const Vec3 ray = camera.perspective_ray((x + 0.5) / kWidth, 1 - (y + 0.5) / kHeight).direction;
    return 1 / (static_cast<double>(distance[static_cast<std::size_t>(y * kWidth + x)]) *
                dot(ray, camera.forward()));
}

double plane(const DepthPatch& patch, int x, int y) {
    const double middle = 0.5 * ((1 << patch.level) - 1);
    return patch.value +
           (patch.slope_x * (x - patch.x - middle) + patch.slope_y * (y - patch.y - middle)) /
               kSlopeUnits;
}

std::vector<DepthPatch> all_patches(const DepthPicture& picture) {
    std::vector<DepthPatch> all;
    for (int band = 0; band < depth_bands(picture.height); ++band)
        for (const DepthPatch& patch : depth_patches(picture, band)) all.push_back(patch);
    return all;
}

std::string inflated(std::string_view bytes, std::size_t size) {
    std::string out(size, '\0');
    z_stream stream{};
    REQUIRE(inflateInit2(&stream, -15) == Z_OK);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    CHECK(inflate(&stream, Z_FINISH) == Z_STREAM_END);
    out.resize(stream.total_out);
    CHECK(stream.avail_in == 0);
    inflateEnd(&stream);
    return out;
}

int unfolded(std::uint8_t low, std::uint8_t high) {
    const int number = low | high << 8;
    return (number >> 1) ^ -(number & 1);
}

/// Reads the numbers of bands as io/net/README.md tells, without the places.
class BandReader {
  public:
    explicit BandReader(std::string bytes) : bytes_(std::move(bytes)) {}
    [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

    /// The next band's patches, whose places are those of `expected`.
    std::vector<DepthPatch> next(std::span<const DepthPatch> expected) {
        const std::size_t count = byte(at_) | byte(at_ + 1) << 8 | byte(at_ + 2) << 16;
        REQUIRE(count == expected.size());
        const std::size_t shapes = at_ + 4, values = shapes + count, slopes = values + 2 * count;
        std::size_t sloping = 0, s = 0;
        for (std::size_t k = 0; k < count; ++k) sloping += (byte(shapes + k) & 7) != 0;
        std::vector<DepthPatch> patches;
        DepthPatch last;
        int middle_x = 0, middle_y = 0;
        for (std::size_t k = 0; k < count; ++k) {
            DepthPatch patch{expected[k].x, expected[k].y};
            patch.level = byte(shapes + k) & 7;
            patch.guessed = (byte(shapes + k) & 8) != 0;
            patch.edges = byte(shapes + k) >> 4;
            const int x = 2 * patch.x + (1 << patch.level) - 1,
                      y = 2 * patch.y + (1 << patch.level) - 1;
            const int ahead = static_cast<int>(std::floor(
                (last.slope_x * (x - middle_x) + last.slope_y * (y - middle_y)) / 128.0));
            patch.value =
                static_cast<std::uint16_t>(std::clamp(last.value + ahead, 0, 65535) +
                                           unfolded(byte(values + k), byte(values + count + k)));
            middle_x = x;
            middle_y = y;
            last.value = patch.value;
            if (patch.level > 0) {
                last.slope_x = patch.slope_x = static_cast<std::int16_t>(
                    last.slope_x + unfolded(byte(slopes + s), byte(slopes + sloping + s)));
                last.slope_y = patch.slope_y = static_cast<std::int16_t>(
                    last.slope_y +
                    unfolded(byte(slopes + 2 * sloping + s), byte(slopes + 3 * sloping + s)));
                ++s;
            }
            patches.push_back(patch);
        }
        at_ = slopes + 4 * sloping;
        return patches;
    }

  private:
    [[nodiscard]] std::uint8_t byte(std::size_t k) const {
        return static_cast<std::uint8_t>(bytes_.at(k));
    }
    std::string bytes_;
    std::size_t at_ = 0;
};

}  // namespace

TEST_CASE("depth patches: each pixel lies in one patch, within the tolerance of its plane") {
    const View view = room_view();
    const std::vector<float> distance = distances(view, room);
    const DepthPicture picture{view, kWidth, kHeight, distance, depth_step(view, kWidth, 0.25)};
    std::vector<int> covered(kWidth * kHeight);
    std::size_t large = 0;
    for (const DepthPatch& patch : all_patches(picture)) {
        large += patch.level >= 4;
        CHECK_FALSE(patch.guessed);
        for (int y = patch.y; y < patch.y + (1 << patch.level); ++y)
            for (int x = patch.x; x < patch.x + (1 << patch.level); ++x) {
                ++covered.at(static_cast<std::size_t>(y * kWidth + x));
                const double inverse =
                    inverse_depth(view, distance, x, y) / static_cast<double>(picture.step);
                CHECK(std::abs(plane(patch, x, y) - inverse) <=
                      static_cast<double>(kDepthTolerance) + 0.6);
            }
    }
    CHECK(std::count(covered.begin(), covered.end(), 1) == kWidth * kHeight);
    CHECK(large > 10);
}

TEST_CASE(
    "depth patches: a side where another surface begins is an edge, within a surface there is "
    "none") {
    const View view = room_view();
    const std::vector<float> floor = distances(view, [](const Camera::ViewRay& ray) {
        return ray.direction.z < 0 ? -1.6 / ray.direction.z : kHuge;
    });
    const float step = depth_step(view, kWidth, 0.25);
    for (const DepthPatch& patch : all_patches({view, kWidth, kHeight, floor, step}))
        CHECK(patch.edges == 0);
    const std::vector<float> post = distances(view, room);
    std::size_t left = 0, right = 0;
    for (const DepthPatch& patch : all_patches({view, kWidth, kHeight, post, step})) {
        left += (patch.edges & kLeftEdge) != 0;
        right += (patch.edges & kRightEdge) != 0;
    }
    CHECK(left > 10);
    CHECK(right > 10);
}

TEST_CASE(
    "depth patches: pixels that nothing is known of continue their row, behind what is nearer") {
    const View view = room_view();
    std::vector<float> distance = distances(view, room);
    std::vector<bool> unknown(distance.size());
    for (std::size_t i = 0; i < distance.size(); ++i) unknown[i] = (i * 7919) % 16 != 0;
    for (std::size_t i = 0; i < distance.size(); ++i)
        if (unknown[i]) distance[i] = 0;
    const DepthPicture picture{view, kWidth, kHeight, distance, depth_step(view, kWidth, 0.25)};
    const std::vector<float> truth = distances(view, room);
    std::size_t right = 0, nearer = 0, guessed = 0;
    for (const DepthPatch& patch : all_patches(picture)) {
        guessed += patch.guessed ? std::size_t{1} << 2 * patch.level : 0;
        for (int y = patch.y; y < patch.y + (1 << patch.level); ++y)
            for (int x = patch.x; x < patch.x + (1 << patch.level); ++x) {
                const double inverse =
                    inverse_depth(view, truth, x, y) / static_cast<double>(picture.step);
                const double apart = plane(patch, x, y) - inverse;
                right += std::abs(apart) < 12;
                nearer += apart > 100;
            }
    }
    CHECK(guessed > kWidth * kHeight / 2);
    CHECK(static_cast<double>(right) > 0.9 * kWidth * kHeight);
    CHECK(static_cast<double>(nearer) < 0.02 * kWidth * kHeight);
}

TEST_CASE("depth patches: a piece's bytes are the patches, as the page reads them") {
    const View view = room_view();
    const std::vector<float> distance = distances(view, room);
    const DepthPicture picture{view, kWidth, kHeight, distance, depth_step(view, kWidth, 0.25)};
    std::vector<std::string> bands;
    std::vector<std::vector<DepthPatch>> patches;
    std::size_t count = 0;
    for (int band = 0; band < depth_bands(kHeight); ++band) {
        patches.push_back(depth_patches(picture, band));
        count += patches.back().size();
        bands.push_back(encode_depth_band(patches.back(), band + 1 == depth_bands(kHeight)));
    }
    const std::string piece = encode_depth(picture.step, count, bands);
    std::uint32_t head[2];
    std::memcpy(head, piece.data(), sizeof head);
    CHECK(std::bit_cast<float>(head[0]) == picture.step);
    CHECK(head[1] == count);
    BandReader reader(inflated(std::string_view(piece).substr(8), 4 * bands.size() + 7 * count));
    for (const std::vector<DepthPatch>& band : patches) CHECK(reader.next(band) == band);
    CHECK(reader.at_end());
}

TEST_CASE(
    "depth patches: a quarter of a pixel is what a pixel is off at most, drawn from the reach") {
    const View view = room_view();
    const double step = static_cast<double>(depth_step(view, kWidth, 0.3));
    const double pixels = 0.5 * kWidth / std::tan(35 * kPi / 180);
    CHECK(static_cast<double>(kDepthTolerance) * step * 0.3 * pixels == doctest::Approx(0.25));
}
