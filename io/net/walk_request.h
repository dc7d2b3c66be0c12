#pragma once
// What a browser asks of a walk: its messages as values. The format is in README.md beside this.
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/view/view.h"

namespace lightwalk {

inline constexpr std::size_t kLargestWalkRequest =
    std::size_t{64} * 1024;                    ///< of a message [bytes]
inline constexpr int kLargestWalkSize = 4096;  ///< of a window's side [pixels]
inline constexpr std::size_t kMostProbes = 64;

struct HelloRequest {
    std::string session;  ///< 16 to 64 hex digits
};
/// What the page wants to see.
struct ViewRequest {
    std::uint32_t id = 0;
    View view;                  ///< one that Camera takes, no number beyond 1e9
    int width = 0, height = 0;  ///< [pixels], within the limits of parse_walk_request
    bool moving = false;        ///< more will follow soon
    bool walk = false;          ///< keep the eye at its height above what is below
};
/// A frame has been drawn on the screen.
struct AckRequest {
    std::uint32_t frame = 0;
};
/// How radiance becomes colours.
struct DisplayRequest {
    bool false_colour = false;
    bool automatic = true;         ///< exposure follows the picture
    double ev = 0;                 ///< else [stops], -40 to 40
    bool human = false;            ///< tone mapping as eyes would see it
    double low = 1, high = 10000;  ///< scale of false colours [cd/m²], 0 <= low < high <= 1e12
    bool logarithmic = true;       ///< of the scale; low is above 0 then
    friend bool operator==(const DisplayRequest&, const DisplayRequest&) = default;
};
/// When indirect light is computed.
enum class WalkAmbient { rest, always, off };
struct SettingsRequest {
    WalkAmbient ambient = WalkAmbient::rest;
    friend bool operator==(const SettingsRequest&, const SettingsRequest&) = default;
};
/// What is seen at a point of the picture; image positions as Camera's, 0 to 1.
struct PickRequest {
    std::uint32_t id = 0;
    double x = 0, y = 0;
};
/// Mean luminance in a rectangle, x0 < x1 and y0 < y1.
struct MeanRequest {
    std::uint32_t id = 0;
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};
/// A pin on a surface.
struct ProbePlace {
    std::uint32_t id = 0;
    Vec3 position;  ///< [m]
    Vec3 normal;    ///< unit
};
/// All pins; those before are gone.
struct ProbesRequest {
    std::vector<ProbePlace> probes;  ///< at most kMostProbes
};
struct GlareRequest {
    std::uint32_t id = 0;
};
/// A watcher wants to drive.
struct TakeRequest {};
/// The driver hands over.
struct HandRequest {
    std::uint32_t to = 0;  ///< a client's number
};

using WalkRequest =
    std::variant<HelloRequest, ViewRequest, AckRequest, DisplayRequest, SettingsRequest,
                 PickRequest, MeanRequest, ProbesRequest, GlareRequest, TakeRequest, HandRequest>;

/// The largest picture that a server draws [pixels].
struct WalkSizeLimit {
    int width = kLargestWalkSize, height = kLargestWalkSize;
};

/// Read one message. A window larger than `limit` is shrunk in proportion, to a pixel at least.
/// Throws InputError, without a place, for everything that is not a message as README.md has it:
/// text beyond 64 KB, JSON nested deeper than 8, unknown types, fields that are missing or of
/// another type, numbers beyond their range.
[[nodiscard]] WalkRequest parse_walk_request(std::string_view text, WalkSizeLimit limit = {});

}  // namespace lightwalk
