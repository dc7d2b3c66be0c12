#pragma once
// The text messages from browser to server, as values. Their format is in io/net/README.md.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/math/rgb.h"
#include "core/view/view.h"
#include "core/view/walk_state.h"
#include "io/generators/sky_command.h"
#include "io/picture/display.h"

namespace lightwalk {

inline constexpr std::size_t kLargestWalkRequest =
    std::size_t{64} * 1024;                    ///< size of a message [bytes]
inline constexpr int kLargestWalkSize = 4096;  ///< width and height of a picture [pixels]
inline constexpr std::size_t kMostProbes = 64;
inline constexpr std::size_t kMostLightLevels = 64;
inline constexpr std::size_t kMostEdits = 64;

struct HelloRequest {
    std::string session;     ///< 16 to 64 hex digits
    bool depth = false;      ///< frames shall have the depth of their pixels, see depth_patches.h
    bool luminance = false;  ///< and their luminance, see luminance_plane.h
    bool beside = false;     ///< who drives wants the scene beside the walk's, by this connection
};
/// `view`: the view that the page wants to see.
struct ViewRequest {
    std::uint32_t id = 0;
    View view;                  ///< a valid view (Camera accepts it), no number beyond 1e9
    int width = 0, height = 0;  ///< [pixels], within the limits of parse_walk_request
    bool moving = false;        ///< more views will follow soon
    bool walk = false;          ///< keep the eye at a constant height above the surface below it
    std::optional<View> seen;   ///< what the page's screen shows meanwhile; nothing: `view`
};
/// `ack`: a frame has been drawn on the screen.
struct AckRequest {
    std::uint32_t frame = 0;
};
/// `display`: how radiance becomes colours. Within -40 to 40 stops and 1e12 cd/m².
struct DisplayRequest {
    DisplaySettings settings;
    std::uint8_t number = 0;  ///< that frames repeat which have these colours
    bool clean = false;       ///< at rest, of a denoised picture where the server can make one
    friend bool operator==(const DisplayRequest&, const DisplayRequest&) = default;
};
/// `settings`: when indirect light is calculated.
struct SettingsRequest {
    WalkAmbient ambient = WalkAmbient::rest;
    friend bool operator==(const SettingsRequest&, const SettingsRequest&) = default;
};
/// How much of a light group's light is shown.
struct LightLevel {
    std::string name;    ///< of the group, at most 256 bytes
    double level = 1;    ///< 0 (off) to 100; 1: as the scene has it
    Rgb color{1, 1, 1};  ///< factor of its colour, each 0 to 100
    friend bool operator==(const LightLevel&, const LightLevel&) = default;
};
/// `lights`: all dimmers; groups that are not named are as the scene has them.
struct LightsRequest {
    std::vector<LightLevel> levels;  ///< at most kMostLightLevels; names are unique
    friend bool operator==(const LightsRequest&, const LightsRequest&) = default;
};
/// `time`: when the sky is seen that generators have written.
struct TimeRequest {
    std::optional<SkyTime> time;  ///< nothing: as the scene's files have it
    friend bool operator==(const TimeRequest&, const TimeRequest&) = default;
};
/// `pick`: the light at a point of a picture, in the image coordinates of Camera, 0 to 1.
struct PickRequest {
    std::uint32_t id = 0;
    double x = 0, y = 0;
    std::optional<View> view;  ///< of that picture; nothing: the newest view
};
/// `rectangle`: the mean luminance in a rectangle, x0 < x1 and y0 < y1.
struct MeanRequest {
    std::uint32_t id = 0;
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};
/// A pin on a surface.
struct ProbePlace {
    std::uint32_t id = 0;
    Vec3 position;  ///< [m]
    Vec3 normal;    ///< unit vector
};
/// `probes`: all pins; they replace the previous ones.
struct ProbesRequest {
    std::vector<ProbePlace> probes;  ///< at most kMostProbes
};
struct GlareRequest {
    std::uint32_t id = 0;
};
/// `plan`: the floor plan of where the walk is.
struct PlanRequest {
    std::uint32_t id = 0;
};
/// `isolux`: the illuminances on a plane.
struct IsoluxRequest {
    std::uint32_t id = 0;
    Vec3 position;               ///< on a surface, or of an eye [m]
    std::optional<Vec3> normal;  ///< unit, of that surface; nothing: a level plane below the eye
    double height = 0;           ///< of that plane above the floor, not negative [m]
};
/// `material`: what the surface is made of that a picture shows at a point, as PickRequest.
struct MaterialRequest {
    std::uint32_t id = 0;
    double x = 0, y = 0;
    std::optional<View> view;  ///< of that picture; nothing: the newest view
};
/// Other numbers for a material of the scene's own files.
struct MaterialEdit {
    std::string name;              ///< at most 256 bytes
    std::uint32_t definition = 0;  ///< which of the modifiers of that name, in their order
    std::string kind;              ///< its type, at most 32 bytes
    std::vector<double> reals;     ///< all its numbers, 1 to 16; within 1e12
    friend bool operator==(const MaterialEdit&, const MaterialEdit&) = default;
};
/// `edits`: all changed materials; others are as the scene has them.
struct EditsRequest {
    std::uint32_t id = 0;
    std::vector<MaterialEdit> materials;  ///< at most kMostEdits; each definition once
    friend bool operator==(const EditsRequest&, const EditsRequest&) = default;
};
/// `difference`: of a scene beside the walk's, whether its frames show how it differs from that.
struct DifferenceRequest {
    bool shown = false;
};
/// `take`: a watcher asks to drive.
struct TakeRequest {};
/// `hand`: the driver makes another client the driver.
struct HandRequest {
    std::uint32_t to = 0;  ///< a client's number
};

using WalkRequest =
    std::variant<HelloRequest, ViewRequest, AckRequest, DisplayRequest, SettingsRequest,
                 LightsRequest, TimeRequest, PickRequest, MeanRequest, ProbesRequest, GlareRequest,
                 PlanRequest, IsoluxRequest, MaterialRequest, EditsRequest, DifferenceRequest,
                 TakeRequest, HandRequest>;

/// The largest picture that a server draws [pixels].
struct WalkSizeLimit {
    int width = kLargestWalkSize, height = kLargestWalkSize;
};

/// A message is sound but for a view that cannot be drawn: no reason to end the connection.
class UndrawableView : public InputError {
  public:
    enum class Kind { view, question };
    /// @param id  of the request
    UndrawableView(const std::string& problem, std::uint32_t id, Kind kind)
        : InputError(problem), id_(id), kind_(kind) {}
    [[nodiscard]] std::uint32_t id() const { return id_; }
    [[nodiscard]] Kind kind() const { return kind_; }

  private:
    std::uint32_t id_;
    Kind kind_;
};

/// Parse a message. A size larger than `limit` is reduced in proportion, to at least one pixel.
/// Throws InputError, without a place, for everything that io/net/README.md does not allow: text
/// beyond 64 KB, JSON nested deeper than 8, unknown types, fields that are missing or of another
/// type, numbers beyond their range; UndrawableView where that is so of a view alone.
[[nodiscard]] WalkRequest parse_walk_request(std::string_view text, WalkSizeLimit limit = {});

}  // namespace lightwalk
