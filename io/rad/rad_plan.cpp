#include "io/rad/rad_plan.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>

#include "core/model/transform_args.h"
#include "io/rad/rad_views.h"

namespace lightwalk {
namespace {

constexpr double kMostPixelsOfASide = 1 << 20;

[[noreturn]] void refuse(const RadValue& value, const std::string& expected) {
    throw InputError(value.where, "expected " + expected + ", found \"" + value.text + '"');
}

/// Whether `text` is a beginning of `word`, in letters of any case.
bool begins(std::string_view word, std::string_view text) {
    const auto lower = [](char c) {
        return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    };
    return !text.empty() && text.size() <= word.size() &&
           std::equal(text.begin(), text.end(), word.begin(),
                      [&](char a, char b) { return lower(a) == lower(b); });
}

RadLevel level_of(const RadFile& file, std::string_view variable, RadLevel other) {
    const RadValue* const value = file.value(variable);
    if (value == nullptr) return other;
    if (begins("low", value->text)) return RadLevel::low;
    if (begins("medium", value->text)) return RadLevel::medium;
    if (begins("high", value->text)) return RadLevel::high;
    refuse(*value, "Low, Medium or High");
}

bool truth_of(const RadFile& file, std::string_view variable) {
    const RadValue* const value = file.value(variable);
    if (value == nullptr || begins("false", value->text)) return false;
    if (begins("true", value->text)) return true;
    refuse(*value, "True or False");
}

int bounces_of(const RadFile& file) {
    const RadValue* const value = file.value("INDIRECT");
    constexpr long kMost = 1000;
    long number = 0;
    if (value != nullptr && (!parse_integer(value->text, number) || std::abs(number) > kMost))
        refuse(*value, "a number of bounces");
    return static_cast<int>(number);
}

std::optional<double> exposure_of(const RadFile& file) {
    const RadValue* const value = file.value("EXPOSURE");
    if (value == nullptr) return std::nullopt;
    double number = 0;
    const bool stops = value->text[0] == '+' || value->text[0] == '-';
    const bool good = parse_real(value->text, number);
    const double factor = stops ? std::exp2(number) : number;
    if (!good || !std::isfinite(factor) || factor <= 0)
        refuse(*value, "a positive factor, or stops with + or - before them");
    return factor;
}

/// Numbers at the beginning of `words`, but for the first `skip`.
std::vector<double> numbers_of(const std::vector<std::string>& words, std::size_t skip) {
    std::vector<double> numbers;
    for (std::size_t i = skip; i < words.size(); ++i) {
        double number = 0;
        if (!parse_real(words[i], number) || !std::isfinite(number)) break;
        numbers.push_back(number);
    }
    return numbers;
}

std::optional<RadZone> zone_of(const RadFile& file) {
    const RadValue* const value = file.value("ZONE");
    if (value == nullptr) return std::nullopt;
    const std::vector<std::string> words = words_of(*value);
    const char kind = words.empty() || words[0].empty() ? ' ' : words[0][0];
    const bool interior = kind == 'I' || kind == 'i', exterior = kind == 'E' || kind == 'e';
    const std::vector<double> n = numbers_of(words, 1);
    constexpr std::size_t kBox = 6;
    if ((!interior && !exterior) || n.size() < kBox || n[0] >= n[1] || n[2] >= n[3] || n[4] >= n[5])
        refuse(*value, "Interior or Exterior, then xmin xmax ymin ymax zmin zmax");
    return RadZone{exterior, {n[0], n[2], n[4]}, {n[1], n[3], n[5]}};
}

std::optional<Vec3> up_of(const RadFile& file) {
    const RadValue* const value = file.value("UP");
    if (value == nullptr) return std::nullopt;
    std::string_view axis = value->text;
    const double sign = axis[0] == '-' ? -1 : 1;
    if (axis[0] == '-' || axis[0] == '+') axis.remove_prefix(1);
    if (axis == "X" || axis == "x") return Vec3{sign, 0, 0};
    if (axis == "Y" || axis == "y") return Vec3{0, sign, 0};
    if (axis == "Z" || axis == "z") return Vec3{0, 0, sign};
    refuse(*value, "an axis: X, Y or Z, or -X, -Y or -Z");
}

void take_resolution(const RadFile& file, RadPlan& plan) {
    const RadValue* const value = file.value("RESOLUTION");
    if (value == nullptr) return;
    const std::vector<std::string> words = words_of(*value);
    const std::vector<double> n = numbers_of(words, 0);
    const auto pixels = [](double x) { return x >= 1 && x <= kMostPixelsOfASide; };
    const bool good = !n.empty() && n.size() == words.size() && n.size() <= 3 && pixels(n[0]) &&
                      (n.size() < 2 || pixels(n[1])) && (n.size() < 3 || n[2] >= 0);
    if (!good)
        refuse(*value, "a width, or width and height, and the aspect of a pixel behind them");
    plan.width = static_cast<int>(n[0]);
    plan.height = static_cast<int>(n.size() > 1 ? n[1] : n[0]);
    if (n.size() > 2) plan.pixel_aspect = n[2];
}

/// "r.rif" without its ending.
std::string root_of(const std::string& name) {
    const std::size_t dot = name.rfind('.');
    const bool ends = dot != std::string::npos && name.find('/', dot) == std::string::npos;
    return ends ? name.substr(0, dot) : name;
}

void take_scene(const RadFile& file, RadPlan& plan) {
    for (const char* variable : {"materials", "scene", "illum"}) {
        for (const RadValue& value : file.values(variable))
            for (std::string& word : words_of(value))
                plan.scene.push_back({std::move(word), value.where});
    }
    const RadValue* const octree = file.value("OCTREE");
    plan.octree = octree != nullptr ? octree->text : root_of(file.name()) + ".oct";
    for (const RadValue& value : file.values("oconv")) {
        const std::vector<std::string> words = words_of(value);
        for (std::size_t i = 0; i + 1 < words.size(); ++i)
            if (words[i] == "-i") plan.base = {words[i + 1]};
    }
}

void take_views(const RadFile& file, RadPlan& plan) {
    for (const RadValue& value : file.values("view"))
        plan.views.push_back(rad_view(words_of(value), value.where));
    if (plan.views.empty()) plan.views.push_back(rad_view({"X"}, {file.name(), 0}));
}

/// "file: A= B=: ", for those of these variables that are assigned; "": none is.
std::string told(const RadFile& file, std::initializer_list<const char*> variables) {
    std::string text;
    for (const char* variable : variables) {
        if (file.value(variable) == nullptr) continue;
        text += (text.empty() ? file.name() + ": " : " ") + variable + '=';
    }
    return text.empty() ? text : text + ": ";
}

void take_notices(const RadFile& file, RadPlan& plan) {
    plan.notices = file.warnings();
    const std::string illum = told(file, {"illum", "mkillum"});
    if (!illum.empty())
        plan.notices.push_back(illum +
                               "mkillum is not run, the files of illum= are read as they are");
    const std::string unused =
        told(file, {"EYESEP", "OPTFILE", "PICTURE", "RAWFILE", "REPORT", "ZFILE", "pfilt", "rvu"});
    if (!unused.empty())
        plan.picture_notices.push_back(unused +
                                       "not heeded, see --help for options in their place");
}

}  // namespace

RadPlan rad_plan(const RadFile& file) {
    RadPlan plan;
    plan.name = file.name();
    take_scene(file, plan);
    plan.zone = zone_of(file);
    plan.quality = level_of(file, "QUALITY", plan.quality);
    plan.detail = level_of(file, "DETAIL", plan.detail);
    plan.variability = level_of(file, "VARIABILITY", plan.variability);
    plan.penumbras = truth_of(file, "PENUMBRAS");
    plan.indirect = bounces_of(file);
    plan.exposure = exposure_of(file);
    if (const RadValue* const name = file.value("AMBFILE")) plan.ambient_file = name->text;
    take_resolution(file, plan);
    plan.up = up_of(file);
    plan.render = file.values("render");
    plan.rpict = file.values("rpict");
    take_views(file, plan);
    take_notices(file, plan);
    return plan;
}

std::vector<std::string> rad_scene_files(RadPlan& plan, FileSource& files) {
    std::vector<std::string> names = plan.base;
    const RadValue* missing = nullptr;
    for (const RadValue& file : plan.scene) {
        names.push_back(file.text);
        const bool is_command = file.text.starts_with('!');
        if (missing == nullptr && !is_command && !files.readable(file.text)) missing = &file;
    }
    if (!plan.scene.empty() && missing == nullptr) return names;
    if (files.readable(plan.octree)) {
        if (missing != nullptr)
            plan.notices.push_back(to_prefix(missing->where) + missing->text +
                                   " cannot be read, the octree " + plan.octree + " is taken");
        return {plan.octree};
    }
    if (missing != nullptr)
        throw InputError(missing->where, "cannot read \"" + missing->text +
                                             "\"; names are relative to the working directory");
    throw InputError({plan.name, 0},
                     "names no scene: expected scene= FILES, or an OCTREE= that is there");
}

}  // namespace lightwalk
