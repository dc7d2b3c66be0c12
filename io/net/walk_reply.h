#pragma once
// The text messages from server to browser, as values and as JSON in the format of
// io/net/README.md. Numbers that are not finite become null. Names in scenes may be any bytes;
// those that are not UTF-8 become U+FFFD.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/math/student_t.h"
#include "core/plan/floor_plan.h"
#include "io/net/walk_request.h"

namespace lightwalk {

struct NamedView {
    std::string name;
    View view;
};
/// `welcome`, the answer to HelloRequest.
struct WelcomeReply {
    std::string version;
    std::uint32_t you = 0;
    bool driver = false;
    std::string scene;
    WalkSizeLimit max_size;
    double fps = 30;
    std::vector<NamedView> views;
    std::optional<View> view;  ///< where this client was last, if it was here before
    DisplayRequest display;
    SettingsRequest settings;
    bool denoises = false;  ///< whether it can show denoised pictures
};
/// `loading`: the scene is being read.
struct LoadingReply {
    std::string text;
    double share = 0;  ///< progress, 0 to 1
};
/// `failed`: the scene cannot be read.
struct FailedReply {
    std::vector<std::string> messages;  ///< "file:line: ..."
};
/// Where and when a scene's sky is seen.
struct TimePlace {
    SkyTime time;
    bool solar = false;                  ///< hours are of local solar time
    bool types = false;                  ///< the sky may be of other kinds
    double latitude = 0, longitude = 0;  ///< to the north, to the east [deg]
    std::string refused;                 ///< why the time cannot be changed; "": it can
};
/// Another scene, or state of the scene, beside it.
struct BesidePlace {
    std::string scene;    ///< its files; "": it begins as what the walk shows
    std::string refused;  ///< why there can be none; "": there can
};
struct LoadedReply {
    std::vector<NamedView> views;
    double eye_height = 1.6;          ///< [m]
    std::vector<std::string> lights;  ///< names of the light groups that may be dimmed; empty: none
    std::optional<TimePlace> time = std::nullopt;      ///< nothing: no generator has written a sky
    std::optional<BesidePlace> beside = std::nullopt;  ///< nothing: this is beside another one
};
/// `lights`: to watchers and newcomers, what the driver has set.
struct LightsReply {
    LightsRequest lights;
};
/// `time`: what is shown from now on.
struct TimeReply {
    std::optional<SkyTime> time;       ///< nothing: that of the scene's files
    std::optional<double> rise, set;   ///< of the sun; neither: it is up, or down, all day [h]
    double altitude = 0, azimuth = 0;  ///< of the sun; from the south to the west [deg]
    std::string problem;               ///< why it is not what was asked for; "": it is
};
struct RoleReply {
    bool driver = false;
    std::optional<std::uint32_t> driver_id;
    std::vector<std::uint32_t> clients;
};
struct PickedReply {
    std::uint32_t id = 0;
    bool hit = false;
    MeanInterval luminance = {};    ///< [cd/m²]
    MeanInterval illuminance = {};  ///< [lx]
    double distance = 0;            ///< [m]
    Vec3 position, normal;
    std::string material, surface;
};
struct MeanReply {
    std::uint32_t id = 0;
    MeanInterval luminance = {};  ///< [cd/m²]
    std::uint64_t pixels = 0;
};
struct ProbeValue {
    std::uint32_t id = 0;
    MeanInterval illuminance = {};  ///< [lx]
    MeanInterval luminance = {};    ///< [cd/m²]
};
struct ProbesReply {
    std::vector<ProbeValue> probes;
    double settled = 0;  ///< share of their samples that are traced; 1: values are final
};
struct GlareOutline {
    std::vector<std::pair<double, double>> outline;  ///< x, y as shares of the picture, 0 to 1
    double luminance = 0;                            ///< [cd/m²]
    double solid_angle = 0;                          ///< [sr]
    double position_index = 1;
};
struct GlareReply {
    std::uint32_t id = 0;
    double done = 0;  ///< progress, 0 to 1; dgp and sources are valid at 1
    MeanInterval dgp = {};
    std::vector<GlareOutline> sources;
};
struct PlanReply {
    std::uint32_t id = 0;
    int width = 0, height = 0;    ///< [cells]; 0 where there is nothing to draw
    double left = 0, bottom = 0;  ///< x and y of its lower left corner [m]
    double cell = 0;              ///< side of a cell [m]
    double z = 0;                 ///< of the section [m]
    std::string cells;            ///< see plan_reply
};
/// Of the points of a plane: their mean, and what is measured at the darkest and the brightest one.
struct IsoluxFigures {
    MeanInterval mean = {}, least = {}, most = {};  ///< [lx]
};
struct IsoluxReply {
    std::uint32_t id = 0;
    double done = 0;                 ///< progress, 0 to 1
    int columns = 0, rows = 0;       ///< 0: no values yet, or where it is done no such plane
    Vec3 origin = {};                ///< the first point [m]
    Vec3 across = {}, along = {};    ///< to the next point of a row, and to the next row [m]
    Vec3 normal = {};                ///< unit, on the side where light is measured
    std::vector<float> values = {};  ///< by rows [lx]; not finite: the point does not count
    std::optional<IsoluxFigures> figures = std::nullopt;  ///< once it is done
};
/// The answer but for its number: the plan's cells as bytes, in a zlib stream (RFC 1950), in
/// base64. Throws std::bad_alloc where zlib finds no memory.
[[nodiscard]] PlanReply plan_reply(const FloorPlan& plan);
struct StateReply {
    double fps = 0;
    double reuse = 0;     ///< share of the pixels that points of earlier frames answered
    double inferred = 0;  ///< share of the pixels with colours from around them on their surface
    double guessed = 0;   ///< share of the pixels that were filled from whatever is around them
    double rays_per_second = 0;
    WalkPhase phase = WalkPhase::moving;
    double share = 0;  ///< progress of the phase, 0 to 1
    int ranks = 1, threads = 1;
    std::uint64_t points = 0;
};
/// `view`, to watchers: the view of the frames that follow.
struct ViewReply {
    View view;
    std::optional<View> seen;  ///< what the driver's screen shows; nothing: `view`
    friend bool operator==(const ViewReply&, const ViewReply&) = default;
};
struct DisplayReply {
    DisplayRequest display;
};
/// `refused`: a request cannot be answered.
struct RefusedReply {
    std::string text;
    std::optional<std::uint32_t> id;                   ///< of the question
    std::optional<std::uint32_t> view = std::nullopt;  ///< the id of one that cannot be drawn
};
/// `followed`: files of the scene were edited, and what became of it.
struct FollowedReply {
    std::vector<std::string> files = {};                   ///< that are others, without folders
    std::size_t materials = 0, sources = 0, surfaces = 0;  ///< that are others
    double kept = 0;  ///< share of the points of the frames before that are kept
    /// "file:line: ...", why all is as it was; empty: it is as the files have it.
    std::vector<std::string> problems = {};
    // As LoadedReply has them, where there is no problem.
    std::vector<std::string> lights = {};
    std::optional<TimePlace> time = std::nullopt;
};
/// `bye`, the last message before the server closes the connection.
struct ByeReply {
    std::string reason;
};
/// `interrupted`: those who draw are lost, or end.
struct InterruptedReply {
    std::string text;
};

[[nodiscard]] std::string walk_text(const WelcomeReply& reply);
[[nodiscard]] std::string walk_text(const LoadingReply& reply);
[[nodiscard]] std::string walk_text(const FailedReply& reply);
[[nodiscard]] std::string walk_text(const LoadedReply& reply);
[[nodiscard]] std::string walk_text(const LightsReply& reply);
[[nodiscard]] std::string walk_text(const TimeReply& reply);
[[nodiscard]] std::string walk_text(const RoleReply& reply);
[[nodiscard]] std::string walk_text(const PickedReply& reply);
[[nodiscard]] std::string walk_text(const MeanReply& reply);
[[nodiscard]] std::string walk_text(const ProbesReply& reply);
[[nodiscard]] std::string walk_text(const GlareReply& reply);
[[nodiscard]] std::string walk_text(const PlanReply& reply);
[[nodiscard]] std::string walk_text(const IsoluxReply& reply);
[[nodiscard]] std::string walk_text(const StateReply& reply);
[[nodiscard]] std::string walk_text(const ViewReply& reply);
[[nodiscard]] std::string walk_text(const DisplayReply& reply);
[[nodiscard]] std::string walk_text(const RefusedReply& reply);
[[nodiscard]] std::string walk_text(const FollowedReply& reply);
[[nodiscard]] std::string walk_text(const ByeReply& reply);
[[nodiscard]] std::string walk_text(const InterruptedReply& reply);

}  // namespace lightwalk
