#include "core/function/prism.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/function/library.h"
#include "core/math/vec3.h"

namespace lightwalk::function {
namespace {

/// Bounds on the tracing: light that is totally reflected for ever never gets weaker.
constexpr int kDeepest = 100;
constexpr int kMostSteps = 20000;

/// alpha is flat, across x; beta and gamma slope; delta is the plane outside them.
enum class Face { alpha, beta, gamma, delta };

struct Polarisation {
    double parallel = 0, perpendicular = 0;
    [[nodiscard]] double energy() const {
        return parallel * parallel + perpendicular * perpendicular;
    }
};

struct PrismRay {
    Vec3 direction;
    std::array<Polarisation, 2> light{{{1, 0}, {0, 1}}};
    double energy = 1;
    double medium = 1;  ///< index of refraction where it runs
    Face from = Face::alpha;
};

struct Prism {
    double a, b, depth, index, threshold;
    Face metal;  ///< delta: none
    double reflectance, merge_angle, aim_angle;
};

bool within(double x, double low, double high) {
    return x >= low && x <= high;
}

bool read_prism(std::span<const double> reals, Prism& prism) {
    if (reals.size() < 10) return false;
    const int metal = rounded_index(reals[6]);
    prism = {reals[0], reals[1], reals[3],
             reals[4], reals[5], metal == 1 ? Face::beta : metal == 2 ? Face::gamma : Face::delta,
             reals[7], reals[8], reals[9]};
    const bool sizes = prism.a >= 0 && prism.b >= 0 && reals[2] >= 0 && prism.depth >= 0;
    const bool optics = prism.index >= 1 && prism.threshold >= 0 && prism.threshold < 1 &&
                        (metal == 1 || metal == 2 || metal == 4) &&
                        (metal == 4 || within(prism.reflectance, 0, 1));
    return sizes && optics && prism.merge_angle > 0 && prism.aim_angle >= 0;
}

/// Turn about z by the angle whose cosine and sine are c and s.
Vec3 turn(const Vec3& v, double c, double s) {
    return normalize(Vec3{v.x * c + v.y * s, -v.x * s + v.y * c, v.z});
}

Vec3 parallel_axis(const Vec3& v) {
    return normalize(Vec3{v.y * v.y + v.z * v.z, -v.x * v.y, -v.x * v.z});
}
Vec3 perpendicular_axis(const Vec3& v) {
    return normalize(Vec3{0, -v.z, v.y});
}

/// Follows light inside the panel, and lists what leaves it.
class PrismTracer {
  public:
    PrismTracer(const Prism& prism, std::vector<double>& rays) : prism_(prism), rays_(rays) {
        const double beta = std::sqrt(prism.a * prism.a + prism.depth * prism.depth);
        const double gamma = std::sqrt(prism.b * prism.b + prism.depth * prism.depth);
        cos_beta_ = prism.a / beta;
        sin_beta_ = prism.depth / beta;
        cos_gamma_ = prism.b / gamma;
        sin_gamma_ = -prism.depth / gamma;
    }

    void trace(const PrismRay& ray, Face to);

  private:
    void at_alpha(const PrismRay& ray);
    void at_beta(const PrismRay& ray);
    void at_gamma(const PrismRay& ray);
    void follow(PrismRay ray, double probability, Face to);
    void leave(const PrismRay& ray);

    [[nodiscard]] double alpha_to_beta(const PrismRay& ray) const;
    [[nodiscard]] double beta_to_alpha(const PrismRay& ray) const;
    [[nodiscard]] double gamma_to_alpha(const PrismRay& ray) const;

    [[nodiscard]] PrismRay turned(PrismRay ray, double c, double s) const;
    [[nodiscard]] PrismRay reflected(PrismRay ray, Face at) const;
    [[nodiscard]] PrismRay transmitted(PrismRay ray, Face at) const;
    template <class Operation>
    [[nodiscard]] PrismRay in_frame(const PrismRay& ray, Face at, const Operation& operation) const;

    const Prism& prism_;
    std::vector<double>& rays_;
    double cos_beta_, sin_beta_, cos_gamma_, sin_gamma_;
    int depth_ = 0;
    int steps_ = 0;
};

// The share of the light from one face that meets another, for direction (x, y) across the grooves.
double PrismTracer::alpha_to_beta(const PrismRay& ray) const {
    if (ray.direction.x == 0) return 0;
    const double t = ray.direction.y / ray.direction.x;
    if (t > prism_.b / prism_.depth) return 1;
    if (t >= -prism_.a / prism_.depth) return (prism_.a + t * prism_.depth) / (prism_.a + prism_.b);
    return 0;
}
double PrismTracer::beta_to_alpha(const PrismRay& ray) const {
    if (ray.direction.x == 0) return 0;
    const double t = ray.direction.y / ray.direction.x;
    if (t > prism_.b / prism_.depth) return (prism_.a + prism_.b) / (prism_.a + t * prism_.depth);
    return t >= -prism_.a / prism_.depth ? 1 : 0;
}
double PrismTracer::gamma_to_alpha(const PrismRay& ray) const {
    if (ray.direction.x == 0) return 0;
    const double t = ray.direction.y / ray.direction.x;
    if (t > prism_.b / prism_.depth) return 0;
    if (t >= -prism_.a / prism_.depth) return 1;
    return (prism_.a + prism_.b) / (prism_.b - t * prism_.depth);
}

PrismRay PrismTracer::turned(PrismRay ray, double c, double s) const {
    const Vec3 old = ray.direction;
    ray.direction = turn(old, c, s);
    const Vec3& now = ray.direction;
    if ((old.y == 0 && old.z == 0) || (now.y == 0 && now.z == 0)) return ray;
    const Vec3 p1 = turn(parallel_axis(old), c, s), s1 = turn(perpendicular_axis(old), c, s);
    const Vec3 p2 = parallel_axis(now), s2 = perpendicular_axis(now);
    for (Polarisation& light : ray.light) {
        light = {light.parallel * dot(p1, p2) + light.perpendicular * dot(s1, p2),
                 light.parallel * dot(p1, s2) + light.perpendicular * dot(s1, s2)};
    }
    return ray;
}

/// Fresnel's quantities of a ray that meets a face across x.
struct Incidence {
    Incidence(const PrismRay& ray, double index) {
        const Vec3& d = ray.direction;
        const double s2 = d.y * d.y + d.z * d.z;
        cosine = std::abs(d.x);
        squared_index = ray.medium == 1 ? index * index : 1 / (index * index);
        total = std::sqrt(s2) > std::sqrt(squared_index);
        refracted = std::sqrt(std::max(squared_index - s2, 0.0));
    }
    double cosine = 0, squared_index = 0, refracted = 0;
    bool total = false;
};

/// Scale both polarisations; returns the change of energy, summed over the two.
double scale(PrismRay& ray, double parallel, double perpendicular) {
    double sum = 0;
    for (Polarisation& light : ray.light) {
        const double before = light.energy();
        light.parallel *= parallel;
        light.perpendicular *= perpendicular;
        if (before > 0) sum += light.energy() / before;
    }
    return sum;
}

PrismRay PrismTracer::reflected(PrismRay ray, Face at) const {
    const Incidence in(ray, prism_.index);
    ray.direction.x = -ray.direction.x;
    const bool metal = at == prism_.metal && at != Face::delta;
    if (in.total || metal) {
        if (metal) ray.energy *= prism_.reflectance;
        return ray;
    }
    const double rc = in.squared_index * in.cosine;
    const double sum = scale(ray, (rc - in.refracted) / (rc + in.refracted),
                             (in.cosine - in.refracted) / (in.cosine + in.refracted));
    ray.energy *= 0.5 * sum;
    return ray;
}

PrismRay PrismTracer::transmitted(PrismRay ray, Face at) const {
    const Incidence in(ray, prism_.index);
    if (in.total || (at == prism_.metal && at != Face::delta)) {
        ray.energy = 0;
        return ray;
    }
    const Vec3 d = ray.direction;
    const double ratio = std::sqrt(in.squared_index);
    const double s2 = d.y * d.y + d.z * d.z;
    const double sign = d.x < 0 ? -1 : 1;
    ray.direction = {sign * std::sqrt(1 - s2 / in.squared_index), d.y / ratio, d.z / ratio};
    const double sum =
        scale(ray, 2 * ratio * in.cosine / (in.refracted + in.squared_index * in.cosine),
              2 * in.cosine / (in.cosine + in.refracted));
    ray.energy = ray.energy / 2 * (in.refracted / in.cosine) * sum;
    ray.medium = ray.medium == 1 ? prism_.index : 1;
    return ray;
}

/// Do something in the frame of a sloped face, and come back to alpha's.
template <class Operation>
PrismRay PrismTracer::in_frame(const PrismRay& ray, Face at, const Operation& operation) const {
    const double c = at == Face::beta ? cos_beta_ : cos_gamma_;
    const double s = at == Face::beta ? sin_beta_ : sin_gamma_;
    return turned(operation(turned(ray, c, s)), c, -s);
}

void PrismTracer::follow(PrismRay ray, double probability, Face to) {
    ray.energy *= probability;
    if (ray.energy > prism_.threshold) trace(ray, to);
}

void PrismTracer::leave(const PrismRay& ray) {
    if (!(ray.energy > prism_.threshold)) return;
    const double angle = std::atan2(ray.direction.y, ray.direction.x);
    for (std::size_t i = 0; i < rays_.size(); i += 4) {
        if (std::abs(std::atan2(rays_[i + 1], rays_[i]) - angle) < prism_.merge_angle) {
            rays_[i + 3] += ray.energy;
            return;
        }
    }
    rays_.insert(rays_.end(), {ray.direction.x, ray.direction.y, ray.direction.z, ray.energy});
}

void PrismTracer::at_alpha(const PrismRay& ray) {
    PrismRay inside =
        ray.from == Face::alpha ? transmitted(ray, Face::alpha) : reflected(ray, Face::alpha);
    if (ray.from == Face::alpha) leave(reflected(ray, Face::alpha));
    inside.from = Face::alpha;
    const double to_beta = alpha_to_beta(inside);
    follow(inside, to_beta, Face::beta);
    follow(inside, 1 - to_beta, Face::gamma);
    if (ray.from != Face::alpha) leave(transmitted(ray, Face::alpha));
}

void PrismTracer::at_beta(const PrismRay& ray) {
    PrismRay f =
        in_frame(ray, Face::beta, [&](const PrismRay& r) { return reflected(r, Face::beta); });
    PrismRay q =
        in_frame(ray, Face::beta, [&](const PrismRay& r) { return transmitted(r, Face::beta); });
    f.from = Face::beta;
    q.from = Face::gamma;  // as Radiance has it
    PrismRay& inner = ray.medium > 1 ? f : q;
    PrismRay& outer = ray.medium > 1 ? q : f;
    const auto inside = [&] {
        follow(inner, beta_to_alpha(inner), Face::alpha);
        follow(inner, 1 - beta_to_alpha(inner), Face::gamma);
    };
    const auto outside = [&] {
        follow(outer, 1 - beta_to_alpha(outer), Face::gamma);
        follow(outer, beta_to_alpha(outer), Face::delta);
    };
    if (ray.medium > 1) inside();
    outside();
    if (!(ray.medium > 1)) inside();
}

void PrismTracer::at_gamma(const PrismRay& ray) {
    PrismRay f =
        in_frame(ray, Face::gamma, [&](const PrismRay& r) { return reflected(r, Face::gamma); });
    PrismRay q =
        in_frame(ray, Face::gamma, [&](const PrismRay& r) { return transmitted(r, Face::gamma); });
    f.from = q.from = Face::gamma;
    PrismRay& inner = ray.medium > 1 ? f : q;
    PrismRay& outer = ray.medium > 1 ? q : f;
    const auto inside = [&] {
        follow(inner, gamma_to_alpha(inner), Face::alpha);
        follow(inner, 1 - gamma_to_alpha(inner), Face::beta);
    };
    const auto outside = [&] {
        follow(outer, 1 - gamma_to_alpha(outer), Face::beta);
        follow(outer, gamma_to_alpha(outer), Face::delta);
    };
    if (ray.medium > 1) inside();
    outside();
    if (!(ray.medium > 1)) inside();
}

void PrismTracer::trace(const PrismRay& ray, Face to) {
    if (depth_ >= kDeepest || ++steps_ > kMostSteps) return;
    ++depth_;
    switch (to) {
        case Face::alpha:
            at_alpha(ray);
            break;
        case Face::beta:
            at_beta(ray);
            break;
        case Face::gamma:
            at_gamma(ray);
            break;
        case Face::delta:
            if (ray.from == Face::delta) {
                follow(ray, alpha_to_beta(ray), Face::beta);
                follow(ray, 1 - alpha_to_beta(ray), Face::gamma);
            } else {
                leave(ray);
            }
            break;
    }
    --depth_;
}

Vec3 vector(const ChannelValues& channels, Channel first) {
    const auto i = static_cast<std::size_t>(first);
    return {channels[i], channels[i + 1], channels[i + 2]};
}

void sort_by_energy(std::vector<double>& rays) {
    for (std::size_t j = 0; j < rays.size(); j += 4) {
        for (std::size_t i = j + 4; i < rays.size(); i += 4) {
            if (rays[j + 3] < rays[i + 3]) {
                std::swap_ranges(rays.begin() + static_cast<std::ptrdiff_t>(i),
                                 rays.begin() + static_cast<std::ptrdiff_t>(i + 4),
                                 rays.begin() + static_cast<std::ptrdiff_t>(j));
            }
        }
    }
}

/// Direction and energy of each ray, four numbers. Nothing when Dx is 0.
/// @return  false when a real argument is missing or out of range
bool trace_prism(const ChannelValues& channels, std::span<const double> reals,
                 std::vector<double>& rays) {
    Prism prism{};
    if (!read_prism(reals, prism)) return false;
    PrismRay ray;
    ray.direction = vector(channels, Channel::Dx);
    if (!(ray.direction.x > 0) && !(ray.direction.x < 0)) return true;
    const Face start = ray.direction.x > 0 ? Face::alpha : Face::delta;
    ray.from = start;
    PrismTracer(prism, rays).trace(ray, start);

    const Vec3 aim = vector(channels, Channel::DxA);
    if (aim.x != 0 || aim.y != 0 || aim.z != 0) {
        const double angle = std::atan2(aim.y, aim.x);
        for (std::size_t i = 0; i < rays.size(); i += 4) {
            if (std::abs(std::atan2(rays[i + 1], rays[i]) - angle) > prism.aim_angle)
                rays[i + 3] = 0;
        }
    }
    sort_by_energy(rays);
    return true;
}

double prism_value(const ChannelValues& channels, std::span<const double> rays, double v, double d,
                   double n) {
    const int component = rounded_index(v);
    if (component < 0 || component > 3) return std::numeric_limits<double>::quiet_NaN();
    const double dx = channels[static_cast<std::size_t>(Channel::Dx)];
    const Vec3 aim = vector(channels, Channel::DxA);
    const bool aimed = aim.x != 0 || aim.y != 0 || aim.z != 0;
    int wanted = rounded_index(n);
    if (aimed && wanted == 2) wanted = 1;
    const double side = rounded_index(d) * (dx < 0 ? -1.0 : 1.0);
    int count = 0;
    for (std::size_t i = 0; i < rays.size(); i += 4) {
        if (rays[i] * side >= 0 && ++count == wanted)
            return rays[i + static_cast<std::size_t>(component)];
    }
    return component == 0 && dx != 0 ? 1 : 0;
}

}  // namespace

double fprism_val(const ChannelValues& channels, std::span<const double> reals, double v, double d,
                  double n, EvalState::PrismRays& cache) {
    if (!cache.valid) {
        cache.rays.clear();
        if (!trace_prism(channels, reals, cache.rays))
            return std::numeric_limits<double>::quiet_NaN();
        cache.valid = true;
    }
    return prism_value(channels, cache.rays, v, d, n);
}

}  // namespace lightwalk::function
