#include "core/texture/function_binding.h"

#include "core/function/environment.h"
#include "core/model/transform_args.h"
#include "core/texture/arguments.h"
#include "core/transport/tracer.h"

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
struct ToFunction {
    Matrix matrix;
    double sigma = 1;
    bool identity = true;

    [[nodiscard]] Vec3 direction(const Vec3& v) const {
        return identity ? v : matrix.vector(v) * (1 / sigma);
    }
    [[nodiscard]] Vec3 point(const Vec3& p) const { return identity ? p : matrix.point(p); }
};

ToFunction world_to_function(const Transform& own, bool transformed, FrameId frame,
                             const Geometry& geometry) {
    if (frame == kWorld) {
        if (!transformed) return {};
        return {own.inverse, 1 / own.size(), false};
    }
    const Transform placed = geometry.frame(frame);
    if (!transformed) return {placed.inverse, 1 / placed.size(), false};
    return {placed.inverse * own.inverse, 1 / (placed.size() * own.size()), false};
}

void fill_scalars(ChannelValues& out, const Ray& ray, const Hit& hit, double sigma) {
    set(out, Channel::T, sigma * (ray.path_length + hit.t));
    set(out, Channel::Ts, sigma * (ray.shadow_length + hit.t));
    set(out, Channel::Rdot, std::clamp(hit.cos_out, -1.0, 1.0));
    set(out, Channel::Lu, hit.u);
    set(out, Channel::Lv, hit.v);
}

void fill_space(ChannelValues& out, const ToFunction& space) {
    set(out, Channel::S, space.sigma);
    set(out, Channel::Tx, space.matrix.row[3]);
    set(out, Channel::Ix, space.matrix.row[0] * (1 / space.sigma));
    set(out, Channel::Jx, space.matrix.row[1] * (1 / space.sigma));
    set(out, Channel::Kx, space.matrix.row[2] * (1 / space.sigma));
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
    const ParsedTransform parsed = parse_transform(words);
    if (parsed.words != words.size()) throw modifier_error(primitive, "bad transform");
    transform_ = parsed.transform;
    transformed_ = !transform_.is_identity();
}

/// The channels that the program reads; `direction` and `hit` stand for the ray's own.
void FunctionBinding::fill(ChannelValues& out, const Ray& ray, const Vec3& direction,
                           const Hit& hit, const Tracer& tracer,
                           const MaterialVariables* material) const {
    const ToFunction space =
        world_to_function(transform_, transformed_, hit.frame, tracer.scene().geometry());
    if (channels_ & kDirection) set(out, Channel::Dx, space.direction(direction));
    if (channels_ & kNormal) set(out, Channel::Nx, space.direction(hit.normal));
    if (channels_ & kPoint) set(out, Channel::Px, space.point(hit.position));
    if (channels_ & kScalars) fill_scalars(out, ray, hit, space.sigma);
    if (channels_ & kSpace) fill_space(out, space);
    if (material) fill_material(out, space, *material);
}

EvalState& FunctionBinding::begin(const Ray& ray, TraceContext& context,
                                  const MaterialVariables* material) const {
    ChannelValues& out = context.channels;
    fill(out, ray, ray.direction, ray.hit, context.tracer, material);
    program_.begin(context.eval, out);
    context.eval.clear_error();
    return context.eval;
}

std::optional<Lanes> FunctionBinding::evaluate_lanes(const Ray& ray, std::span<const RayHit> hits,
                                                     TraceContext& context) const {
    for (std::size_t k = 0; k < hits.size(); ++k)
        fill(context.lane_channels[k], ray, hits[k].direction, hits[k].hit, context.tracer,
             nullptr);
    const auto channels = std::span(context.lane_channels).first(hits.size());
    return program_.evaluate_lanes(0, channels, context.eval);
}

Vec3 FunctionBinding::to_world(const Vec3& d, const Ray& ray, const TraceContext& context) const {
    Vec3 v = transformed_ ? transform_.forward.vector(d) * (1 / transform_.size()) : d;
    if (ray.hit.frame != kWorld) {
        const Transform placed = context.tracer.scene().geometry().frame(ray.hit.frame);
        v = placed.forward.vector(v) * (1 / placed.size());
    }
    return v;
}

Vec3 FunctionBinding::to_function(const Vec3& d, const Ray& ray,
                                  const TraceContext& context) const {
    return world_to_function(transform_, transformed_, ray.hit.frame,
                             context.tracer.scene().geometry())
        .direction(d);
}

std::vector<ExpressionRequest> three_expressions(const Primitive& primitive) {
    require_arguments(primitive, 4);
    return {{primitive.strings[0], -1}, {primitive.strings[1], -1}, {primitive.strings[2], -1}};
}

}  // namespace lightwalk
