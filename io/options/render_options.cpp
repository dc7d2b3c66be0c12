#include "io/options/render_options.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <string_view>
#include <variant>

namespace lightwalk {
namespace {

/// Where an option's value lives; its type tells how it is read and printed.
using Place = std::variant<bool RenderOptions::*, int RenderOptions::*, double RenderOptions::*,
                           Rgb RenderOptions::*>;

struct Entry {
    const char* name;
    Place place;
    const char* description;
    bool scientific = false;  ///< printed as %.2e
    bool whole = false;       ///< the value is a whole number though its place is real
};

constexpr std::size_t kMaxModifiers = 512;  ///< of -ae and -ai together

using O = RenderOptions;
const std::array kEntries{
    Entry{"-i", &O::irradiance, "irradiance instead of radiance"},
    Entry{"-bv", &O::back_faces_visible, "back faces visible"},
    Entry{"-dt", &O::shadow_threshold, "direct threshold"},
    Entry{"-dc", &O::shadow_certainty, "direct certainty"},
    Entry{"-dj", &O::source_jitter, "direct jitter"},
    Entry{"-ds", &O::source_subdivision, "direct sampling (source size / distance)"},
    Entry{"-dr", &O::redirections, "relays of virtual light sources"},
    Entry{"-dp", &O::virtual_source_pretest, "pretest density of virtual sources [1/sr]", false,
          true},
    Entry{"-dv", &O::sources_visible, "light sources visible"},
    Entry{"-ss", &O::specular_samples, "specular samples"},
    Entry{"-st", &O::specular_threshold, "specular threshold"},
    Entry{"-av", &O::ambient_value, "ambient value [W/(m2 sr)]"},
    Entry{"-aw", &O::ambient_weight, "ambient value weight"},
    Entry{"-ab", &O::ambient_bounces, "ambient bounces"},
    Entry{"-aa", &O::ambient_accuracy, "ambient accuracy"},
    Entry{"-ar", &O::ambient_resolution, "ambient resolution"},
    Entry{"-ad", &O::ambient_divisions, "ambient divisions"},
    Entry{"-as", &O::ambient_super_samples, "ambient super-samples"},
    Entry{"-me", &O::extinction, "mist extinction [1/m]", true},
    Entry{"-ma", &O::albedo, "mist scattering albedo"},
    Entry{"-mg", &O::eccentricity, "mist scattering eccentricity"},
    Entry{"-ms", &O::scatter_step, "mist sampling distance [m]"},
    Entry{"-lr", &O::reflection_limit, "limit of reflections (<= 0: Russian roulette)"},
    Entry{"-lw", &O::weight_limit, "limit of weight", true},
};

std::string formatted(const char* format, double value) {
    std::array<char, 400> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

std::string formatted(const char* format, const Rgb& c) {
    std::string text;
    for (std::size_t i = 0; i < 3; ++i) {
        if (i > 0) text += ' ';
        text += formatted(format, static_cast<double>(c[i]));
    }
    return text;
}

std::string text_of(const Entry& entry, const RenderOptions& options) {
    const std::string name = entry.name;
    if (const auto* flag = std::get_if<bool O::*>(&entry.place))
        return option_text(name, options.**flag);
    if (const auto* count = std::get_if<int O::*>(&entry.place))
        return option_text(name, options.**count);
    if (const auto* color = std::get_if<Rgb O::*>(&entry.place)) {
        return name + ' ' + formatted(entry.scientific ? "%.2e" : "%f", options.**color);
    }
    const double value = options.*std::get<double O::*>(entry.place);
    return name + ' ' + formatted(entry.whole ? "%.0f" : entry.scientific ? "%.2e" : "%f", value);
}

bool parse_entry(const Entry& entry, OptionWords& words, RenderOptions& options) {
    if (const auto* flag = std::get_if<bool O::*>(&entry.place)) {
        const std::optional<bool> value = words.toggle(entry.name, options.**flag);
        if (value) options.** flag = *value;
        return value.has_value();
    }
    if (words.option() != entry.name) return false;
    if (const auto* count = std::get_if<int O::*>(&entry.place))
        options.** count = words.integer();
    else if (const auto* color = std::get_if<Rgb O::*>(&entry.place))
        options.** color = words.rgb();
    else
        options.*std::get<double O::*>(entry.place) = entry.whole ? words.integer() : words.real();
    return true;
}

void select(AmbientSelection& selection, AmbientSelection::Kind kind,
            const std::vector<std::string>& names) {
    if (selection.kind != kind) selection = {kind, {}};
    selection.modifiers.insert(selection.modifiers.end(), names.begin(), names.end());
    if (selection.modifiers.size() > kMaxModifiers) {
        throw UsageError("more than " + std::to_string(kMaxModifiers) +
                         " modifiers in ambient lists");
    }
}

bool parse_ambient_selection(OptionWords& words, const LibraryPath& library,
                             AmbientSelection& selection) {
    const std::string option = words.option();
    using Kind = AmbientSelection::Kind;
    if (option == "-ae" || option == "-ai") {
        select(selection, option == "-ae" ? Kind::exclude : Kind::include, {words.text()});
    } else if (option == "-aE" || option == "-aI") {
        select(selection, option == "-aE" ? Kind::exclude : Kind::include,
               names_in_file(words.text(), library));
    } else {
        return false;
    }
    return true;
}

/// Options of Radiance that Lightwalk knows and does not offer.
struct Foreign {
    const char* name;
    const char* what;  ///< it is, and why it is not there
};
constexpr const char* kPhotonMap = "names a photon map, which Lightwalk does not support";
constexpr const char* kSpectral =
    "is about spectral rendering; Lightwalk renders three channels (red, green, blue)";
constexpr const char* kWeighted =
    "weights colours by another eye than the photopic one, which Lightwalk does not support; the "
    "choices are -pRGB, -pXYZ, -pY (photopic) and -pA (mean)";
constexpr std::array kForeign{
    Foreign{"-ap", kPhotonMap},
    Foreign{"-am", "limits the search in photon maps, which Lightwalk does not support"},
    Foreign{"-ac", "is about photon maps, which Lightwalk does not support"},
    Foreign{"-aC", "is about photon maps, which Lightwalk does not support"},
    Foreign{"-cs", kSpectral},
    Foreign{"-cw", kSpectral},
    Foreign{"-co", kSpectral},
    Foreign{"-co+", kSpectral},
    Foreign{"-co-", kSpectral},
    Foreign{"-pS", kWeighted},
    Foreign{"-pM", kWeighted},
    Foreign{"-f",
            "reads definitions for all of a scene's functions, which Lightwalk does not "
            "support; name the file in the scene"},
    Foreign{"-sj", "is gone since Radiance 4, use -ss"},
};

void refuse_foreign(const OptionWords& words) {
    const auto found = std::find_if(kForeign.begin(), kForeign.end(),
                                    [&](const Foreign& f) { return words.option() == f.name; });
    if (found != kForeign.end()) throw UsageError("option " + words.option() + " " + found->what);
}

}  // namespace

std::vector<std::string> names_in_file(const std::string& name, const LibraryPath& library) {
    std::istringstream text(library.files().read(library.locate(name, "modifier list")));
    std::vector<std::string> names;
    for (std::string word; text >> word;) names.push_back(word);
    return names;
}

RenderSettings default_render_settings(OptionDefaults program) {
    RenderSettings settings;
    if (program == OptionDefaults::rpict) return settings;
    settings.uncorrelated = true;
    settings.light.shadow_threshold = 0.03;
    settings.light.shadow_certainty = 0.75;
    settings.light.source_subdivision = 0.2;
    settings.light.redirections = 2;
    settings.light.ambient_accuracy = 0.1;
    settings.light.ambient_resolution = 256;
    settings.light.ambient_divisions = 1024;
    settings.light.ambient_super_samples = 512;
    settings.light.reflection_limit = -10;
    return settings;
}

bool parse_render_option(OptionWords& words, const LibraryPath& library, RenderSettings& settings) {
    for (const Entry& entry : kEntries) {
        if (parse_entry(entry, words, settings.light)) return true;
    }
    if (parse_ambient_selection(words, library, settings.light.ambient_surfaces)) return true;
    if (const auto value = words.toggle("-u", settings.uncorrelated)) {
        settings.uncorrelated = *value;
        return true;
    }
    if (const auto value = words.toggle("-w", settings.warnings)) {
        settings.warnings = *value;
        return true;
    }
    if (words.option() == "-af") {
        settings.ambient_file = words.text();
        return true;
    }
    refuse_foreign(words);
    return false;
}

void check_render_settings(const RenderSettings& settings) {
    if (settings.light.reflection_limit <= 0 && settings.light.weight_limit <= 0) {
        throw UsageError(
            "option -lw: must be positive when -lr is zero or negative (Russian roulette)");
    }
}

std::string option_line(const std::string& left, const std::string& description) {
    constexpr std::size_t kColumn = 32;
    constexpr std::size_t kTab = 8;
    std::string line = left;
    for (std::size_t column = left.size() / kTab * kTab; column < kColumn; column += kTab)
        line += '\t';
    if (left.size() >= kColumn) line += '\t';
    return line + "# " + description + '\n';
}

std::string option_text(const std::string& name, bool value) {
    return name + (value ? '+' : '-');
}
std::string option_text(const std::string& name, int value) {
    return name + ' ' + std::to_string(value);
}
std::string option_text(const std::string& name, double value) {
    return name + ' ' + formatted("%f", value);
}
std::string option_text(const std::string& name, const Rgb& value) {
    return name + ' ' + formatted("%f", value);
}

std::string describe_render_settings(const RenderSettings& settings) {
    std::string text =
        option_line(option_text("-u", settings.uncorrelated), "uncorrelated sampling");
    text += option_line(option_text("-w", settings.warnings), "warning messages");
    for (const Entry& entry : kEntries)
        text += option_line(text_of(entry, settings.light), entry.description);
    if (!settings.ambient_file.empty())
        text += option_line("-af " + settings.ambient_file, "ambient file");
    const AmbientSelection& selection = settings.light.ambient_surfaces;
    for (const std::string& name : selection.modifiers) {
        const bool include = selection.kind == AmbientSelection::Kind::include;
        text += option_line((include ? "-ai " : "-ae ") + name,
                            include ? "ambient include modifier" : "ambient exclude modifier");
    }
    return text;
}

std::vector<std::string> render_option_names() {
    std::vector<std::string> names{"-ae", "-ai", "-aE", "-aI", "-af", "-u", "-w"};
    for (const Entry& entry : kEntries) names.emplace_back(entry.name);
    return names;
}

}  // namespace lightwalk
