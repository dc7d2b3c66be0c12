#pragma once
// A frame of a walk as the owners of its parts are told to draw it, and what they hand back.
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/cloud/cloud_frame.h"
#include "core/cloud/progressive.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Number of an order: greater than that of every order before.
using FrameNumber = std::uint64_t;

struct FrameOrder {
    FrameNumber number = 0;
    std::int32_t width = 0, height = 0;
    CloudRules rules;
    std::string payload;            ///< view and options, for whoever makes the frame's rays
    double budget = 0;              ///< see CloudOptions [s]
    std::uint64_t most_points = 0;  ///< of all parts, afterwards
    // Or the view is that of the frame before: nothing but these pixels is traced.
    bool rests = false;
    bool leaves = false;      ///< whether these pixels leave points
    std::int32_t sample = 0;  ///< see PixelCaster
    std::vector<PixelPlace> refined;
    /// Row by row from the bottom, all of a picture whose pixels leave points though nothing is
    /// traced (KnownPicture::values); empty: there is none.
    std::vector<PixelValue> known;
    bool aside = false;          ///< of what lies beside a view that rests, for its points alone
    bool tells_origins = false;  ///< whether parts say where the last frame's pixels come from
    LightMixture mixture;        ///< of the light groups, where these are kept
    /// Owners trace the uncached pixels of their own parts: to share them out takes longer.
    bool apart = false;
    friend bool operator==(const FrameOrder&, const FrameOrder&) = default;
};

/// Another scene, of the same surfaces, for the frames that follow. All ranks prepare it; a second
/// order says whether they take it, which they do where each could.
struct ChangeOrder {
    enum class Step : std::uint8_t { prepare, take, drop };
    FrameNumber number = 0;  ///< the same in both
    Step step = Step::prepare;
    std::string payload;  ///< to be prepared: what changes, for whoever makes the frames' rays
    std::vector<std::uint8_t> shown;  ///< of the points that are outdated, see ShownMaterials;
                                      ///< empty: all are
    friend bool operator==(const ChangeOrder&, const ChangeOrder&) = default;
};

/// What a rank says of a change that it was to prepare.
struct PreparedChange {
    FrameNumber number = 0;
    std::string problem;            ///< why it cannot be; "": it can
    std::uint64_t points = 0;       ///< of this rank's part
    std::uint64_t kept_points = 0;  ///< of these, where the change is taken
};

/// A rectangle of a frame, drawn by the rank that owns it.
struct FramePart {
    FrameNumber frame = 0;
    PixelRectangle area;
    /// Row by row from the bottom; for another machine compressed (encode_piece). Empty where the
    /// view rests.
    std::variant<std::vector<PixelValue>, std::string> pixels;
    std::vector<std::uint32_t> unknown;  ///< indices of pixels of which nothing is known, ascending
    CloudReport report;                  ///< its points: those that may be kept
    std::vector<PixelOrigin> origins;    ///< row by row from the bottom, where they are wanted
    /// Those of the order's refined pixels that lie here, in its order; none: there was no time.
    std::vector<std::optional<PixelValue>> refined;
    std::vector<Rgb> refined_groups;  ///< see TracedValues
};

/// All parts of a frame, in any order.
struct FinishedFrame {
    FrameNumber frame = 0;
    std::vector<FramePart> parts;
};

}  // namespace lightwalk
