#include "core/ambient/hemisphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/ambient/position_pool.h"

namespace lightwalk {
namespace {

constexpr int kFewestForTrading = 4;  ///< divisions from which close directions are avoided
constexpr int kTrades = 20;           ///< tries before a position is accepted as it is
constexpr int kFewestForExtras = 7;   ///< divisions above which extra samples make sense

/// The direction above a point of the disk of u and v.
Vec3 above(const DiskPoint& d, const Vec3& u, const Vec3& v, const Vec3& normal) {
    return u * d.x + v * d.y + normal * std::sqrt(std::max(0.0, 1 - d.x * d.x - d.y * d.y));
}

class Sampler {
  public:
    Sampler(Hemisphere& hemisphere, const HemisphereSampling& sampling, RandomStream& random,
            HemisphereRays& rays)
        : h_(hemisphere),
          sampling_(sampling),
          random_(random),
          rays_(rays),
          pool_(random.child()),
          places_(hemisphere.cells.size()),
          started_(hemisphere.cells.size()) {}

    void first_pass() {
        for (int i = h_.divisions - 1; i >= 0; --i) {
            for (int j = h_.divisions - 1; j >= 0; --j) {
                const SquarePosition s{random_.next(), random_.next()};
                const DiskPoint place =
                    h_.divisions >= kFewestForTrading ? apart(i, j, s) : disk(i, j, s);
                (void)start(i, j, place, 0);
            }
        }
        finish();
    }

    void extra_pass() {
        const std::vector<double> errors = error_map();
        double left = 0;
        for (const double e : errors) left += e;
        int budget = sampling_.extra;
        std::size_t k = 0;
        for (int i = 0; i < h_.divisions; ++i) {
            for (int j = 0; j < h_.divisions; ++j, ++k) {
                if (left <= kEpsilon || budget <= 0) return finish();
                const auto wanted = static_cast<int>(errors[k] * budget / left + random_.next());
                for (int m = 1; m <= wanted && budget > 0; ++m, --budget) {
                    if (!start(i, j, disk(i, j, {random_.next(), random_.next()}), m)) break;
                }
                left -= errors[k];
            }
        }
        finish();
    }

  private:
    [[nodiscard]] std::size_t at(int i, int j) const {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(h_.divisions) +
               static_cast<std::size_t>(j);
    }
    [[nodiscard]] DiskPoint disk(int i, int j, const SquarePosition& s) const {
        return square_to_disk((j + s.along_j) / h_.divisions, (i + s.along_i) / h_.divisions);
    }

    /// Whether a sampled neighbour has nearly the same direction: its triangles would be
    /// degenerate.
    [[nodiscard]] bool collides(int i, int j, const DiskPoint& d) const {
        const double least = kPi * 0.04 / (static_cast<double>(h_.divisions) * h_.divisions);
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, h_.divisions - 1); ++a) {
            for (int b = std::max(j - 1, 0); b <= std::min(j + 1, h_.divisions - 1); ++b) {
                if ((a == i && b == j) || !started_[at(a, b)]) continue;
                const DiskPoint& other = places_[at(a, b)];
                const double x = other.x - d.x, y = other.y - d.y;
                if (x * x + y * y < least) return true;
            }
        }
        return false;
    }
    DiskPoint apart(int i, int j, SquarePosition s) {
        for (int trade = 0; trade <= kTrades; ++trade) {
            const DiskPoint d = disk(i, j, s);
            if (!collides(i, j, d)) return d;
            if (trade < kTrades) s = pool_.trade(s);
        }
        return disk(i, j, {0.2 + 0.6 * random_.next(), 0.2 + 0.6 * random_.next()});
    }

    /// A ray that was started: sample number `m` of a cell.
    struct Sample {
        std::size_t cell = 0;
        int m = 0;
        Vec3 direction;
    };

    /// False: the ray may not start.
    bool start(int i, int j, const DiskPoint& d, int m) {
        const Vec3 direction = above(d, h_.u, h_.v, h_.normal);
        if (!rays_.start(direction)) return false;
        if (m == 0) {
            places_[at(i, j)] = d;
            started_[at(i, j)] = true;
        }
        pending_.push_back({at(i, j), m, direction});
        if (pending_.size() == HemisphereRays::kTogether) finish();
        return true;
    }

    void finish() {
        if (pending_.empty()) return;
        const std::span<const HemisphereAnswer> answers = rays_.trace();
        for (std::size_t k = 0; k < pending_.size(); ++k) take(k, answers[k]);
        pending_.clear();
    }

    void take(std::size_t number, const HemisphereAnswer& answer) {
        if (answer.distance <= kEpsilon) return;
        const Sample& sample = pending_[number];
        HemisphereCell& c = h_.cells[sample.cell];
        c.nearness = std::max(c.nearness, 1 / answer.distance);
        h_.sum -= c.value;
        if (sample.m == 0) {
            c.vertex = sample.direction * std::min(answer.distance, sampling_.farthest);
            c.value = answer.value;
            if (sampling_.tells) rays_.taken(number, sample.cell, 0, 1);
            ++h_.succeeded;
        } else {
            const auto share = 1 / static_cast<float>(sample.m + 1);
            const float kept = static_cast<float>(sample.m) * share;
            c.value = c.value * kept + answer.value * share;
            if (sampling_.tells) rays_.taken(number, sample.cell, kept, share);
        }
        h_.sum += c.value;
    }

    /// Where more samples are worth their while: differences of neighbours, scaled at the rim,
    /// blurred.
    [[nodiscard]] std::vector<double> error_map() const;

    Hemisphere& h_;
    const HemisphereSampling& sampling_;
    RandomStream& random_;
    HemisphereRays& rays_;
    PositionPool pool_;
    std::vector<DiskPoint> places_;      ///< of the cells' first samples
    std::vector<std::uint8_t> started_;  ///< cells whose first sample has started
    std::vector<Sample> pending_;
};

std::vector<double> Sampler::error_map() const {
    const int n = h_.divisions;
    std::vector<double> raw(h_.cells.size(), 0.0);
    const double scale = 1 / (sampling_.share + kEpsilon);
    const auto pair = [&](std::size_t p, std::size_t q) {
        const double a = static_cast<double>(brightness(h_.cells[p].value)),
                     b = static_cast<double>(brightness(h_.cells[q].value));
        const double error = scale * (a - b) * (a - b) / (a + b + kEpsilon);
        raw[p] += error;
        raw[q] += error;
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            if (i > 0) pair(at(i, j), at(i - 1, j));
            if (j > 0) pair(at(i, j), at(i, j - 1));
            if (i > 0 && j > 0) pair(at(i, j), at(i - 1, j - 1));
        }
    }
    for (int k = 0; k < n; ++k) {
        // Cells at the rim have fewer neighbours. Radiance's factors, as its values show them.
        const double rim = k == 0 || k == n - 1 ? 2 : 6.0 / 5;
        raw[at(k, 0)] *= rim;
        raw[at(k, n - 1)] *= rim;
        if (k == 0 || k == n - 1) continue;
        raw[at(0, k)] *= rim;
        raw[at(n - 1, k)] *= rim;
    }
    std::vector<double> blurred(raw.size(), 0.0);
    for (int i = 0; i + 1 < n; ++i) {
        for (int j = 0; j + 1 < n; ++j) {
            blurred[at(i, j)] +=
                0.5 * raw[at(i, j)] + 0.125 * (raw[at(i, j + 1)] + raw[at(i + 1, j)]);
            blurred[at(i, j + 1)] += 0.125 * raw[at(i, j)];
            blurred[at(i + 1, j)] += 0.125 * raw[at(i, j)];
        }
    }
    return blurred;
}

/// A random unit vector perpendicular to n, never from an axis close to it.
Vec3 random_tangent(const Vec3& n, RandomStream& random) {
    Vec3 seed{random.next() - 0.5, random.next() - 0.5, random.next() - 0.5};
    std::array<std::size_t, 3> order{0, 1, 2};
    for (std::size_t k = 2; k > 0; --k) {
        std::swap(order[k],
                  order[static_cast<std::size_t>(random.next() * static_cast<double>(k + 1))]);
    }
    for (std::size_t k = 3; k-- > 0;) {
        if (std::abs(n[order[k]]) >= 0.6) continue;
        seed[order[k]] = 1;
        break;
    }
    return normalize(cross(seed, n));
}

}  // namespace

DiskPoint square_to_disk(double x, double y) {
    const double a = 2 * x - 1, b = 2 * y - 1;
    double r = 0, phi = 0;
    if (a > -b) {
        r = a > b ? a : b;
        phi = a > b ? kPi / 4 * (b / a) : kPi / 4 * (2 - a / b);
    } else {
        r = a < b ? -a : -b;
        phi = a < b ? kPi / 4 * (4 + b / a) : b != 0 ? kPi / 4 * (6 - a / b) : 0;
    }
    r *= 0.9999999999999;  // keeps off the horizon; Radiance's factor, as its values show it
    return {r * std::cos(phi), r * std::sin(phi)};
}

HemisphereFrame::HemisphereFrame(const Vec3& n, RandomStream& random)
    : normal(n), u(random_tangent(n, random)), v(cross(n, u)) {}

Vec3 HemisphereFrame::above(const DiskPoint& d) const {
    return lightwalk::above(d, u, v, normal);
}

Vec3 sample_direction(const Vec3& normal, RandomStream random) {
    const HemisphereFrame frame(normal, random);
    const auto [along_i, along_j] = random.next_pair();
    return frame.above(square_to_disk(along_j, along_i));
}

Hemisphere sample_hemisphere(const Vec3& normal, const HemisphereSampling& sampling,
                             RandomStream random, HemisphereRays& rays) {
    Hemisphere h;
    h.normal = normal;
    h.u = random_tangent(normal, random);
    h.v = cross(normal, h.u);
    h.divisions = sampling.divisions;
    h.cells.resize(static_cast<std::size_t>(h.divisions) * static_cast<std::size_t>(h.divisions));
    Sampler sampler(h, sampling, random, rays);
    sampler.first_pass();
    if (h.complete() && h.divisions > kFewestForExtras && sampling.extra >= 4 * h.divisions)
        sampler.extra_pass();
    return h;
}

}  // namespace lightwalk
