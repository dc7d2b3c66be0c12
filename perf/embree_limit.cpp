// The limit: how fast bare Embree, without any of our code, traces the rays of a view on one
// thread. Quadrics are tessellated, polygons fanned, instances instanced. Usage: embree_limit
// VIEW.vf SCENE... (in the model's folder)
#include <embree3/rtcore.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "core/geometry/shapes.h"
#include "core/model/transform_args.h"
#include "core/view/view.h"
#include "io/options/view_text.h"
#include "io/scene/file_resources.h"
#include "io/scene/scene_reader.h"

namespace lightwalk {
namespace {

class PrintWarnings final : public WarningSink {
  public:
    void warn(const std::string&) override {}
};

constexpr int kSides = 24;

struct Soup {
    std::vector<float> vertices;
    std::vector<unsigned> indices;
    unsigned add(const Vec3& p) {
        for (std::size_t k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(p[k]));
        return static_cast<unsigned>(vertices.size() / 3 - 1);
    }
    void triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
        for (const Vec3& p : {a, b, c}) indices.push_back(add(p));
    }
    void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
        triangle(a, b, c);
        triangle(a, c, d);
    }
};

/// Surface of revolution between two circles.
void add_band(Soup& soup, const Vec3& p0, double r0, const Vec3& p1, double r1, const Vec3& axis) {
    const Vec3 u = perpendicular(axis), v = cross(axis, u);
    for (int i = 0; i < kSides; ++i) {
        const double a = 2 * kPi * i / kSides, b = 2 * kPi * (i + 1) / kSides;
        const Vec3 da = u * std::cos(a) + v * std::sin(a), db = u * std::cos(b) + v * std::sin(b);
        soup.quad(p0 + da * r0, p0 + db * r0, p1 + db * r1, p1 + da * r1);
    }
}

struct AddShape {
    Soup& soup;
    void operator()(std::monostate) const {}
    void operator()(const SourceShape&) const {}
    void operator()(const PolygonShape& s) const {
        for (std::size_t i = 2; i < s.vertices.size(); ++i) {
            soup.triangle(s.vertices[0], s.vertices[i - 1], s.vertices[i]);
        }
    }
    void operator()(const SphereShape& s) const {
        for (int i = 0; i < kSides / 2; ++i) {
            const double a = 2 * kPi * i / kSides, b = 2 * kPi * (i + 1) / kSides;
            const Vec3 z{0, 0, 1};
            add_band(soup, s.center - z * (s.radius * std::cos(a)), s.radius * std::sin(a),
                     s.center - z * (s.radius * std::cos(b)), s.radius * std::sin(b), z);
        }
    }
    void operator()(const ConeShape& s) const { add_band(soup, s.p0, s.r0, s.p1, s.r1, s.axis); }
    void operator()(const RingShape& s) const {
        add_band(soup, s.center, s.r0, s.center, s.r1, s.normal);
    }
};

class BareScene {
  public:
    BareScene(const Model& model, FileResources& resources) : device_(rtcNewDevice("threads=1")) {
        scene_ = build(model, resources);
    }
    ~BareScene() {
        for (auto& [name, scene] : models_) rtcReleaseScene(scene);
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    BareScene(const BareScene&) = delete;
    BareScene& operator=(const BareScene&) = delete;
    [[nodiscard]] RTCScene get() const { return scene_; }

  private:
    RTCScene build(const Model& model, FileResources& resources) {
        RTCScene scene = rtcNewScene(device_);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
        Soup soup;
        for (std::size_t i = 0; i < model.surfaces.size(); ++i) {
            const SurfacePrimitive surface = model.surfaces[i];
            if (surface.type == PrimitiveType::instance)
                instance(scene, surface, resources);
            else if (surface.type != PrimitiveType::mesh)
                std::visit(AddShape{soup}, make_shape(surface).shape);
        }
        attach(scene, soup);
        rtcCommitScene(scene);
        return scene;
    }

    void attach(RTCScene scene, const Soup& soup) {
        if (soup.indices.empty()) return;
        RTCGeometry triangles = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* v = rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                          12, soup.vertices.size() / 3);
        std::copy(soup.vertices.begin(), soup.vertices.end(), static_cast<float*>(v));
        void* i = rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                          soup.indices.size() / 3);
        std::copy(soup.indices.begin(), soup.indices.end(), static_cast<unsigned*>(i));
        rtcCommitGeometry(triangles);
        rtcAttachGeometry(scene, triangles);
        rtcReleaseGeometry(triangles);
    }

    void instance(RTCScene scene, const SurfacePrimitive& surface, FileResources& resources) {
        const std::vector<std::string> strings = surface.strings.to_strings();
        RTCScene& part = models_[strings.at(0)];
        if (!part) {
            const auto model = resources.octree(strings[0]);
            part = build(*model, resources);
        }
        const Matrix m = parse_transform(std::span(strings).subspan(1)).transform.forward;
        float columns[12];
        for (std::size_t r = 0; r < 4; ++r) {
            for (std::size_t k = 0; k < 3; ++k)
                columns[3 * r + k] = static_cast<float>(m.row[r][k]);
        }
        RTCGeometry placed = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(placed, part);
        rtcSetGeometryTransform(placed, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(placed);
        rtcAttachGeometry(scene, placed);
        rtcReleaseGeometry(placed);
    }

    RTCDevice device_;
    RTCScene scene_ = nullptr;
    std::map<std::string, RTCScene> models_;
};

struct FlatRay {
    Vec3 o, d;
    float far;
};

template <class Trace>
void report(const char* what, const std::vector<FlatRay>& rays, const Trace& trace) {
    double best = 1e30;
    for (int run = 0; run < 5; ++run) {
        const auto start = std::chrono::steady_clock::now();
        trace();
        best = std::min(
            best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    std::printf("%-28s %8zu rays  %6.2f million/s\n", what, rays.size(),
                static_cast<double>(rays.size()) / best * 1e-6);
}

/// Sixteen rays at a time.
template <bool kOccluded>
void trace_packets(RTCScene scene, const std::vector<FlatRay>& rays, std::vector<float>* distances,
                   bool coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    alignas(64) int valid[16];
    alignas(64) RTCRayHit16 hit;
    for (std::size_t at = 0; at < rays.size(); at += 16) {
        for (std::size_t k = 0; k < 16; ++k) {
            valid[k] = at + k < rays.size() ? -1 : 0;
            const FlatRay& r = rays[std::min(at + k, rays.size() - 1)];
            hit.ray.org_x[k] = static_cast<float>(r.o.x);
            hit.ray.org_y[k] = static_cast<float>(r.o.y);
            hit.ray.org_z[k] = static_cast<float>(r.o.z);
            hit.ray.dir_x[k] = static_cast<float>(r.d.x);
            hit.ray.dir_y[k] = static_cast<float>(r.d.y);
            hit.ray.dir_z[k] = static_cast<float>(r.d.z);
            hit.ray.tnear[k] = 1e-4f;
            hit.ray.tfar[k] = r.far;
            hit.ray.time[k] = 0;
            hit.ray.mask[k] = ~0u;
            hit.ray.flags[k] = 0;
            hit.ray.id[k] = 0;
            hit.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
            hit.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        }
        if constexpr (kOccluded)
            rtcOccluded16(valid, scene, &context, &hit.ray);
        else
            rtcIntersect16(valid, scene, &context, &hit);
        for (std::size_t k = 0; distances && k < 16 && at + k < rays.size(); ++k) {
            (*distances)[at + k] =
                hit.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID ? -1.0f : hit.ray.tfar[k];
        }
    }
}

void trace_singly(RTCScene scene, const std::vector<FlatRay>& rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (const FlatRay& r : rays) {
        RTCRayHit hit{};
        hit.ray = {static_cast<float>(r.o.x),
                   static_cast<float>(r.o.y),
                   static_cast<float>(r.o.z),
                   1e-4f,
                   static_cast<float>(r.d.x),
                   static_cast<float>(r.d.y),
                   static_cast<float>(r.d.z),
                   0,
                   r.far,
                   ~0u,
                   0,
                   0};
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &hit);
    }
}

int run(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: embree_limit VIEW.vf SCENE...\n");
        return 2;
    }
    PrintWarnings warnings;
    const std::vector<std::string> files(argv + 2, argv + argc);
    const auto model = read_scene(files, {}, warnings);
    FileResources resources(LibraryPath::from_environment(), false, warnings);
    const BareScene scene(*model, resources);
    View view;
    read_view_file(read_file(argv[1]), argv[1], view);
    const Camera camera(view);
    constexpr int kWidth = 640, kHeight = 480;
    std::vector<FlatRay> primary, shadow, diffuse;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const auto r = camera.ray((x + 0.5) / kWidth, (y + 0.5) / kHeight);
            if (r) primary.push_back({r->origin, r->direction, 1e30f});
        }
    }
    std::vector<float> distance(primary.size());
    trace_packets<false>(scene.get(), primary, &distance, true);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (std::size_t i = 0; i < primary.size(); ++i) {
        if (distance[i] < 0) continue;
        const Vec3 p = primary[i].o + primary[i].d * (static_cast<double>(distance[i]) - 1e-3);
        const Vec3 target{view.position.x, view.position.y,
                          view.position.z + 0.5};  // a lamp above the viewer
        shadow.push_back({p, normalize(target - p), static_cast<float>(length(target - p))});
        diffuse.push_back(
            {p, normalize(Vec3{uniform(random), uniform(random), uniform(random)}), 1e30f});
    }
    report("primary, packets of 16", primary,
           [&] { trace_packets<false>(scene.get(), primary, nullptr, true); });
    report("shadow, packets of 16", shadow,
           [&] { trace_packets<true>(scene.get(), shadow, nullptr, false); });
    report("diffuse, singly", diffuse, [&] { trace_singly(scene.get(), diffuse); });
    return 0;
}

}  // namespace
}  // namespace lightwalk

int main(int argc, char** argv) {
    try {
        return lightwalk::run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "embree_limit: %s\n", error.what());
        return 1;
    }
}
