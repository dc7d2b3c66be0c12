// ldt2rad: a luminaire of a EULUMDAT file, as ies2rad makes it of an IES file.
#include <utility>

#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/luminaire_scene.h"
#include "io/generators/scene_writer.h"
#include "io/photometry/eulumdat.h"

namespace lightwalk {
namespace {

constexpr std::string_view kLdt2radUsage =
    "[-s] [-o outname] [-t default] [-c red grn blu] [-m factor] input";
constexpr std::size_t kMostEulumdatBytes = std::size_t{64} << 20;

struct Ldt2radOptions {
    std::string name;     ///< -o
    bool by_lamp = true;  ///< the colour is that of the lamps
    Rgb color{1, 1, 1};
    double factor = 1;
    std::string input;
};

Ldt2radOptions parse_ldt2rad(GeneratorWords& words) {
    Ldt2radOptions options;
    while (!words.at_end() && words.peek().starts_with('-')) {
        if (words.accept("-s")) continue;  // the scene always goes to the output
        if (words.accept("-o")) {
            options.name = words.text("output name");
        } else if (words.accept("-t")) {
            if (!words.accept("default")) words.fail("-t knows no lamp but \"default\"");
            options.by_lamp = false;
        } else if (words.accept("-c")) {
            for (std::size_t c = 0; c < 3; ++c)
                options.color[c] = static_cast<float>(words.real("colour"));
        } else if (words.accept("-m")) {
            options.factor = words.real("factor");
        } else {
            words.unknown_option();
        }
    }
    options.input = words.text("input");
    if (!words.at_end()) words.fail("there is more than one input");
    return options;
}

}  // namespace

std::string run_ldt2rad(std::span<const std::string> args, GeneratorContext& context) {
    GeneratorWords words(args, kLdt2radUsage);
    const Ldt2radOptions options = parse_ldt2rad(words);
    FileSource& files = context.library.files();
    const std::string path = path_from(context.directory, options.input);
    EulumdatFile file = decode_eulumdat(files.read(path, kMostEulumdatBytes), path);
    file.photometry.factor *= options.factor;
    const std::string base = options.input.substr(options.input.rfind('/') + 1);
    const std::string root = options.name.empty() ? base.substr(0, base.rfind('.')) : options.name;
    LuminaireStyle style;
    style.name = root.substr(root.rfind('/') + 1);
    style.data_name = root + ".dat";
    style.color = options.by_lamp && file.lamp ? file.lamp->color() : options.color;
    SceneWriter out(args);
    if (!files.keep(path_from(context.directory, style.data_name), luminaire_data(file.photometry)))
        context.warnings.warn(path + ": \"" + style.data_name +
                              "\" has been made before with other contents, which are lost; -o "
                              "gives it another name");
    out.text(luminaire_scene(file.photometry, style));
    return out.release();
}

}  // namespace lightwalk
