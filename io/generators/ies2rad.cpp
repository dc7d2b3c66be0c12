// ies2rad: a luminaire of an IES photometric data file. See Radiance's manual page ies2rad(1).
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/model/transform_args.h"
#include "io/generators/generator.h"
#include "io/generators/generator_words.h"
#include "io/generators/luminaire_scene.h"
#include "io/generators/scene_writer.h"
#include "io/photometry/ies_file.h"
#include "io/photometry/lamp_table.h"

namespace lightwalk {
namespace {

constexpr std::string_view kIes2radUsage =
    "[-l libdir] [-p prefdir] [-o outname] [-s] [-d{m|c|f|i}[/divisor]] [-i radius] [-g] "
    "[-f lampdat] [-t lamp] [-c red grn blu] [-u lamp] [-m factor] [input ...]";
constexpr std::size_t kMostLuminaireBytes = std::size_t{64} << 20;

struct Ies2radOptions {
    std::string library, prefix, name;  ///< -l, -p, -o
    bool to_output = false;
    double unit = 1;  ///< lengths of the scene in a metre
    std::optional<double> illum_radius;
    std::string lamp_table = "lamp.tab";
    std::optional<std::string> lamp, default_lamp;
    Rgb default_color{1, 1, 1};
    double factor = 1;
    std::vector<std::string> files;
};

/// Units in a metre; `word` is -dm, -dc, -df or -di, perhaps with a divisor of the unit.
std::optional<double> unit_of(std::string_view word) {
    constexpr std::array<std::pair<char, double>, 4> kUnits = {
        {{'m', 1}, {'c', 100}, {'f', 1 / 0.3048}, {'i', 12 / 0.3048}}};
    if (word.size() < 3 || !word.starts_with("-d")) return std::nullopt;
    for (const auto& [letter, in_metre] : kUnits) {
        if (word[2] != letter) continue;
        if (word.size() == 3) return in_metre;
        double divisor = 0;
        if (word[3] == '/' && parse_real(word.substr(4), divisor) && divisor > 0 && divisor <= 1e9)
            return in_metre * divisor;
    }
    return std::nullopt;
}

Rgb parse_color(GeneratorWords& words) {
    const double r = words.real("red"), g = words.real("green"), b = words.real("blue");
    return {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
}

void parse_ies2rad_option(GeneratorWords& words, Ies2radOptions& options) {
    if (const std::optional<double> unit = unit_of(words.peek())) {
        options.unit = *unit;
        (void)words.text("unit");
    } else if (words.accept("-l")) {
        options.library = words.text("library directory");
    } else if (words.accept("-p")) {
        options.prefix = words.text("subdirectory");
    } else if (words.accept("-o")) {
        options.name = words.text("output name");
    } else if (words.accept("-s")) {
        options.to_output = true;
    } else if (words.accept("-i")) {
        options.illum_radius = words.positive("radius");
    } else if (words.accept("-f")) {
        options.lamp_table = words.text("lamp table");
    } else if (words.accept("-t")) {
        options.lamp = words.text("lamp");
    } else if (words.accept("-u")) {
        options.default_lamp = words.text("lamp");
    } else if (words.accept("-c")) {
        options.default_color = parse_color(words);
    } else if (words.accept("-m")) {
        options.factor = words.real("factor");
    } else if (!words.accept("-g")) {  // -g is about geometry that no file has
        words.unknown_option();
    }
}

Ies2radOptions parse_ies2rad(GeneratorWords& words) {
    Ies2radOptions options;
    while (!words.at_end() && words.peek().starts_with('-')) parse_ies2rad_option(words, options);
    while (!words.at_end()) options.files.push_back(words.text("input"));
    if (options.files.size() != 1 && options.to_output && !options.files.empty())
        words.fail("-s wants a single input file");
    if (options.files.size() > 1 && !options.name.empty())
        words.fail("-o wants a single input file");
    if (options.files.empty() && options.name.empty())
        words.fail("standard input wants an output name (-o)");
    return options;
}

/// The last part of a path.
std::string base_name(const std::string& path) {
    return path.substr(path.rfind('/') + 1);
}

/// ... without its ending.
std::string root_name(const std::string& path) {
    const std::string name = base_name(path);
    return name.substr(0, name.rfind('.'));
}

class Ies2rad {
  public:
    Ies2rad(std::span<const std::string> args, GeneratorContext& context)
        : args_(args),
          context_(context),
          words_(args, kIes2radUsage),
          options_(parse_ies2rad(words_)) {}

    std::string run() {
        find_default_lamp();
        std::string output;
        if (options_.files.empty())
            output = convert(context_.standard_input(), "standard input", options_.name, "");
        for (const std::string& file : options_.files) {
            const std::string path = path_from(context_.directory, file);
            const std::string text = context_.library.files().read(path, kMostLuminaireBytes);
            output += convert(text, path, options_.name.empty() ? root_name(file) : options_.name,
                              directory_of(path));
        }
        return output;
    }

  private:
    /// The scene, or nothing when it is kept as a file.
    /// @param root       output name without directories of options
    /// @param directory  of the input
    std::string convert(const std::string& text, const std::string& file, const std::string& root,
                        const std::string& directory) {
        IesFile ies = decode_ies(text, file);
        Photometry& photometry = ies.photometry;
        photometry.factor *= options_.factor;
        const std::string in_library = path_from(options_.prefix, root);
        LuminaireStyle style;
        style.name = base_name(root);
        style.data_name = in_library + ".dat";
        style.color = color_of(ies, file);
        style.unit = options_.unit;
        if (options_.illum_radius) {
            const double diameter = 2 * *options_.illum_radius / options_.unit;
            photometry.body = {LuminousBody::Form::sphere, diameter, diameter, diameter};
            style.illum = true;
        }
        SceneWriter out(args_);
        if (!ies.tilt_file.empty()) ies.tilt = read_tilt_file(ies.tilt_file, file, directory);
        if (ies.tilt) {
            style.modifier = style.name + "_tilt";
            const std::string tilt_name = in_library + "+.dat";
            out.text(tilt_scene(*ies.tilt, style.modifier, tilt_name));
            keep(tilt_name, tilt_data(*ies.tilt), file);
        }
        keep(style.data_name, luminaire_data(photometry), file);
        out.text(luminaire_scene(photometry, style));
        if (options_.to_output) return out.release();
        keep(path_from(options_.library, in_library + ".rad"), out.release(), file);
        return {};
    }

    /// Beside the file that names it, or in the working directory.
    LampTilt read_tilt_file(const std::string& name, const std::string& file,
                            const std::string& directory) {
        FileSource& files = context_.library.files();
        for (const std::string& path :
             {path_from(directory, name), path_from(context_.directory, name)}) {
            if (files.readable(path))
                return decode_tilt(files.read(path, kMostLuminaireBytes), path);
        }
        throw InputError({file, 0}, "cannot open the file of TILT=" + name);
    }

    void keep(const std::string& name, std::string bytes, const std::string& file) {
        if (!context_.library.files().keep(path_from(context_.directory, name), std::move(bytes)))
            context_.warnings.warn(file + ": \"" + name +
                                   "\" has been made before with other contents, which are lost; "
                                   "-o gives it another name");
    }

    /// The table; null when there is none.
    const LampTable* lamps() {
        if (looked_for_table_) return table_ ? &*table_ : nullptr;
        looked_for_table_ = true;
        const std::optional<std::string> path = context_.library.find(options_.lamp_table);
        if (!path) {
            context_.warnings.warn("ies2rad: cannot find lamp table \"" + options_.lamp_table +
                                   "\"; colours of lamps are not known");
            return nullptr;
        }
        table_.emplace(context_.library.files().read(*path, kMostLuminaireBytes), *path);
        return &*table_;
    }

    void find_default_lamp() {
        if (!options_.default_lamp || !lamps()) return;
        if (const std::optional<Lamp> lamp = table_->find(*options_.default_lamp))
            options_.default_color = lamp->color();
        else
            context_.warnings.warn("ies2rad: unknown default lamp \"" + *options_.default_lamp +
                                   "\"");
    }

    Rgb color_of(const IesFile& ies, const std::string& file) {
        if (options_.lamp == "default" || !lamps()) return options_.default_color;
        if (options_.lamp) {
            if (const std::optional<Lamp> lamp = table_->find(*options_.lamp)) return lamp->color();
            context_.warnings.warn("ies2rad: unknown lamp \"" + *options_.lamp + "\"");
            return options_.default_color;
        }
        for (const std::string& line : ies.lamps) {
            if (const std::optional<Lamp> lamp = table_->find(line)) return lamp->color();
        }
        context_.warnings.warn(file + ": no lamp of the lamp table, the default colour is used");
        return options_.default_color;
    }

    std::span<const std::string> args_;
    GeneratorContext& context_;
    GeneratorWords words_;
    Ies2radOptions options_;
    bool looked_for_table_ = false;
    std::optional<LampTable> table_;
};

}  // namespace

std::string run_ies2rad(std::span<const std::string> args, GeneratorContext& context) {
    return Ies2rad(args, context).run();
}

}  // namespace lightwalk
