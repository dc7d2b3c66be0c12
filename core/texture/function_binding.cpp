#include "core/texture/function_binding.h"

#include "core/function/environment.h"
#include "core/model/transform_args.h"
#include "core/texture/arguments.h"
#include "core/transport/light_transport.h"

namespace lightwalk {
namespace {

constexpr ChannelMask bits(Channel first, Channel last) {
    ChannelMask mask = 0;
    for (auto c = static_cast<unsigned>(first); c <= static_cast<unsigned>(last); ++c) {
        mask |= ChannelMask{1} << c;
    }
    return mask;
}

constexpr ChannelMask kDirection = bits(Channel::Dx, Channel::Dz);
constexpr ChannelMask kNormal = bits(Channel::Nx, Channel::Nz);
constexpr ChannelMask kPoint = bits(Channel::Px, Channel::Pz);
constexpr ChannelMask kScalars = channel_bit(Channel::T) | channel_bit(Channel::Ts) |
                                 channel_bit(Channel::Rdot) | channel_bit(Channel::Lu) |
                                 channel_bit(Channel::Lv);
constexpr ChannelMask kSpace = bits(Channel::S, Channel::Kz);

void set(ChannelValues& out, Channel first, const Vec3& v) {
    const auto i = static_cast<std::size_t>(first);
    out[i] = v.x;
    out[i + 1] = v.y;
    out[i + 2] = v.z;
}

void set(ChannelValues& out, Channel channel, double v) {
    out[static_cast<std::size_t>(channel)] = v;
}

/// World -> function space: M, and sigma, function-space units per world unit.
class ToFunction {
  public:
    ToFunction(const Transform& own, bool transformed, InstanceId instance,
               const Geometry& geometry) {
        if (instance == kWorld) {
            if (transformed) set(own.inverse, own.size());
            return;
        }
        const Transform placed = geometry.instance_transform(instance);
        if (transformed)
            set(placed.inverse * own.inverse, placed.size() * own.size());
        else
            set(placed.inverse, placed.size());
    }
    [[nodiscard]] double sigma() const { return sigma_; }
    [[nodiscard]] Matrix matrix() const { return matrix_.value_or(Matrix{}); }
    [[nodiscard]] Vec3 direction(const Vec3& v) const {
        return matrix_ ? matrix_->vector(v) * (1 / sigma_) : v;
    }
    [[nodiscard]] Vec3 point(const Vec3& p) const { return matrix_ ? matrix_->point(p) : p; }

  private:
    void set(const Matrix& matrix, double size) {
        matrix_ = matrix;
        sigma_ = 1 / size;
    }
    std::optional<Matrix> matrix_;  ///< nothing: the identity, the most frequent case
    double sigma_ = 1;
};

void fill_scalars(ChannelValues& out, const RayWay& way, const Hit& hit, double sigma) {
    set(out, Channel::T, sigma * (way.path_length + hit.t));
    set(out, Channel::Ts, sigma * (way.shadow_length + hit.t));
    set(out, Channel::Rdot, std::clamp(hit.cos_out, -1.0, 1.0));
    set(out, Channel::Lu, hit.u);
    set(out, Channel::Lv, hit.v);
}

void fill_space(ChannelValues& out, const ToFunction& space) {
    const Matrix matrix = space.matrix();
    const double size = 1 / space.sigma();
    set(out, Channel::S, space.sigma());
    set(out, Channel::Tx, matrix.row[3]);
    set(out, Channel::Ix, matrix.row[0] * size);
    set(out, Channel::Jx, matrix.row[1] * size);
    set(out, Channel::Kx, matrix.row[2] * size);
}

void fill_material(ChannelValues& out, const ToFunction& space, const MaterialVariables& material) {
    set(out, Channel::NxP, space.direction(material.normal));
    set(out, Channel::RdotP, material.cosine);
    set(out, Channel::CrP, static_cast<double>(material.color.r));
    set(out, Channel::CgP, static_cast<double>(material.color.g));
    set(out, Channel::CbP, static_cast<double>(material.color.b));
    set(out, Channel::DxA, space.direction(material.aim));
}

}  // namespace

void load_functions(const ModifierBuild& build, const std::string& file) {
    if (build.functions.loaded(file)) return;
    build.functions.load(
        file, load_for(build.primitive, [&] { return build.resources.function_file(file); }));
}

FunctionBinding::FunctionBinding(const ModifierBuild& build, std::size_t file,
                                 std::vector<ExpressionRequest> requests,
                                 std::size_t first_transform_word, ChannelMask material_channels) {
    const Primitive& primitive = build.primitive;
    require_arguments(primitive, std::max(file + 1, first_transform_word));
    const std::string& name = primitive.strings[file];
    load_functions(build, name);
    program_ = build.functions.shared_program(name, requests, primitive.reals, material_channels,
                                              primitive.where);
    channels_ = program_.channels();

    std::size_t word = first_transform_word;
    while (word < primitive.strings.size() && !is_transform_option(primitive.strings[word])) ++word;
    const auto words =
        std::span(primitive.strings).subspan(std::min(word, primitive.strings.size()));
    const ParsedTransform& parsed = build.transforms.parse(words);
    if (parsed.words != words.size()) throw modifier_error(primitive, "bad transform");
    transform_ = parsed.transform;
    transformed_ = !transform_.is_identity();
}

/// The channels that the program reads.
void FunctionBinding::fill(ChannelValues& out, const RayWay& way, const Hit& hit,
                           const LightTransport& tracer, const MaterialVariables* material) const {
    const ToFunction space(transform_, transformed_, hit.instance, tracer.scene().geometry());
    if (channels_ & kDirection) set(out, Channel::Dx, space.direction(way.direction));
    if (channels_ & kNormal) set(out, Channel::Nx, space.direction(hit.normal));
    if (channels_ & kPoint) set(out, Channel::Px, space.point(hit.position));
    if (channels_ & kScalars) fill_scalars(out, way, hit, space.sigma());
    if (channels_ & kSpace) fill_space(out, space);
    if (material) fill_material(out, space, *material);
}

EvalState& FunctionBinding::begin(const Ray& ray, TraceContext& context,
                                  const MaterialVariables* material) const {
    ChannelValues& out = context.functions.channels;
    fill(out, {ray.direction, ray.path_length, ray.shadow_length}, ray.hit, context.tracer,
         material);
    program_.begin(context.functions.eval, out);
    context.functions.eval.clear_error();
    return context.functions.eval;
}

void FunctionBinding::evaluate_all(std::span<const RayHit> hits,
                                   std::span<std::optional<double>> values,
                                   TraceContext& context) const {
    for (std::size_t k = 0; k < hits.size(); ++k)
        fill(context.functions.lane_channels[k], hits[k].way, hits[k].hit, context.tracer, nullptr);
    const auto channels = std::span(context.functions.lane_channels).first(hits.size());
    program_.evaluate_all(0, channels, values, context.functions.eval);
}

Vec3 FunctionBinding::to_world(const Vec3& d, const Ray& ray, const TraceContext& context) const {
    Vec3 v = transformed_ ? transform_.forward.vector(d) * (1 / transform_.size()) : d;
    if (ray.hit.instance != kWorld) {
        const Transform placed =
            context.tracer.scene().geometry().instance_transform(ray.hit.instance);
        v = placed.forward.vector(v) * (1 / placed.size());
    }
    return v;
}

Vec3 FunctionBinding::to_function(const Vec3& d, const Ray& ray,
                                  const TraceContext& context) const {
    return ToFunction(transform_, transformed_, ray.hit.instance, context.tracer.scene().geometry())
        .direction(d);
}

std::vector<ExpressionRequest> three_expressions(const Primitive& primitive) {
    require_arguments(primitive, 4);
    return {{primitive.strings[0], -1}, {primitive.strings[1], -1}, {primitive.strings[2], -1}};
}

}  // namespace lightwalk
