// Patterns of spectra: they multiply the ray's pattern colour by what a spectrum is in three
// channels. Source: Radiance's manual "The Radiance 6.x Scene Description Language"; its notes on
// hyperspectral rendering.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene/modifier.h"
#include "core/spectrum/spectrum_color.h"
#include "core/texture/arguments.h"
#include "core/texture/function_binding.h"
#include "core/texture/interpolate.h"
#include "core/texture/lookup.h"
#include "core/transport/light_transport.h"

namespace lightwalk {
namespace {

/// The even wavelengths at which a data file's axis is taken: its own points, or, where those are
/// uneven, twice as many.
struct EvenWavelengths {
    double first = 0, last = 0;  // [nm]
    std::size_t count = 0;

    explicit EvenWavelengths(const DataArray::Axis& axis)
        : first(static_cast<double>(axis.origin)),
          last(static_cast<double>(axis.origin) + static_cast<double>(axis.extent)),
          count(axis.points.empty() ? axis.count : 2 * std::size_t{axis.count}) {}
    [[nodiscard]] double operator[](std::size_t i) const {
        return first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1);
    }
    [[nodiscard]] SpectrumColor color() const {
        return SpectrumColor(ends_of_samples(first, last, count), count);
    }
};

void require_wavelengths(const Primitive& primitive, double a, double b) {
    if (a != b && a > 0 && b > 0 && std::isfinite(a) && std::isfinite(b)) return;
    throw modifier_error(primitive, "bad wavelengths: two different ones expected [nm]");
}

/// spectrum and specfile: one colour everywhere.
class ConstantSpectrum final : public Modifier {
  public:
    explicit ConstantSpectrum(const Rgb& color) : color_(color) {}
    bool shade(Ray& ray, TraceContext&) const override {
        ray.pattern *= color_;
        return false;
    }

  private:
    Rgb color_;
};

Rgb color_of_arguments(const Primitive& primitive) {
    require_arguments(primitive, 0, 5);
    const double a = primitive.reals[0], b = primitive.reals[1];
    require_wavelengths(primitive, a, b);
    const std::size_t count = primitive.reals.size() - 2;
    return SpectrumColor(ends_of_samples(a, b, count),
                         count)(std::span(primitive.reals).subspan(2));
}

Rgb color_of_file(const ModifierBuild& build) {
    const Primitive& primitive = build.primitive;
    require_arguments(primitive, 1);
    const std::shared_ptr<const DataArray> data =
        load_for(primitive, [&] { return build.resources.data(primitive.strings[0]); });
    if (data->axes.size() != 1)
        throw modifier_error(primitive, "a data file of one dimension expected");
    const EvenWavelengths wavelengths(data->axes[0]);
    require_wavelengths(primitive, wavelengths.first, wavelengths.last);
    const SpectrumColor color = wavelengths.color();
    SpectrumColor::Sum sum(color);
    for (std::size_t i = 0; i < wavelengths.count; ++i)
        sum.add(i, interpolate(*data, std::array{wavelengths[i]}));
    return sum.color();
}

/// specfunc: a function of the wavelength, at wavelengths that each ray draws anew. As in Radiance
/// these go down from the longest one in steps of one width, and their values count for equal parts
/// of the whole range, of which the last step may leave some.
class SpectralFunction final : public Modifier {
  public:
    explicit SpectralFunction(const ModifierBuild& build)
        : range_(clipped_range(build.primitive)),
          color_(range_, step_count(range_)),
          binding_(build, 1, {{build.primitive.strings[0], 1}}, 2) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        EvalState& state = binding_.begin(ray, context);
        SpectrumColor::Sum sum(color_);
        const std::size_t count = color_.bands();
        const double step = count > 1 ? kStep : range_.last - range_.first;
        for (std::size_t i = 0; i < count; ++i) {
            const double at = static_cast<double>(i) + 0.5 + kSpread * (ray.random.next() - 0.5);
            const std::array<double, 1> wavelength{range_.last - step * at};
            sum.add(count - 1 - i, binding_.call(0, wavelength, state));
        }
        if (state.error == EvalError::none) ray.pattern *= sum.color();
        return false;
    }

  private:
    static constexpr double kShortest = 380, kLongest = 780;      // [nm]
    static constexpr double kStep = (kLongest - kShortest) / 12;  // [nm]
    static constexpr double kSpread = 0.9;  ///< part of a step over which wavelengths are drawn

    /// From the shorter to the longer wavelength.
    static WavelengthEnds clipped_range(const Primitive& primitive) {
        require_arguments(primitive, 2, 2);
        const double a = std::clamp(primitive.reals[0], kShortest, kLongest),
                     b = std::clamp(primitive.reals[1], kShortest, kLongest);
        require_wavelengths(primitive, a, b);
        return {std::min(a, b), std::max(a, b)};
    }
    static std::size_t step_count(const WavelengthEnds& range) {
        const double count = std::floor((range.last - range.first) / kStep + 1e-9);
        return static_cast<std::size_t>(std::max(count, 1.0));
    }

    WavelengthEnds range_;
    SpectrumColor color_;
    FunctionBinding binding_;
};

/// specdata: a table whose last axis is the wavelength; strings `func data file x1... transform`.
class SpectralData final : public Modifier {
  public:
    explicit SpectralData(const ModifierBuild& build)
        : table_((require_arguments(build.primitive, 4),
                  load_for(build.primitive,
                           [&] { return build.resources.data(build.primitive.strings[1]); }))),
          wavelengths_(table_->axes.back()),
          color_((require_wavelengths(build.primitive, wavelengths_.first, wavelengths_.last),
                  wavelengths_.color())),
          binding_(bind(build, table_->axes.size() - 1)) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        EvalState& state = binding_.begin(ray, context);
        std::array<double, kMaxDataDimensions> point{};
        const std::size_t dimensions = table_->axes.size();
        for (std::size_t d = 0; d + 1 < dimensions; ++d) {
            point[d] = binding_.evaluate(1 + d, state);
            if (state.error != EvalError::none) return false;
        }
        SpectrumColor::Sum sum(color_);
        for (std::size_t i = 0; i < wavelengths_.count; ++i) {
            point[dimensions - 1] = wavelengths_[i];
            const double datum = interpolate(*table_, std::span(point).first(dimensions));
            sum.add(i, binding_.call(0, std::array{datum, wavelengths_[i]}, state));
        }
        if (state.error == EvalError::none) ray.pattern *= sum.color();
        return false;
    }

  private:
    static FunctionBinding bind(const ModifierBuild& build, std::size_t coordinates) {
        const std::vector<std::string>& s = build.primitive.strings;
        require_arguments(build.primitive, 3 + coordinates);
        std::vector<ExpressionRequest> requests{{s[0], 2}};
        for (std::size_t d = 0; d < coordinates; ++d) requests.push_back({s[3 + d], -1});
        return FunctionBinding(build, 2, std::move(requests), 3 + coordinates);
    }

    std::shared_ptr<const DataArray> table_;
    EvenWavelengths wavelengths_;
    SpectrumColor color_;
    FunctionBinding binding_;  ///< outputs: the function, then the coordinates
};

/// specpict: a picture of spectra; strings `func picture file u v transform`.
class SpectralPicturePattern final : public Modifier {
  public:
    explicit SpectralPicturePattern(const ModifierBuild& build)
        : picture_(
              (require_arguments(build.primitive, 5),
               load_for(
                   build.primitive,
                   [&] { return build.resources.spectral_picture(build.primitive.strings[1]); }))),
          color_({picture_->first_edge, picture_->last_edge}, picture_->bands),
          binding_(build, 2,
                   {{build.primitive.strings[0], 2},
                    {build.primitive.strings[3], -1},
                    {build.primitive.strings[4], -1}},
                   5) {}

    bool shade(Ray& ray, TraceContext& context) const override {
        EvalState& state = binding_.begin(ray, context);
        const double u = binding_.evaluate(1, state), v = binding_.evaluate(2, state);
        if (state.error != EvalError::none) return false;
        const double step =
            (picture_->last_edge - picture_->first_edge) / static_cast<double>(picture_->bands);
        SpectrumColor::Sum sum(color_);
        for (std::size_t i = 0; i < picture_->bands; ++i) {
            const double wavelength = picture_->first_edge + step * (static_cast<double>(i) + 0.5);
            const double datum = interpolate(*picture_, u, v, i);
            sum.add(i, binding_.call(0, std::array{datum, wavelength}, state));
        }
        if (state.error == EvalError::none) ray.pattern *= sum.color();
        return false;
    }

  private:
    std::shared_ptr<const SpectralPicture> picture_;
    SpectrumColor color_;
    FunctionBinding binding_;
};

}  // namespace

std::unique_ptr<const Modifier> make_spectrum(const ModifierBuild& build) {
    if (build.primitive.type == PrimitiveType::specfile)
        return std::make_unique<ConstantSpectrum>(color_of_file(build));
    return std::make_unique<ConstantSpectrum>(color_of_arguments(build.primitive));
}

std::unique_ptr<const Modifier> make_spectral_function(const ModifierBuild& build) {
    return std::make_unique<SpectralFunction>(build);
}

std::unique_ptr<const Modifier> make_spectral_data(const ModifierBuild& build) {
    return std::make_unique<SpectralData>(build);
}

std::unique_ptr<const Modifier> make_spectral_picture(const ModifierBuild& build) {
    return std::make_unique<SpectralPicturePattern>(build);
}

}  // namespace lightwalk
