#pragma once
// Light sources too small for the pixel grid, drawn into a picture with their true coverage.
#include <vector>

#include "core/light/image_polygon.h"
#include "core/light/light_sources.h"
#include "core/view/pixel_rays.h"
#include "core/view/pixels.h"
#include "core/view/view.h"

namespace lightwalk {

/// Whether a pixel shows a light source already, because its own ray met it.
enum class ShownSource {
    yes,
    no,
    by_colour,  ///< the ray is not known, or not the only one: where the colours are alike
};

/// What a small light source brings to one pixel.
struct SourcePixel {
    int x = 0, y = 0;     ///< y from the bottom
    float coverage = 0;   ///< share of the pixel that it covers
    Rgb radiance;         ///< what arrives from the source through the scene [W/(m² sr)]
    double distance = 0;  ///< along the ray [m]
    ShownSource shown = ShownSource::by_colour;
};

/// Blend a source into its pixel. Where the pixel's own ray met the source already only the
/// coverage counts; with distances (null: none), a source that is clearly nearer than what the
/// pixel shows sets the distance. Source: behaviour of Radiance's rpict, which tells by colours
/// within 7 % of each other what the pixel's ray has met, and so takes a wall as bright as a dimmed
/// lamp for that lamp: where it may be known, it is looked up here.
/// @return  factors of the pixel before and of the source's radiance in the new one
struct SourceBlend {
    float pixel = 1, source = 0;
};
SourceBlend blend_source(const SourcePixel& source, Rgb& pixel, float* distance);

/// The light sources that a picture has to draw because the rays of its pixels may miss them. They
/// are selected as rpict does it: whole inside the picture, facing the eye, no illums, narrower
/// than the spacing of the traced pixels. Immutable; draw() may be called from many threads.
class SmallSources {
  public:
    /// Selects nothing with -dv-. Not for pictures with a lens (-pd) or motion blur. The arguments
    /// must outlive this.
    /// @param rays  of the pixels, one each; null: not known. Pixels that are not traced (spacing
    ///              above 1) or are of several rays (`own_only` false) show a source where a ray of
    ///              theirs would meet it and the colours are alike.
    SmallSources(const LightTransport& tracer, const Camera& camera, int width, int height,
                 int spacing, const PixelRays* rays = nullptr, bool own_only = true);

    [[nodiscard]] bool empty() const { return outlines_.empty(); }
    [[nodiscard]] std::size_t size() const { return outlines_.size(); }

    /// Trace the sources' pixels inside a rectangle; `pixel` gets them source by source, in the
    /// order in which they have to be blended. What a pixel gets does not depend on the rectangle.
    /// As in rpict the topmost row of the picture gets nothing. Meanwhile context.groups holds what
    /// the groups of emitters bring.
    void draw(const PixelRectangle& area, TraceContext& context,
              FunctionRef<void(const SourcePixel&)> pixel) const;

  private:
    struct Outline {
        std::int32_t source = kNoTarget;
        ImagePolygon polygon;  ///< [pixels]
    };
    [[nodiscard]] bool project(const LightSource& source, ImagePolygon& polygon) const;
    [[nodiscard]] bool project_parallelogram(const LightSource& source,
                                             ImagePolygon& polygon) const;
    [[nodiscard]] bool project_box(const LightSource& source, ImagePolygon& polygon) const;
    [[nodiscard]] bool add_corner(const Vec3& corner, ImagePolygon& polygon) const;
    void draw_pixel(const Outline& outline, int x, int y, TraceContext& context,
                    FunctionRef<void(const SourcePixel&)> pixel) const;
    [[nodiscard]] Ray trace_to(std::int32_t source, int x, int y, double h, double v,
                               TraceContext& context) const;
    [[nodiscard]] ShownSource shown(std::int32_t source, int x, int y, TraceContext& context) const;

    const LightTransport& tracer_;
    const Camera& camera_;
    int width_, height_;
    const PixelRays* rays_;
    bool own_only_;
    std::vector<Outline> outlines_;
};

}  // namespace lightwalk
