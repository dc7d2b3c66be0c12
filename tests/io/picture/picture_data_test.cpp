#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/error.h"
#include "io/picture/picture_data.h"
#include "tests/shared_data.h"

using namespace lightwalk;

namespace {

/// Two wide and three high; the red mantissas in stored order are 1 to 6, so red decodes to 1.5
/// to 6.5.
std::string picture(const std::string& resolution, const std::string& variables = "") {
    std::string bytes = "#?RADIANCE\n" + variables + "\n" + resolution + "\n";
    for (char red = 1; red <= 6; ++red) bytes += {red, 7, 8, static_cast<char>(136)};
    return bytes;
}

void check_error(const std::string& bytes, const char* message) {
    CAPTURE(bytes.substr(0, 80));
    CHECK_THROWS_WITH_AS((void)decode_picture(bytes, "t.hdr"), doctest::Contains(message),
                         InputError);
}

}  // namespace

TEST_CASE("all eight orientations become rows from the bottom") {
    struct Row {
        const char* resolution;
        std::array<int, 6> red;  ///< mantissas from the bottom row up, left to right
    };
    const std::array<Row, 8> rows{{{"-Y 3 +X 2", {5, 6, 3, 4, 1, 2}},
                                   {"-Y 3 -X 2", {6, 5, 4, 3, 2, 1}},
                                   {"+Y 3 +X 2", {1, 2, 3, 4, 5, 6}},
                                   {"+Y 3 -X 2", {2, 1, 4, 3, 6, 5}},
                                   {"+X 2 -Y 3", {3, 6, 2, 5, 1, 4}},
                                   {"-X 2 -Y 3", {6, 3, 5, 2, 4, 1}},
                                   {"+X 2 +Y 3", {1, 4, 2, 5, 3, 6}},
                                   {"-X 2 +Y 3", {4, 1, 5, 2, 6, 3}}}};
    for (const Row& row : rows) {
        CAPTURE(row.resolution);
        const PictureData data = decode_picture(picture(row.resolution), "t.hdr");
        CHECK(data.axes[0].count == 3);
        CHECK(data.axes[1].count == 2);
        REQUIRE(data.values.size() == 6);
        for (std::size_t i = 0; i < 6; ++i) {
            CHECK(data.values[i] == Rgb(static_cast<float>(row.red[i]) + 0.5f, 7.5f, 8.5f));
        }
    }
}

TEST_CASE("the shorter side has length 1, with the pixel aspect, exposure does not matter") {
    const auto extents = [](const char* resolution, const std::string& variables) {
        const PictureData data = decode_picture(picture(resolution, variables), "t.hdr");
        return std::array{data.axes[1].extent, data.axes[0].extent};  // u, v
    };
    CHECK(extents("-Y 3 +X 2", "") == std::array{1.0f, 1.5f});
    CHECK(extents("-Y 2 +X 3", "") == std::array{1.5f, 1.0f});
    CHECK(extents("-Y 3 +X 2", "PIXASPECT=2\nPIXASPECT= 2.0\n") == std::array{1.0f, 6.0f});
    CHECK(extents("-Y 3 +X 2", "PIXASPECT=.5\n") == std::array{2 / 1.5f, 1.0f});
    const std::string exposed = "EXPOSURE=4\nCOLORCORR= 2 2 2\n\tPIXASPECT=9\n";
    CHECK(extents("-Y 3 +X 2", exposed) == std::array{1.0f, 1.5f});
    CHECK(decode_picture(picture("-Y 3 +X 2", exposed), "t.hdr").values[0].r == 5.5f);
}

TEST_CASE("what is no RGBE picture is refused") {
    check_error("\x02", "t.hdr: no information header");
    check_error(picture("-Y 3 +X 2", "FORMAT=32-bit_rle_xyze\n"),
                "t.hdr: bad picture file: format \"32-bit_rle_xyze\"");
    check_error(picture("-Y 3 +X 2", "FORMAT=ascii\n"), "bad picture file: format \"ascii\"");
    check_error(picture("-Y 3 +X"), "bad picture file: bad resolution");
    check_error(picture("-Y 3 +Z 2"), "bad picture file: no resolution line");
    check_error(picture("-Y 0 +X 2"), "bad picture file: bad resolution \"-Y 0 +X 2\"");
    check_error(picture("-Y -3 +X 2"), "bad picture file: bad resolution");
    check_error(picture("-Y 3 +X 99999999999999999999"), "bad picture file: bad resolution");
    check_error(picture("-Y 3 +X 2                            "),
                "bad picture file: no resolution line");
    for (const std::string aspect : {"0", "-1", "1e-7", "x", "", "1e999"}) {
        check_error(picture("-Y 3 +X 2", "PIXASPECT=" + aspect + "\n"), "bad picture file");
    }
    const std::string whole = picture("-Y 3 +X 2");
    for (std::size_t n = 0; n < whole.size(); ++n) {
        CAPTURE(n);
        CHECK_THROWS_AS((void)decode_picture(whole.substr(0, n), "t.hdr"), InputError);
    }
}

TEST_CASE("a size that the data cannot fill fails before it is allocated") {
    check_error("#?RADIANCE\n\n-Y 1000000000 +X 1000000000\n",
                "the data end before scanline 1 of 1000000000");
    check_error("#?RADIANCE\n\n-Y 1 +X 2000000000\n\x05\x05\x05\x05",
                "pixels are too many for a file of its size");
    std::string repeats = "#?RADIANCE\n\n-Y 1 +X 2000000000\n\x05\x05\x05\x05";
    for (int i = 0; i < 4; ++i) repeats += "\x01\x01\x01\xff";
    check_error(repeats, "pixels are too many for a file of its size");
    check_error("#?RADIANCE\n\n-Y 1 +X 10000000\n\x05\x05\x05\x05",
                "scanline 1: the data end within a scanline");
}

TEST_CASE("the pictures of the sample library decode") {
    LIGHTWALK_NEEDS_SHARED(folder, "scenes/lib");
    int pictures = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".hdr") continue;
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        CAPTURE(entry.path().string());
        const PictureData data = decode_picture(bytes, entry.path().string());
        CHECK(data.values.size() == data.axes[0].count * std::size_t{data.axes[1].count});
        // Sane radiances: neither a shifted component nor a lost byte would leave the mean there.
        double sum = 0;
        for (const Rgb& c : data.values) sum += static_cast<double>(brightness(c));
        CHECK(sum / static_cast<double>(data.values.size()) > 0.01);
        CHECK(sum / static_cast<double>(data.values.size()) < 10);
        ++pictures;
    }
    CHECK(pictures >= 11);
}
