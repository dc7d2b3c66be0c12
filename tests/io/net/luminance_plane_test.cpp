#include "io/net/luminance_plane.h"

#include <doctest/doctest.h>
#include <turbojpeg.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "core/math/xyz.h"

using namespace lightwalk;

namespace {

/// What a page makes of a piece.
struct ReadPlane {
    explicit ReadPlane(const std::string& bytes) {
        REQUIRE(bytes.size() > 12);
        std::memcpy(&low, bytes.data(), 4);
        std::memcpy(&step, bytes.data() + 4, 4);
        std::memcpy(&white, bytes.data() + 8, 4);
        const auto* jpeg = reinterpret_cast<const unsigned char*>(bytes.data()) + 12;
        const auto size = static_cast<unsigned long>(bytes.size() - 12);
        const tjhandle handle = tjInitDecompress();
        int sampling = 0, colours = 0;
        REQUIRE(tjDecompressHeader3(handle, jpeg, size, &width, &height, &sampling, &colours) == 0);
        greys.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        CHECK(tjDecompress2(handle, jpeg, size, greys.data(), width, 0, height, TJPF_GRAY, 0) == 0);
        (void)tjDestroy(handle);
    }
    /// Luminance of a square [cd/m2].
    [[nodiscard]] double at(int x, int y) const {
        const auto grey = greys[static_cast<std::size_t>(y * width + x)];
        return grey == 0 ? 0 : std::exp2(double(low) + double(step) * grey);
    }
    float low = 0, step = 0, white = 0;
    int width = 0, height = 0;
    std::vector<std::uint8_t> greys;
};

struct Measured {
    LuminancePlane plane;
    JpegCompressor compressor;
    ReadPlane of(const std::vector<Rgb>& picture, int width, int height, float white = 1) {
        plane.begin(width, height);
        plane.measure(picture, {0, 0, width, height});
        plane.finish(white);
        return ReadPlane(plane.bytes(compressor));
    }
};

}  // namespace

TEST_CASE("luminance plane: squares have the mean luminance of their pixels, also cut-off ones") {
    const int width = 70, height = 41;  // 18 x 11 squares
    std::vector<Rgb> picture;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            picture.push_back(Rgb::grey(std::exp2(0.1f * static_cast<float>(x))));
    Measured measured;
    const ReadPlane plane = measured.of(picture, width, height, 2.5f);
    CHECK(plane.white == 2.5f);
    REQUIRE(plane.width == 18);
    REQUIRE(plane.height == 11);
    for (const int x : {0, 7, 16}) {
        double mean = 0;
        for (int k = 0; k < 4; ++k) mean += double{kEfficacy} * std::exp2(0.1 * (4 * x + k)) / 4;
        for (const int y : {0, 10}) CHECK(plane.at(x, y) == doctest::Approx(mean).epsilon(0.06));
    }
    const double last = double{kEfficacy} * (std::exp2(6.8) + std::exp2(6.9)) / 2;
    CHECK(plane.at(17, 10) == doctest::Approx(last).epsilon(0.06));
}

TEST_CASE("luminance plane: parts of a picture may be measured one by one") {
    std::vector<Rgb> picture;
    for (int i = 0; i < 24 * 10; ++i) picture.push_back(Rgb::grey(1 + static_cast<float>(i)));
    Measured whole;
    (void)whole.of(picture, 24, 10);
    LuminancePlane plane;
    plane.begin(24, 10);
    for (const PixelRectangle& part :
         {PixelRectangle{8, 8, 24, 10}, {0, 0, 8, 8}, {8, 0, 24, 8}, {0, 8, 8, 10}})
        plane.measure(picture, part);
    plane.finish(1);
    CHECK(plane.content() == whole.plane.content());
}

TEST_CASE("luminance plane: a picture of one luminance, of none, of numbers that are none") {
    Measured measured;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinite = std::numeric_limits<float>::infinity();
    const auto constant = [&](float value) {
        return measured.of(std::vector<Rgb>(64, Rgb::grey(value)), 8, 8).at(1, 1);
    };
    CHECK(constant(2) == doctest::Approx(358).epsilon(0.01));
    for (const float value : {0.0f, -1.0f, nan, infinite}) CHECK(constant(value) == 0);
}

TEST_CASE("luminance plane: the scale has 24 octaves at most, below the brightest") {
    std::vector<Rgb> picture(32 * 32, Rgb::grey(1e-9f));
    for (std::size_t i = 0; i < picture.size() / 2; ++i) picture[i] = Rgb::grey(1e7f);
    Measured measured;
    const ReadPlane plane = measured.of(picture, 32, 32);
    CHECK(plane.at(4, 0) == doctest::Approx(1.79e9).epsilon(0.1));
    CHECK(plane.at(4, 7) < 1e4 * 179);
}

TEST_CASE("luminance plane: what is forgotten has no bytes, what is the same has the same") {
    Measured measured;
    const std::vector<Rgb> picture(64, Rgb::grey(2));
    (void)measured.of(picture, 8, 8, 1);
    const std::uint64_t content = measured.plane.content();
    (void)measured.of(picture, 8, 8, 1);
    CHECK(measured.plane.content() == content);
    (void)measured.of(picture, 8, 8, 2);
    CHECK(measured.plane.content() != content);
    measured.plane.forget();
    CHECK(measured.plane.content() == 0);
    CHECK(measured.plane.bytes(measured.compressor).empty());
}
