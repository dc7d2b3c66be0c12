#include "io/net/walk_request.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"

namespace lightwalk {
namespace {

using Json = nlohmann::json;

constexpr int kDeepest = 8;          // a probe's position is at 4
constexpr double kFarthest = 1e9;    // [m]: beyond it a double resolves no pixels
constexpr double kBrightest = 1e12;  // [cd/m²]: a thousand times the sun's
constexpr double kMostStops = 40;    // limit of the exposure, up and down
constexpr double kShortestNormal = 1e-6;

/// A number that stands where it should, but has no value, or one beyond what can be used.
class UnusableNumber : public InputError {
  public:
    using InputError::InputError;
};

[[noreturn]] void refuse(const std::string& name, const char* expected) {
    throw InputError("\"" + name + "\": expected " + expected);
}

const Json& field(const Json& object, const char* name) {
    if (!object.is_object()) throw InputError(std::string("expected an object with ") + name);
    const auto found = object.find(name);
    if (found == object.end()) throw InputError(std::string("\"") + name + "\" is missing");
    return *found;
}

double number(const Json& value, const char* name, double low, double high) {
    if (value.is_null())  // as which JavaScript writes numbers that are not finite
        throw UnusableNumber("\"" + std::string(name) + "\": expected a finite number");
    if (!value.is_number()) refuse(name, "a number");
    const double x = value.get<double>();
    if (!(x >= low && x <= high))
        throw UnusableNumber("\"" + std::string(name) + "\": expected a number within its range");
    return x;
}

double number(const Json& object, double low, double high, const char* name) {
    return number(field(object, name), name, low, high);
}

std::uint32_t identity(const Json& object, const char* name) {
    const double x = number(object, 0, 4294967295.0, name);
    if (x != std::floor(x)) refuse(name, "a whole number");
    return static_cast<std::uint32_t>(x);
}

bool truth(const Json& object, const char* name) {
    const Json& value = field(object, name);
    if (!value.is_boolean()) refuse(name, "true or false");
    return value.get<bool>();
}

const std::string& words(const Json& object, const char* name) {
    const Json& value = field(object, name);
    if (!value.is_string()) refuse(name, "a text");
    return value.get_ref<const std::string&>();
}

const Json& list(const Json& object, const char* name, std::size_t least, std::size_t most) {
    const Json& value = field(object, name);
    if (!value.is_array() || value.size() < least || value.size() > most) {
        refuse(name, "a list of the right length");
    }
    return value;
}

Vec3 vector(const Json& object, const char* name) {
    const Json& value = list(object, name, 3, 3);
    return {number(value[0], name, -kFarthest, kFarthest),
            number(value[1], name, -kFarthest, kFarthest),
            number(value[2], name, -kFarthest, kFarthest)};
}

double optional_number(const Json& object, const char* name) {
    return object.contains(name) ? number(object, -kFarthest, kFarthest, name) : 0;
}

View read_any_view(const Json& object) {
    View view;
    const std::string& type = words(object, "type");
    if (type.size() != 1) refuse("type", "one of the letters v l c h a s");
    view.type = type.front();
    view.position = vector(object, "position");
    view.direction = vector(object, "direction");
    view.up = vector(object, "up");
    view.horizontal = number(object, 0, kFarthest, "horizontal");
    view.vertical = number(object, 0, kFarthest, "vertical");
    view.fore = optional_number(object, "fore");
    view.aft = optional_number(object, "aft");
    view.shift = optional_number(object, "shift");
    view.lift = optional_number(object, "lift");
    return view;
}

/// @param id  of the request, for the answer to a view that cannot be drawn
View read_view(const Json& object, std::uint32_t id, UndrawableView::Kind kind) {
    View view;
    try {
        view = read_any_view(object);
    } catch (const UnusableNumber& error) {
        throw UndrawableView(error.what(), id, kind);
    }
    if (const std::optional<std::string> wrong = Camera::problem(view))
        throw UndrawableView(*wrong, id, kind);
    return view;
}

int window_side(const Json& object, const char* name) {
    const double x = number(object, 1, kLargestWalkSize, name);
    if (x != std::floor(x)) refuse(name, "a whole number");
    return static_cast<int>(x);
}

/// Shrink to the limit; the larger side decides, the other keeps its proportion.
void shrink(ViewRequest& request, WalkSizeLimit limit) {
    const double scale =
        std::min({1.0, double(limit.width) / request.width, double(limit.height) / request.height});
    if (scale == 1) return;
    const auto shrunk = [&](int side, int most) {
        return std::clamp(static_cast<int>(std::lround(side * scale)), 1, std::max(1, most));
    };
    request.width = shrunk(request.width, limit.width);
    request.height = shrunk(request.height, limit.height);
}

HelloRequest read_hello(const Json& object) {
    const std::string& session = words(object, "session");
    const bool hex = session.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
    if (!hex || session.size() < 16 || session.size() > 64)
        refuse("session", "16 to 64 hex digits");
    const auto wants = [&](const char* name) {
        return object.contains(name) && truth(object, name);
    };
    return {session, wants("depth"), wants("luminance"), wants("beside")};
}

ViewRequest read_view_request(const Json& object, WalkSizeLimit limit) {
    ViewRequest request;
    request.id = identity(object, "id");
    request.view = read_view(field(object, "view"), request.id, UndrawableView::Kind::view);
    request.width = window_side(object, "width");
    request.height = window_side(object, "height");
    request.moving = truth(object, "moving");
    request.walk = truth(object, "walk");
    if (object.contains("seen"))
        request.seen = read_view(object["seen"], request.id, UndrawableView::Kind::view);
    shrink(request, limit);
    return request;
}

DisplayRequest read_display(const Json& object) {
    DisplayRequest request;
    DisplaySettings& display = request.settings;
    const std::string& mode = words(object, "mode");
    if (mode != "tone" && mode != "false") refuse("mode", "\"tone\" or \"false\"");
    display.false_colour = mode == "false";
    const Json& exposure = field(object, "exposure");
    display.automatic = truth(exposure, "auto");
    display.ev = number(exposure, -kMostStops, kMostStops, "ev");
    display.human = truth(object, "human");
    const Json& scale = field(object, "scale");
    display.low = number(scale, 0, kBrightest, "low");
    display.high = number(scale, 0, kBrightest, "high");
    display.logarithmic = truth(scale, "log");
    if (!(display.low < display.high)) refuse("scale", "low below high");
    if (display.logarithmic && !(display.low > 0))
        refuse("low", "more than 0 on a logarithmic scale");
    if (object.contains("number"))
        request.number = static_cast<std::uint8_t>(number(object, 0, 255, "number"));
    if (object.contains("clean")) request.clean = truth(object, "clean");
    return request;
}

SettingsRequest read_settings(const Json& object) {
    const std::string& ambient = words(object, "ambient");
    if (ambient == "rest") return {WalkAmbient::rest};
    if (ambient == "always") return {WalkAmbient::always};
    if (ambient == "off") return {WalkAmbient::off};
    refuse("ambient", "\"rest\", \"always\" or \"off\"");
}

LightsRequest read_lights(const Json& object) {
    constexpr double kMostLevel = 100;
    constexpr std::size_t kLongestName = 256;
    LightsRequest request;
    for (const Json& one : list(object, "levels", 0, kMostLightLevels)) {
        LightLevel light{words(one, "name"), number(one, 0, kMostLevel, "level"), {}};
        if (light.name.size() > kLongestName) refuse("name", "at most 256 bytes");
        const Json& rgb = list(one, "rgb", 3, 3);
        for (std::size_t k = 0; k < 3; ++k)
            light.color[k] = static_cast<float>(number(rgb[k], "rgb", 0, kMostLevel));
        if (std::ranges::find(request.levels, light.name, &LightLevel::name) !=
            request.levels.end())
            refuse("levels", "each name once");
        request.levels.push_back(std::move(light));
    }
    return request;
}

int whole_number(const Json& object, int low, int high, const char* name) {
    const double x = number(object, low, high, name);
    if (x != std::floor(x)) refuse(name, "a whole number");
    return static_cast<int>(x);
}

TimeRequest read_time(const Json& object) {
    constexpr double kDay = 24;
    const Json& wanted = field(object, "time");
    if (wanted.is_null()) return {};
    SkyTime time{whole_number(wanted, 1, 12, "month"), whole_number(wanted, 1, 31, "day"),
                 number(wanted, 0, kDay, "hour"), words(wanted, "sky")};
    if (!(time.hour < kDay)) refuse("hour", "less than 24");
    if (!time.type.empty() && std::ranges::find(kSkyTypes, time.type) == kSkyTypes.end())
        refuse("sky", "one of +s -s +i -i -c -u");
    return {std::move(time)};
}

PickRequest read_pick(const Json& object) {
    PickRequest request{identity(object, "id"), number(object, 0, 1, "x"),
                        number(object, 0, 1, "y"), std::nullopt};
    if (object.contains("view"))
        request.view = read_view(object["view"], request.id, UndrawableView::Kind::question);
    return request;
}

MeanRequest read_rectangle(const Json& object) {
    const Json& rect = list(object, "rect", 4, 4);
    const auto side = [&](std::size_t k) { return number(rect[k], "rect", 0, 1); };
    const MeanRequest request{identity(object, "id"), side(0), side(1), side(2), side(3)};
    if (!(request.x0 < request.x1 && request.y0 < request.y1)) {
        refuse("rect", "left, bottom, right, top with left < right and bottom < top");
    }
    return request;
}

/// A unit vector.
Vec3 read_normal(const Json& object) {
    const Vec3 normal = vector(object, "normal");
    if (!(length(normal) > kShortestNormal)) refuse("normal", "a direction");
    return normalize(normal);
}

ProbesRequest read_probes(const Json& object) {
    ProbesRequest request;
    for (const Json& probe : list(object, "probes", 0, kMostProbes)) {
        request.probes.push_back(
            {identity(probe, "id"), vector(probe, "position"), read_normal(probe)});
    }
    return request;
}

IsoluxRequest read_isolux(const Json& object) {
    IsoluxRequest request{identity(object, "id"), vector(object, "position"), std::nullopt, 0};
    if (!object.contains("height"))
        request.normal = read_normal(object);
    else if (object.contains("normal"))
        refuse("height", "no normal beside it");
    else
        request.height = number(object, 0, kFarthest, "height");
    return request;
}

MaterialRequest read_material(const Json& object) {
    const PickRequest pick = read_pick(object);
    return {pick.id, pick.x, pick.y, pick.view};
}

const std::string& short_words(const Json& object, const char* name, std::size_t longest) {
    const std::string& text = words(object, name);
    if (text.empty() || text.size() > longest) refuse(name, "a text that is not too long");
    return text;
}

MaterialEdit read_edit(const Json& object) {
    constexpr std::size_t kLongestMaterial = 256, kLongestKind = 32, kMostReals = 16;
    MaterialEdit edit{short_words(object, "name", kLongestMaterial),
                      identity(object, "definition"),
                      short_words(object, "kind", kLongestKind),
                      {}};
    for (const Json& real : list(object, "reals", 1, kMostReals))
        edit.reals.push_back(number(real, "reals", -kBrightest, kBrightest));
    return edit;
}

EditsRequest read_edits(const Json& object) {
    EditsRequest request{identity(object, "id"), {}};
    for (const Json& one : list(object, "materials", 0, kMostEdits)) {
        MaterialEdit edit = read_edit(one);
        const auto same = [&](const MaterialEdit& other) {
            return other.name == edit.name && other.definition == edit.definition;
        };
        if (std::ranges::any_of(request.materials, same))
            refuse("materials", "each definition once");
        request.materials.push_back(std::move(edit));
    }
    return request;
}

/// Parse without building what nests too deep.
Json parse_json(std::string_view text) {
    const auto watch = [](int depth, Json::parse_event_t /*event*/, Json& /*parsed*/) {
        if (depth > kDeepest) throw InputError("JSON is nested too deep");
        return true;
    };
    try {
        return Json::parse(text.begin(), text.end(), watch);
    } catch (const Json::exception&) {  // its text quotes the input
        throw InputError("not a JSON text");
    }
}

}  // namespace

WalkRequest parse_walk_request(std::string_view text, WalkSizeLimit limit) {
    if (text.size() > kLargestWalkRequest) throw InputError("message is longer than 64 KB");
    const Json object = parse_json(text);
    const std::string& type = words(object, "type");
    if (type == "hello") return read_hello(object);
    if (type == "view") return read_view_request(object, limit);
    if (type == "ack") return AckRequest{identity(object, "frame")};
    if (type == "display") return read_display(object);
    if (type == "settings") return read_settings(object);
    if (type == "lights") return read_lights(object);
    if (type == "time") return read_time(object);
    if (type == "pick") return read_pick(object);
    if (type == "rectangle") return read_rectangle(object);
    if (type == "probes") return read_probes(object);
    if (type == "glare") return GlareRequest{identity(object, "id")};
    if (type == "plan") return PlanRequest{identity(object, "id")};
    if (type == "isolux") return read_isolux(object);
    if (type == "material") return read_material(object);
    if (type == "edits") return read_edits(object);
    if (type == "difference") return DifferenceRequest{truth(object, "shown")};
    if (type == "take") return TakeRequest{};
    if (type == "hand") return HandRequest{identity(object, "to")};
    throw InputError("unknown type of message \"" + type.substr(0, 32) + "\"");
}

}  // namespace lightwalk
