#include "core/texture/text_pattern.h"

#include <optional>
#include <string>
#include <vector>

#include "core/scene/modifier.h"
#include "core/texture/arguments.h"
#include "core/transport/light_transport.h"

namespace lightwalk {
namespace {

std::vector<std::string> text_of(const ModifierBuild& build, std::size_t font) {
    const std::vector<std::string>& words = build.primitive.strings;
    if (words.size() == font + 2) return build.resources.text_lines(words[font + 1]);
    std::string line;
    for (std::size_t i = font + 2; i < words.size(); ++i) {
        if (i > font + 2) line += ' ';
        line += words[i];
    }
    return {line};
}

class TextPattern final : public Modifier {
  public:
    explicit TextPattern(const ModifierBuild& build)
        : layout_(make_text_layout(build, 0,
                                   build.primitive.type == PrimitiveType::colortext ? 6 : 2)) {
        const auto real = [&](std::size_t i) {
            return static_cast<float>(build.primitive.reals[i]);
        };
        if (build.primitive.type == PrimitiveType::colortext) {
            foreground_ = {real(9), real(10), real(11)};
            background_ = {real(12), real(13), real(14)};
        } else {
            foreground_ = Rgb::grey(real(9));
            background_ = Rgb::grey(real(10));
        }
    }

    bool shade(Ray& ray, TraceContext& context) const override {
        ray.pattern *= inside_text(layout_, ray, context) ? foreground_ : background_;
        return false;
    }

  private:
    TextLayout layout_;
    Rgb foreground_, background_;
};

}  // namespace

TextLayout make_text_layout(const ModifierBuild& build, std::size_t font, std::size_t colors) {
    const Primitive& primitive = build.primitive;
    require_arguments(primitive, font + 2, 9 + colors);
    const std::vector<double>& a = primitive.reals;
    std::optional<double> spacing;
    if (a.size() > 9 + colors) spacing = a[9 + colors];
    return load_for(primitive, [&] {
        return TextLayout(text_of(build, font), build.resources.font(primitive.strings[font]),
                          Vec3{a[0], a[1], a[2]}, Vec3{a[3], a[4], a[5]}, Vec3{a[6], a[7], a[8]},
                          spacing);
    });
}

bool inside_text(const TextLayout& layout, const Ray& ray, const TraceContext& context) {
    if (ray.hit.instance == kWorld) return layout.inside(ray.hit.position);
    const Transform placed = context.tracer.scene().geometry().instance_transform(ray.hit.instance);
    return layout.inside(placed.inverse.point(ray.hit.position));
}

std::unique_ptr<const Modifier> make_text_pattern(const ModifierBuild& build) {
    return std::make_unique<TextPattern>(build);
}

}  // namespace lightwalk
