// Ray casting in a synthetic furnished room, one ray at a time and in packets. Items are rays.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/math/random.h"
#include "core/model/primitive.h"

namespace {

using namespace lightwalk;

constexpr int kWidth = 256, kHeight = 128;
constexpr int kBlock = 4;  ///< packets are blocks of 4 by 4 pixels
const Vec3 kEye{1, 1, 1.6}, kLamp{5, 4, 2.9};

/// A room of 10 by 8 by 3 m with `boxes` boxes in it, half of them turned, and a few spheres and
/// cylinders.
class Room {
  public:
    explicit Room(int boxes) : random_(RandomStream::of_pixel(1, 0, 0, 0)) {
        add_box({5, 4, 1.5}, {5, 4, 1.5}, 0);
        for (int i = 0; i < boxes; ++i) {
            const Vec3 at{10 * random_.next(), 8 * random_.next(), 1.2 * random_.next()};
            const Vec3 half{size(), size(), size()};
            add_box(at, half, random_.next() < 0.5 ? 0 : 6 * random_.next());
            if (i % 20 == 0) add(PrimitiveType::sphere, {at.x, at.y, at.z + 0.3, 0.1});
            if (i % 20 == 1) add(PrimitiveType::cylinder, {at.x, at.y, 0, at.x, at.y, 1, 0.03});
        }
    }
    /// While the room stays.
    [[nodiscard]] Geometry build() {
        shapes_ = make_shapes(list_, SerialTaskRunner());
        table_ = SurfaceTable();
        table_.add(list_, shapes_, 0);
        table_.set_traits(ModifierTraits({}, {true, false, ShadowClass::blocks}));
        return Geometry({&table_, std::vector<ModelGeometry>(1)});
    }

  private:
    double size() {
        const double x = random_.next();
        return 0.02 + 0.25 * x * x;
    }
    void add(PrimitiveType type, std::vector<double> reals) {
        Primitive primitive;
        primitive.type = type;
        primitive.reals = std::move(reals);
        list_.add(primitive);
    }
    void add_box(const Vec3& center, const Vec3& half, double turn) {
        constexpr unsigned kFaces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                           {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
        for (const auto& face : kFaces) {
            std::vector<double> reals;
            for (const unsigned corner : face) {
                const double x = (corner & 1U) != 0 ? half.x : -half.x,
                             y = (corner & 2U) != 0 ? half.y : -half.y;
                reals.push_back(center.x + x * std::cos(turn) - y * std::sin(turn));
                reals.push_back(center.y + x * std::sin(turn) + y * std::cos(turn));
                reals.push_back(center.z + ((corner & 4U) != 0 ? half.z : -half.z));
            }
            add(PrimitiveType::polygon, reals);
        }
    }
    RandomStream random_;
    SurfaceList list_;
    SurfaceShapes shapes_;
    SurfaceTable table_;
};

std::vector<RaySegment> primary_rays() {
    std::vector<RaySegment> rays;
    for (int by = 0; by < kHeight; by += kBlock) {
        for (int bx = 0; bx < kWidth; bx += kBlock) {
            for (int i = 0; i < kBlock * kBlock; ++i) {
                const int column = bx + i % kBlock, row = by + i / kBlock;
                const double x = (column + 0.5) / kWidth - 0.5, y = (row + 0.5) / kHeight - 0.5;
                rays.push_back({kEye, normalize(Vec3{1, 1.6 * x + 0.6, 0.8 * y - 0.1})});
            }
        }
    }
    return rays;
}

/// From where the primary rays end: cosine-distributed, or 16 shadow rays towards one lamp.
std::vector<RaySegment> secondary_rays(const Geometry& geometry, bool to_lamp) {
    RandomStream random = RandomStream::of_pixel(2, 0, 0, 0);
    std::vector<RaySegment> rays;
    for (const RaySegment& primary : primary_rays()) {
        const Hit hit = geometry.intersect(primary);
        if (!hit.exists()) continue;
        const Vec3 n = hit.cos_out > 0 ? hit.normal : -hit.normal, u = perpendicular(n),
                   v = cross(n, u);
        if (to_lamp) {
            const Vec3 way = kLamp + Vec3{random.next(), random.next(), 0} * 0.3 - hit.position;
            rays.push_back({hit.position, normalize(way), length(way)});
        } else {
            const double r2 = random.next(), angle = 2 * kPi * random.next(), r = std::sqrt(r2);
            rays.push_back(
                {hit.position, normalize(u * (r * std::cos(angle)) + v * (r * std::sin(angle)) +
                                         n * std::sqrt(1 - r2))});
        }
    }
    return rays;
}

void count_rays(benchmark::State& state, const std::vector<RaySegment>& rays) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rays.size()));
}

void single_hits(benchmark::State& state, const Geometry& geometry,
                 const std::vector<RaySegment>& rays) {
    for ([[maybe_unused]] auto iteration : state) {
        for (const RaySegment& ray : rays) benchmark::DoNotOptimize(geometry.intersect(ray));
    }
    count_rays(state, rays);
}

void packet_hits(benchmark::State& state, const Geometry& geometry,
                 const std::vector<RaySegment>& rays) {
    std::vector<Hit> hits(rays.size());
    for ([[maybe_unused]] auto iteration : state) {
        geometry.intersect(rays, hits);
        benchmark::DoNotOptimize(hits.data());
    }
    count_rays(state, rays);
}

void primary_single(benchmark::State& state) {
    Room room(static_cast<int>(state.range(0)));
    single_hits(state, room.build(), primary_rays());
}
void primary_packet(benchmark::State& state) {
    Room room(static_cast<int>(state.range(0)));
    packet_hits(state, room.build(), primary_rays());
}
void diffuse_single(benchmark::State& state) {
    Room room(static_cast<int>(state.range(0)));
    const Geometry geometry = room.build();
    single_hits(state, geometry, secondary_rays(geometry, false));
}
void diffuse_packet(benchmark::State& state) {
    Room room(static_cast<int>(state.range(0)));
    const Geometry geometry = room.build();
    packet_hits(state, geometry, secondary_rays(geometry, false));
}
void shadow_single(benchmark::State& state) {
    Room room(static_cast<int>(state.range(0)));
    const Geometry geometry = room.build();
    const std::vector<RaySegment> rays = secondary_rays(geometry, true);
    for ([[maybe_unused]] auto iteration : state) {
        for (const RaySegment& ray : rays)
            benchmark::DoNotOptimize(geometry.visibility(ray, kNoSurface));
    }
    count_rays(state, rays);
}
void build_room(benchmark::State& state) {
    Room room(static_cast<int>(state.range(0)));
    std::size_t bytes = 0;
    for ([[maybe_unused]] auto iteration : state) bytes = room.build().memory().tree;
    state.counters["bytes"] = static_cast<double>(bytes);
}

constexpr int kBoxes[] = {300, 15000};

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): how Google Benchmark registers
BENCHMARK(primary_single)->Arg(kBoxes[0])->Arg(kBoxes[1]);
BENCHMARK(primary_packet)->Arg(kBoxes[0])->Arg(kBoxes[1]);
BENCHMARK(diffuse_single)->Arg(kBoxes[0])->Arg(kBoxes[1]);
BENCHMARK(diffuse_packet)->Arg(kBoxes[0])->Arg(kBoxes[1]);
BENCHMARK(shadow_single)->Arg(kBoxes[0])->Arg(kBoxes[1]);
BENCHMARK(build_room)->Arg(kBoxes[0])->Arg(kBoxes[1])->Unit(benchmark::kMillisecond);
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

}  // namespace

BENCHMARK_MAIN();
