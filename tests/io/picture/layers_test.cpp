#include "io/picture/layers.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/files/library_path.h"
#include "io/options/option_words.h"
#include "io/picture/encode_picture.h"
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

    void write(const std::string& pattern) const {
        const std::vector<PictureLayer> layers{{"sun", sun}, {"desk.lamp", lamp}};
        write_layers(pattern, whole, layers, header, [](const std::string& name) { return name; });
    }
};

Picture sum_of(const std::string& path, const std::vector<Rgb>& factors) {
    const std::string bytes = read_file(path);
    const LayersHeader header = read_layers_header(bytes, path);
    Picture sum{header.width, header.height, {}};
    sum.pixels.resize(static_cast<std::size_t>(header.width * header.height));
    add_layers(bytes, path, factors, sum);
    return sum;
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
        const auto read = [&] {
            const std::string_view part = std::string_view(bytes).substr(0, size);
            const LayersHeader header = read_layers_header(part, "part.exr");
            Picture sum{header.width, header.height, {}};
            sum.pixels.resize(static_cast<std::size_t>(header.width * header.height));
            add_layers(part, "part.exr", std::vector<Rgb>(header.names.size(), {1, 1, 1}), sum);
        };
        CHECK_THROWS_WITH_AS(read(), doctest::Contains("part.exr: damaged OpenEXR file"),
                             InputError);
    }
    CHECK_THROWS_WITH_AS((void)read_layers_header("no picture", "a.hdr"),
                         doctest::Contains("a.hdr"), InputError);
    const std::string depth = encode_exr(2, 2, {1, 2, 3, 4});
    CHECK_THROWS_WITH_AS((void)read_layers_header(depth, "z.exr"),
                         doctest::Contains("z.exr: no layers: expected channels R G B or NAME.R"),
                         InputError);
}
