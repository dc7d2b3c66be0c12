#include "io/picture/layers.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/files/library_path.h"
#include "io/files/module.h"
#include "io/options/option_words.h"
#include "io/picture/encode_picture.h"
#include "io/picture/image_decoder.h"
#include "io/picture/image_encoder.h"
#include "tests/temporary_folder.h"

using namespace lightwalk;
using test::TemporaryFolder;

namespace {

constexpr int kWidth = 23, kHeight = 70;  ///< more rows than are decoded together, and no square

std::vector<Rgb> layer_pixels(float factor) {
    std::vector<Rgb> pixels;
    for (int i = 0; i < kWidth * kHeight; ++i)
        pixels.push_back(
            {factor * static_cast<float>(i), factor, .25f * static_cast<float>(i % 7)});
    return pixels;
}

struct Layers {
    Picture whole{kWidth, kHeight, layer_pixels(9)};
    std::vector<Rgb> sun = layer_pixels(2), lamp = layer_pixels(.5f);
    PictureHeader header{{"rpict -o x", "VIEW= -vtv", "CAPDATE= 2001:02:03 04:05:06"}};

    void write(const std::string& pattern, const std::vector<float>& error = {}) const {
        const std::vector<PictureLayer> layers{{"sun", sun}, {"desk.lamp", lamp}};
        write_layers(pattern, whole, layers, error, header,
                     [](const std::string& name) { return name; });
    }
};

/// One channel of an OpenEXR file.
class ChannelRows final : public ImageRows {
  public:
    explicit ChannelRows(std::string name) : name_(std::move(name)) {}
    [[nodiscard]] int most_channels() const override { return 64; }
    void named(const std::vector<std::string>& channels, const std::string&) override {
        at_ = static_cast<std::size_t>(std::ranges::find(channels, name_) - channels.begin());
    }
    bool begin(int width, int, int channels, bool) override {
        width_ = width;
        channels_ = static_cast<std::size_t>(channels);
        return at_ < channels_;
    }
    void take(int, int count, const float* values) override {
        for (int i = 0; i < count * width_; ++i)
            found.push_back(values[static_cast<std::size_t>(i) * channels_ + at_]);
    }
    std::vector<float> found;  ///< empty: there is no such channel

  private:
    std::string name_;
    std::size_t at_ = 0, channels_ = 0;
    int width_ = 0;
};

std::vector<float> channel_of(const std::string& path, const std::string& name) {
    std::string error;
    const auto decode =
        reinterpret_cast<DecodeImage>(load_from_module(kImageModule, kDecodeImageSymbol, error));
    REQUIRE_MESSAGE(static_cast<bool>(decode), error);
    ChannelRows rows(name);
    decode(read_file(path), "openexr", rows, error = {});
    CHECK(error.empty());
    return rows.found;
}

Picture sum_of(const std::string& path, const std::vector<Rgb>& factors) {
    const std::string bytes = read_file(path);
    const LayersHeader header = read_layers_header(bytes, path);
    Picture sum{header.width, header.height, {}};
    sum.pixels.resize(static_cast<std::size_t>(header.width * header.height));
    add_layers(bytes, path, factors, sum);
    return sum;
}

/// Reads a file's layers, one by one.
void add_all_layers(std::string_view bytes) {
    const LayersHeader header = read_layers_header(bytes, "part.exr");
    Picture sum{header.width, header.height, {}};
    sum.pixels.resize(static_cast<std::size_t>(header.width * header.height));
    add_layers(bytes, "part.exr", std::vector<Rgb>(header.names.size(), {1, 1, 1}), sum);
}

/// Where an OpenEXR file says where its rows are: the first of these lie behind the table itself.
std::size_t offsets_in(const std::string& bytes) {
    constexpr std::size_t kLongestTable = 1024;  // [bytes]
    for (std::size_t at = 8; at + sizeof(std::uint64_t) <= bytes.size(); ++at) {
        std::uint64_t offset = 0;
        std::memcpy(&offset, &bytes[at], sizeof offset);
        if (offset > at && offset <= at + kLongestTable && (offset - at) % sizeof offset == 0)
            return at;
    }
    FAIL("no table of rows");
    return 0;
}

}  // namespace

TEST_CASE("layers of an OpenEXR file come back as they were, each times its factor") {
    const TemporaryFolder folder;
    const Layers layers;
    layers.write(folder.path("all.exr"));
    const LayersHeader header = read_layers_header(read_file(folder.path("all.exr")), "all.exr");
    CHECK(header.width == kWidth);
    CHECK(header.height == kHeight);
    CHECK(header.lines == layers.header.lines);
    const bool sorted = header.names == std::vector<std::string>{"desk.lamp", "sun"};
    CHECK((sorted || header.names == std::vector<std::string>{"sun", "desk.lamp"}));
    const Rgb first{2, 0, 1}, second{.5f, 1, 3};
    const Picture sum = sum_of(folder.path("all.exr"),
                               sorted ? std::vector{second, first} : std::vector{first, second});
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
        CAPTURE(i);
        const Rgb expected = first * layers.sun[i] + second * layers.lamp[i];
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(static_cast<double>(sum.pixels[i][k]) ==
                  doctest::Approx(static_cast<double>(expected[k])).epsilon(1e-6));
    }
}

TEST_CASE("beside its layers an OpenEXR file shows the whole picture") {
    const TemporaryFolder folder;
    const Layers layers;
    layers.write(folder.path("all.exr"));
    // Where no channel is a layer's, R G B are one by the name of the file.
    write_picture(folder.path("whole.exr"), layers.whole, layers.header, {});
    CHECK(read_layers_header(read_file(folder.path("whole.exr")), "a/whole.exr").names ==
          std::vector<std::string>{"whole"});
    CHECK(sum_of(folder.path("whole.exr"), {{1, 1, 1}}).pixels == layers.whole.pixels);
    const std::string bytes = read_file(folder.path("all.exr"));
    for (const char* channel : {"sun.R", "sun.G", "sun.B", "desk.lamp.R"})
        CHECK(bytes.find(std::string(channel) + '\0') != std::string::npos);
}

TEST_CASE("the picture's error goes beside the layers, and is none of them") {
    const TemporaryFolder folder;
    const Layers layers;
    std::vector<float> error;
    for (int i = 0; i < kWidth * kHeight; ++i) error.push_back(.001f * static_cast<float>(i));
    layers.write(folder.path("with.exr"), error);
    layers.write(folder.path("without.exr"));
    CHECK(channel_of(folder.path("with.exr"), "error") == error);
    CHECK(channel_of(folder.path("without.exr"), "error").empty());
    const auto names = [&](const std::string& file) {
        return read_layers_header(read_file(folder.path(file)), file).names;
    };
    CHECK(names("with.exr") == names("without.exr"));
    const std::vector<Rgb> factors{{1, 2, 3}, {1, 2, 3}};
    CHECK(sum_of(folder.path("with.exr"), factors).pixels ==
          sum_of(folder.path("without.exr"), factors).pixels);
    for (const char* channel : {"R", "G", "B", "sun.R", "desk.lamp.B"})
        CHECK(channel_of(folder.path("with.exr"), channel) ==
              channel_of(folder.path("without.exr"), channel));
    layers.write(folder.path("%s.exr"), error);  // that of a layer by itself is not known
    CHECK(channel_of(folder.path("sun.exr"), "error").empty());
}

TEST_CASE("layers in files of their own say in their headers which they are") {
    const TemporaryFolder folder;
    const Layers layers;
    for (const std::string ending : {"hdr", "exr"}) {
        layers.write(folder.path("f_%s." + ending));
        const std::string file = folder.path("f_desk.lamp." + ending);
        const LayersHeader header = read_layers_header(read_file(file), file);
        CHECK(header.names == std::vector<std::string>{"desk.lamp"});
        CHECK(header.lines == layers.header.lines);
    }
    CHECK(folder.files() ==
          std::vector<std::string>{"f_desk.lamp.exr", "f_desk.lamp.hdr", "f_sun.exr", "f_sun.hdr"});
    CHECK(sum_of(folder.path("f_sun.exr"), {{1, 1, 1}}).pixels == layers.sun);
    // A step of RGBE is 1/256 of the largest channel.
    const Picture hdr = sum_of(folder.path("f_sun.hdr"), {{2, 2, 2}});
    for (std::size_t i = 0; i < hdr.pixels.size(); ++i)
        CHECK(static_cast<double>(std::abs(hdr.pixels[i].r - 2 * layers.sun[i].r)) <=
              static_cast<double>(2 * max_component(layers.sun[i])) / 128);
}

TEST_CASE("names of layers' files") {
    CHECK(layer_file_name("f_%s.hdr", "sun") == "f_sun.hdr");
    CHECK(layer_file_name("f_%s_%03d.hdr", "50%") == "f_50%%_%03d.hdr");
    CHECK(layer_file_name("all.exr", "sun") == "all.exr");
    CHECK_THROWS_WITH_AS((void)layer_file_name("%s%s.hdr", "a"), doctest::Contains("more than one"),
                         UsageError);
    for (const char* good : {"a.exr", "%s.exr", "%s.hdr", "%s.pic", "%s"})
        CHECK_NOTHROW(check_layers_name(good));
    for (const char* bad : {"a.hdr", "a", "%s.png", "a.png", "%s.jpg"})
        CHECK_THROWS_AS(check_layers_name(bad), UsageError);
}

TEST_CASE("damaged files of layers are told by name, wherever they break off") {
    const TemporaryFolder folder;
    const Layers layers;
    layers.write(folder.path("all.exr"));
    const std::string bytes = read_file(folder.path("all.exr"));
    for (std::size_t size = 4; size < bytes.size(); size += bytes.size() / 40) {
        CAPTURE(size);
        CHECK_THROWS_WITH_AS(add_all_layers(std::string_view(bytes).substr(0, size)),
                             doctest::Contains("part.exr: damaged OpenEXR file"), InputError);
    }
    // Rows that the file says lie before or behind it.
    std::string elsewhere = bytes;
    const std::size_t table = offsets_in(elsewhere);
    for (const std::int64_t offset :
         {std::int64_t{-1}, std::int64_t{-100'000}, std::int64_t{1} << 40, std::int64_t{1} << 62}) {
        CAPTURE(offset);
        std::memcpy(&elsewhere[table], &offset, sizeof offset);
        CHECK_THROWS_WITH_AS(add_all_layers(elsewhere),
                             doctest::Contains("part.exr: damaged OpenEXR file"), InputError);
    }
    CHECK_THROWS_WITH_AS((void)read_layers_header("no picture", "a.hdr"),
                         doctest::Contains("a.hdr"), InputError);
    const std::string depth = encode_exr(2, 2, {1, 2, 3, 4});
    CHECK_THROWS_WITH_AS((void)read_layers_header(depth, "z.exr"),
                         doctest::Contains("z.exr: no layers: expected channels R G B or NAME.R"),
                         InputError);
}
