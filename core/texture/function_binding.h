#pragma once
// Ties the expressions of a primitive to a ray: channels in function space, and the way back.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/function/program.h"
#include "core/geometry/geometry.h"
#include "core/math/transform.h"
#include "core/scene/modifier.h"

namespace lightwalk {

class LightTransport;

/// Values that only some materials provide to their functions (NxP..CbP, DxA..DzA); world space
/// where they are directions; the binding takes them to function space.
struct MaterialVariables {
    Vec3 normal;        ///< perturbed normal, on the incident side: NxP NyP NzP
    double cosine = 0;  ///< RdotP
    Rgb color;          ///< CrP CgP CbP
    Vec3 aim;           ///< DxA DyA DzA: unit, towards the light aimed at; zero when none
};
inline constexpr ChannelMask kNormalChannels =
    channel_bit(Channel::NxP) | channel_bit(Channel::NyP) | channel_bit(Channel::NzP) |
    channel_bit(Channel::RdotP) | channel_bit(Channel::CrP) | channel_bit(Channel::CgP) |
    channel_bit(Channel::CbP);
inline constexpr ChannelMask kAimChannels =
    channel_bit(Channel::DxA) | channel_bit(Channel::DyA) | channel_bit(Channel::DzA);

/// Load the definitions of a function file, unless it is loaded already. Throws MissingFile and
/// InputError with the primitive's place.
void load_functions(const ModifierBuild& build, const std::string& file);

/// The variables of a ray that a function may read, without those of its hit.
struct RayWay {
    Vec3 direction;
    double path_length = 0, shadow_length = 0;  ///< see Ray [m]
};
struct RayHit {
    RayWay way;
    Hit hit;
};

class FunctionBinding {
  public:
    /// @param build     the primitive and the tables to compile with
    /// @param file      which string argument names the function file ("." for none)
    /// @param requests  what to compile, in the file's context, after loading it
    /// @param first_transform_word  where the search for transform words starts (after file and
    /// expressions) Throws InputError (missing file, syntax error, `bad transform`, `bad #
    /// arguments`).
    FunctionBinding(const ModifierBuild& build, std::size_t file,
                    std::vector<ExpressionRequest> requests, std::size_t first_transform_word,
                    ChannelMask material_channels = 0);

    /// Start an epoch for this ray: fills the channels the program reads. The state belongs to the
    /// context and is valid until the next begin on the same context, so begin again after tracing
    /// a child ray.
    EvalState& begin(const Ray& ray, TraceContext& context,
                     const MaterialVariables* material = nullptr) const;

    /// Output 0 for up to kSideBySide rays at once (SIMD), of a program that has lanes. Rays that
    /// need a scalar evaluation get nothing, see Program::evaluate_all.
    void evaluate_all(std::span<const RayHit> hits, std::span<std::optional<double>> values,
                      TraceContext& context) const;

    [[nodiscard]] const Program& program() const { return program_; }
    [[nodiscard]] double evaluate(std::size_t output, EvalState& state) const {
        return program_.evaluate(output, state);
    }
    [[nodiscard]] double call(std::size_t output, std::span<const double> arguments,
                              EvalState& state) const {
        return program_.call(output, arguments, state);
    }

    /// Function space -> world without scale (texture displacements, prism directions, orientation
    /// vectors).
    [[nodiscard]] Vec3 to_world(const Vec3& d, const Ray& ray, const TraceContext& context) const;
    /// World -> function space without scale (light directions for plasfunc and relatives).
    [[nodiscard]] Vec3 to_function(const Vec3& d, const Ray& ray,
                                   const TraceContext& context) const;
    [[nodiscard]] const Transform& transform() const { return transform_; }

  private:
    void fill(ChannelValues& out, const RayWay& way, const Hit& hit, const LightTransport& tracer,
              const MaterialVariables* material) const;

    Program program_;
    Transform transform_;  ///< of the transform words among the primitive's arguments
    bool transformed_ = false;
    ChannelMask channels_ = 0;
};

/// The first three string arguments as expressions, as colorfunc and texfunc have them. Throws
/// InputError for fewer than four string arguments.
[[nodiscard]] std::vector<ExpressionRequest> three_expressions(const Primitive& primitive);

}  // namespace lightwalk
