#pragma once
// Indirect light for a view that rests: its picture is traced again, coarse to fine, by a tracer
// that knows more light than the frames of the walk had time for.
#include <optional>
#include <span>
#include <vector>

#include "core/cloud/progressive.h"
#include "core/math/function_ref.h"
#include "core/view/pixels.h"

namespace lightwalk {

/// Rows of pixels from the bottom as rows from the top, or the other way round.
template <class Value>
std::vector<Value> turned_rows(std::span<const Value> rows, int width) {
    std::vector<Value> result;
    result.reserve(rows.size());
    const auto row = static_cast<std::size_t>(width);
    for (std::size_t end = rows.size(); end >= row && row > 0; end -= row) {
        const std::span<const Value> line = rows.subspan(end - row, row);
        result.insert(result.end(), line.begin(), line.end());
    }
    return result;
}

/// A picture that starts as one tracer drew it, and ends as another one draws it. Meanwhile it
/// shows the finest grid that is traced as a whole; the other pixels get what the difference is
/// around them.
class ProgressiveLight {
  public:
    /// Traces pixels; nothing for those that there was no time for.
    using Trace = FunctionRef<TracedValues(const ProgressiveWork& work)>;

    /// @param samples   rays that a pixel at an edge gets in the end, at least 1
    ProgressiveLight(int width, int height, int samples)
        : width_(width), height_(height), work_(width, height, samples) {}

    /// @param radiance, distance  row by row from the bottom
    /// @param groups   what each light group adds to the pixels; empty: they are not kept
    /// @param drafted  whether the picture is nearly right: then a coarse grid would make it worse
    void begin(std::span<const Rgb> radiance, std::span<const float> distance,
               std::span<const Rgb> groups = {}, bool drafted = false);

    /// Show another mixture of the light groups, where these are kept.
    void mix(const LightMixture& mixture);

    /// Trace more pixels. The coarsest grids are traced twice: what the tracer stores of indirect
    /// light, to interpolate it, is sparse and rough until then, and would show as dots.
    /// @return  false: there is nothing left to do
    bool step(Trace trace);

    /// The picture as far as it is known, row by row from the bottom.
    [[nodiscard]] std::vector<Rgb> picture() const;
    [[nodiscard]] std::span<const float> distance() const { return work_.distance(); }
    /// Share of the pixels that are traced, 0 ... 1.
    [[nodiscard]] double share() const;

  private:
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }
    [[nodiscard]] bool is_traced(int x, int y) const {
        return work_.origins()[at(x, y)].kind == PixelOrigin::Kind::traced;
    }
    [[nodiscard]] int whole_grid() const;
    [[nodiscard]] Rgb difference(int x, int y, int spacing) const;

    int width_, height_;
    ProgressivePicture work_;
    std::vector<Rgb> before_;
    std::vector<Rgb> groups_before_;  ///< by pixel, then group
    int coarsest_ = 0;                ///< spacing of grids that are shown [pixels]
    bool overture_ = true;            ///< no pixel counts yet, see step()
    std::vector<std::size_t> left_;   ///< pixels to trace, by level of the grid
    ProgressiveWork chosen_;          ///< of them those that come next
};

}  // namespace lightwalk
