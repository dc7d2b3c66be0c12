#include "io/net/walk_reply.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <new>
#include <nlohmann/json.hpp>

namespace lightwalk {
namespace {

using Json = nlohmann::json;

std::string text_of(const Json& object) {
    return object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json to_json(const Vec3& v) {
    return Json::array({v.x, v.y, v.z});
}

Json to_json(const View& view) {
    return {{"type", std::string(1, view.type)},
            {"position", to_json(view.position)},
            {"direction", to_json(view.direction)},
            {"up", to_json(view.up)},
            {"horizontal", view.horizontal},
            {"vertical", view.vertical},
            {"fore", view.fore},
            {"aft", view.aft},
            {"shift", view.shift},
            {"lift", view.lift}};
}

Json to_json(const std::vector<NamedView>& views) {
    Json list = Json::array();
    for (const NamedView& named : views) {
        list.push_back({{"name", named.name}, {"view", to_json(named.view)}});
    }
    return list;
}

Json to_json(const DisplayRequest& request) {
    const DisplaySettings& display = request.settings;
    Json json{
        {"number", request.number},
        {"mode", display.false_colour ? "false" : "tone"},
        {"exposure", {{"auto", display.automatic}, {"ev", display.ev}}},
        {"human", display.human},
        {"scale", {{"low", display.low}, {"high", display.high}, {"log", display.logarithmic}}}};
    if (request.clean) json["clean"] = true;
    return json;
}

Json to_json(const SkyTime& time) {
    return {{"month", time.month}, {"day", time.day}, {"hour", time.hour}, {"sky", time.type}};
}

Json to_json(const TimePlace& place) {
    if (!place.refused.empty()) return {{"refused", place.refused}};
    return {{"time", to_json(place.time)},
            {"solar", place.solar},
            {"types", place.types},
            {"latitude", place.latitude},
            {"longitude", place.longitude}};
}

const char* word(WalkAmbient ambient) {
    switch (ambient) {
        case WalkAmbient::always:
            return "always";
        case WalkAmbient::off:
            return "off";
        default:
            return "rest";
    }
}

const char* word(WalkPhase phase) {
    switch (phase) {
        case WalkPhase::filling:
            return "filling";
        case WalkPhase::refining:
            return "refining";
        case WalkPhase::ambient:
            return "ambient";
        case WalkPhase::done:
            return "done";
        default:
            return "moving";
    }
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json();
}

/// A number, and how far its 95 % interval reaches to both sides under a name of its own.
void put(Json& object, const std::string& name, const MeanInterval& interval) {
    object[name] = interval.mean;
    object[name + "_95"] = interval.half_width;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace

std::string walk_text(const WelcomeReply& reply) {
    Json json{{"type", "welcome"},
              {"version", reply.version},
              {"you", reply.you},
              {"driver", reply.driver},
              {"scene", reply.scene},
              {"max_size", Json::array({reply.max_size.width, reply.max_size.height})},
              {"fps", reply.fps},
              {"views", to_json(reply.views)},
              {"view", reply.view ? to_json(*reply.view) : Json()},
              {"display", to_json(reply.display)},
              {"settings", {{"ambient", word(reply.settings.ambient)}}}};
    if (reply.denoises) json["denoises"] = true;
    return text_of(json);
}

std::string walk_text(const LoadingReply& reply) {
    return text_of({{"type", "loading"}, {"text", reply.text}, {"share", reply.share}});
}

std::string walk_text(const FailedReply& reply) {
    return text_of({{"type", "failed"}, {"messages", reply.messages}});
}

std::string walk_text(const LoadedReply& reply) {
    Json object{
        {"type", "loaded"}, {"views", to_json(reply.views)}, {"eye_height", reply.eye_height}};
    if (!reply.lights.empty()) object["lights"] = reply.lights;
    if (reply.time) object["time"] = to_json(*reply.time);
    if (reply.beside)
        object["beside"] = reply.beside->refused.empty() ? Json{{"scene", reply.beside->scene}}
                                                         : Json{{"refused", reply.beside->refused}};
    return text_of(object);
}

std::string walk_text(const LightsReply& reply) {
    Json levels = Json::array();
    for (const LightLevel& light : reply.lights.levels)
        levels.push_back({{"name", light.name},
                          {"level", light.level},
                          {"rgb", {light.color.r, light.color.g, light.color.b}}});
    return text_of({{"type", "lights"}, {"levels", levels}});
}

std::string walk_text(const TimeReply& reply) {
    Json object{{"type", "time"},
                {"time", reply.time ? to_json(*reply.time) : Json()},
                {"rise", or_null(reply.rise)},
                {"set", or_null(reply.set)},
                {"altitude", reply.altitude},
                {"azimuth", reply.azimuth}};
    if (!reply.problem.empty()) object["problem"] = reply.problem;
    return text_of(object);
}

std::string walk_text(const RoleReply& reply) {
    return text_of({{"type", "role"},
                    {"driver", reply.driver},
                    {"driver_id", or_null(reply.driver_id)},
                    {"clients", reply.clients}});
}

std::string walk_text(const PickedReply& reply) {
    Json object{{"type", "picked"},
                {"id", reply.id},
                {"hit", reply.hit},
                {"distance", reply.distance},
                {"position", to_json(reply.position)},
                {"normal", to_json(reply.normal)},
                {"material", reply.material},
                {"surface", reply.surface}};
    put(object, "luminance", reply.luminance);
    put(object, "illuminance", reply.illuminance);
    return text_of(object);
}

std::string walk_text(const MeanReply& reply) {
    Json object{{"type", "mean"}, {"id", reply.id}, {"pixels", reply.pixels}};
    put(object, "luminance", reply.luminance);
    return text_of(object);
}

std::string walk_text(const ProbesReply& reply) {
    Json list = Json::array();
    for (const ProbeValue& probe : reply.probes) {
        Json object{{"id", probe.id}};
        put(object, "illuminance", probe.illuminance);
        put(object, "luminance", probe.luminance);
        list.push_back(std::move(object));
    }
    return text_of({{"type", "probes"}, {"probes", list}, {"settled", reply.settled}});
}

std::string walk_text(const GlareReply& reply) {
    Json list = Json::array();
    for (const GlareOutline& source : reply.sources) {
        Json outline = Json::array();
        for (const auto& [x, y] : source.outline) outline.push_back(Json::array({x, y}));
        list.push_back({{"outline", outline},
                        {"luminance", source.luminance},
                        {"solid_angle", source.solid_angle},
                        {"position_index", source.position_index}});
    }
    Json object{{"type", "glare"}, {"id", reply.id}, {"done", reply.done}, {"sources", list}};
    put(object, "dgp", reply.dgp);
    return text_of(object);
}

PlanReply plan_reply(const FloorPlan& plan) {
    PlanReply reply{0, plan.width, plan.height, plan.left, plan.bottom, plan.cell, plan.z, {}};
    auto size = compressBound(static_cast<uLong>(plan.cells.size()));
    std::string deflated(size, '\0');
    if (compress(reinterpret_cast<Bytef*>(deflated.data()), &size, plan.cells.data(),
                 static_cast<uLong>(plan.cells.size())) != Z_OK)
        throw std::bad_alloc();
    reply.cells = base64(std::string_view(deflated).substr(0, size));
    return reply;
}

std::string walk_text(const PlanReply& reply) {
    return text_of({{"type", "plan"},
                    {"id", reply.id},
                    {"width", reply.width},
                    {"height", reply.height},
                    {"origin", Json::array({reply.left, reply.bottom})},
                    {"cell", reply.cell},
                    {"z", reply.z},
                    {"cells", reply.cells}});
}

std::string walk_text(const IsoluxReply& reply) {
    Json object{{"type", "isolux"}, {"id", reply.id}, {"done", reply.done}};
    object["columns"] = reply.columns;
    object["rows"] = reply.rows;
    if (reply.columns == 0) return text_of(object);
    object["origin"] = to_json(reply.origin);
    object["across"] = to_json(reply.across);
    object["along"] = to_json(reply.along);
    object["normal"] = to_json(reply.normal);
    std::string bytes;
    for (const float value : reply.values)
        for (unsigned shift = 0; shift < 32; shift += 8)
            bytes += static_cast<char>(std::bit_cast<std::uint32_t>(value) >> shift & 255);
    object["values"] = base64(bytes);
    if (!reply.figures) return text_of(object);
    put(object, "mean", reply.figures->mean);
    put(object, "least", reply.figures->least);
    put(object, "most", reply.figures->most);
    return text_of(object);
}

std::string walk_text(const StateReply& reply) {
    return text_of({{"type", "state"},
                    {"fps", reply.fps},
                    {"reuse", reply.reuse},
                    {"inferred", reply.inferred},
                    {"guessed", reply.guessed},
                    {"rays_per_second", reply.rays_per_second},
                    {"phase", word(reply.phase)},
                    {"share", reply.share},
                    {"ranks", reply.ranks},
                    {"threads", reply.threads},
                    {"points", reply.points}});
}

std::string walk_text(const ViewReply& reply) {
    Json object{{"type", "view"}, {"view", to_json(reply.view)}};
    if (reply.seen) object["seen"] = to_json(*reply.seen);
    return text_of(object);
}

std::string walk_text(const DisplayReply& reply) {
    Json json = to_json(reply.display);
    json["type"] = "display";
    return text_of(json);
}

std::string walk_text(const RefusedReply& reply) {
    Json object{{"type", "refused"}, {"text", reply.text}};
    if (reply.id) object["id"] = *reply.id;
    if (reply.view) object["view"] = *reply.view;
    return text_of(object);
}

std::string walk_text(const FollowedReply& reply) {
    Json object{{"type", "followed"},           {"files", reply.files},
                {"materials", reply.materials}, {"sources", reply.sources},
                {"surfaces", reply.surfaces},   {"kept", reply.kept},
                {"problems", reply.problems}};
    if (!reply.lights.empty()) object["lights"] = reply.lights;
    if (reply.time) object["time"] = to_json(*reply.time);
    return text_of(object);
}

std::string walk_text(const ByeReply& reply) {
    return text_of({{"type", "bye"}, {"reason", reply.reason}});
}

std::string walk_text(const InterruptedReply& reply) {
    return text_of({{"type", "interrupted"}, {"text", reply.text}});
}

}  // namespace lightwalk
