#include "core/geometry/geometry.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/geometry/bounds.h"
#include "core/geometry/embree_leaves.h"
#include "core/geometry/embree_search.h"

// Embree proposes, doubles decide. Every surface is a user geometry whose box is a little too
// large, so that no rounding of Embree's single precision can hide a true crossing; PlacedScene
// then computes each crossing in double precision. The answer does not depend on the order of
// proposals, so packets give the same bits as single rays. Measured on interiors, this is also
// faster than triangles with a filter function.

namespace lightwalk {
/// Owners of Embree's objects.
namespace embree {
struct ReleaseDevice {
    void operator()(RTCDeviceTy* device) const noexcept { rtcReleaseDevice(device); }
};
struct ReleaseGeometry {
    void operator()(RTCGeometryTy* geometry) const noexcept { rtcReleaseGeometry(geometry); }
};
using DevicePtr = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using GeometryPtr = std::unique_ptr<RTCGeometryTy, ReleaseGeometry>;
}  // namespace embree

namespace {

/// From so many BVH primitives on a tree has quantized leaves, which need less memory. In small
/// meshes they are as fast as single primitives; with other surfaces some 3 % slower.
constexpr std::size_t kMostSinglePrimitives = std::size_t{1} << 17,
                      kMostSingleOfMesh = std::size_t{1} << 13;
constexpr double kUnreachable = 1e17;  ///< models farther away than this are left out [m]

/// Whether a point is nearer than kUnreachable along each axis; false for NaN.
bool is_within_reach(const Vec3& v) {
    return std::abs(v.x) < kUnreachable && std::abs(v.y) < kUnreachable &&
           std::abs(v.z) < kUnreachable;
}

/// A ray in Embree's coordinates.
struct EmbreeRay {
    std::array<float, 3> origin, direction;
    float end = 0;
    double start = 0;
};

/// Extend by a transformed box that is not empty. Called millions of times where a model is placed
/// thousands of times, therefore computed from centre and half size; the margins cover its
/// rounding.
void extend_transformed(Bounds& bounds, const Bounds& box, const Matrix& matrix) {
    const Vec3 center = matrix.point((box.lower + box.upper) * 0.5),
               half = (box.upper - box.lower) * 0.5;
    const auto absolute = [](const Vec3& v) {
        return Vec3{std::abs(v.x), std::abs(v.y), std::abs(v.z)};
    };
    const Vec3 reach = absolute(matrix.row[0]) * half.x + absolute(matrix.row[1]) * half.y +
                       absolute(matrix.row[2]) * half.z;
    bounds.extend(center - reach);
    bounds.extend(center + reach);
}

std::vector<Bounds> outline_of_tree(const Hierarchy& model) {
    std::vector<Bounds> boxes = model.instances.boxes;
    boxes.reserve(boxes.size() + model.bvh_primitives.size() + model.leaves.size());
    for (const QuantizedLeaf& leaf : model.leaves) boxes.push_back(leaf.box());
    for (std::size_t i = 0; i < model.bvh_primitives.size(); ++i)
        boxes.push_back(model.space.box(model.bvh_primitives.box(i, *model.primitives)));
    return outline_of(boxes);
}

}  // namespace

/// Embree's mask of valid lanes of a packet: -1 for lanes that hold a ray, else 0.
using PacketLanes = std::array<int, kPacket>;

struct Geometry::Impl {
    Impl(GeometryInput input, const std::string& embree_options, const TaskRunner& task_runner);

    [[nodiscard]] std::optional<EmbreeRay> embree_ray(const TracedRay& ray) const;
    void trace(NearestRay& ray) const;
    void trace(std::span<NearestRay> rays) const;
    void trace(ShadowRay& ray) const;
    void trace(std::span<ShadowRay> rays) const;
    template <class Traced, class Starts>
    void set_packet(std::span<Traced> rays, RTCRayHit16& packet, PacketLanes& valid,
                    Starts note_start) const;
    [[nodiscard]] bool is_blocked_again(ShadowRay& ray, const Blocker* last) const;
    [[nodiscard]] Hit finish(const RaySegment& segment, const NearestRay& ray) const;

    std::atomic<std::ptrdiff_t> embree_bytes{
        0};  ///< Embree may allocate from several threads while it builds
    std::string embree_message;
    Ablation ablation;
    PlacedScene placed;
    embree::DevicePtr device;  ///< outlives the scenes below
    std::vector<Hierarchy> models;
    Bounds box;  ///< of all geometry, relative to models[0].space.center, margins included

  private:
    void open_device(const std::string& options);
    void check(const char* doing) const;
    void add_surfaces(Hierarchy& model, const TaskRunner& task_runner);
    void add_instances(std::uint32_t model);
    [[nodiscard]] std::optional<Instance> instance_of(const PlacedChild& child,
                                                      const Hierarchy& around) const;
    [[nodiscard]] Bounds box_of(const Placement& placement, const Hierarchy& around) const;
};

Geometry::Impl::Impl(GeometryInput input, const std::string& embree_options,
                     const TaskRunner& task_runner)
    : ablation(input.ablation), placed(std::move(input), task_runner) {
    open_device(embree_options);
    models.resize(placed.model_count());
    const std::vector<SearchSpace> spaces = search_spaces(placed);
    for (std::size_t i = 0; i < models.size(); ++i) {
        models[i].primitives = &placed.primitives(static_cast<std::uint32_t>(i));
        models[i].space = spaces[i];
    }
    const std::span<const std::uint32_t> order = placed.paths().order();
    for (auto model = order.rbegin(); model != order.rend(); ++model) {
        Hierarchy& built = models[*model];
        built.scene.reset(rtcNewScene(device.get()));
        check("creating a scene");
        add_surfaces(built, task_runner);
        add_instances(*model);
        rtcSetSceneBuildQuality(built.scene.get(), RTC_BUILD_QUALITY_MEDIUM);
        rtcCommitScene(built.scene.get());
        check("building a search tree");
        if (*model != 0) built.outline = outline_of_tree(built);  // no model contains the scene
        built.bvh_primitives.boxes = std::vector<Bounds>();       // {} would keep the memory
        built.instances.boxes = std::vector<Bounds>();
    }
    box = bounds_of_tree(models[0].scene.get());
    for (Hierarchy& model : models) model.outline = std::vector<Bounds>();
}

/// No number of threads is set: it would limit oneTBB in the whole process.
void Geometry::Impl::open_device(const std::string& options) {
    device.reset(rtcNewDevice(options.c_str()));
    if (!device)  // one device takes a key of each thread's own memory, of which a process has 1024
        throw InputError(
            "Embree opens no more scenes: this process has some thousand open, or cannot start "
            "Embree at all");
    rtcSetDeviceErrorFunction(
        device.get(),
        [](void* message, RTCError, const char* text) {
            *static_cast<std::string*>(message) = text ? text : "";
        },
        &embree_message);
    rtcSetDeviceMemoryMonitorFunction(
        device.get(),
        [](void* bytes, ssize_t change, bool) {
            static_cast<std::atomic<std::ptrdiff_t>*>(bytes)->fetch_add(change,
                                                                        std::memory_order_relaxed);
            return true;
        },
        &embree_bytes);
}

void Geometry::Impl::check(const char* doing) const {
    const RTCError error = rtcGetDeviceError(device.get());
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw InputError(std::string("out of memory while ") + doing);
    throw std::runtime_error(std::string("Embree failed while ") + doing + ": " + embree_message);
}

void Geometry::Impl::add_surfaces(Hierarchy& model, const TaskRunner& task_runner) {
    model.bvh_primitives = divide_primitives(*model.primitives, task_runner, ablation.slices);
    if (model.bvh_primitives.size() == 0) return;
    const auto last = static_cast<std::uint32_t>(model.primitives->size() - 1);
    const bool is_mesh = model.primitives->is_triangle(last);  // meshes are models of their own
    const std::size_t most_single = is_mesh ? kMostSingleOfMesh : kMostSinglePrimitives;
    if (ablation.leaves && model.bvh_primitives.size() > most_single) {
        model.leaves = make_quantized_leaves(model.bvh_primitives, *model.primitives, model.space,
                                             device.get(), task_runner);
        check("clustering the surfaces");
        if (model.leaves.empty()) throw std::runtime_error("Embree has lost surfaces");
        model.bvh_primitives = BvhPrimitives();
    }
    const embree::GeometryPtr geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
    check("creating the surfaces");
    const bool in_leaves = !model.leaves.empty();
    rtcSetGeometryUserPrimitiveCount(
        geometry.get(),
        static_cast<unsigned>(in_leaves ? model.leaves.size() : model.bvh_primitives.size()));
    rtcSetGeometryUserData(geometry.get(), &model);
    rtcSetGeometryBoundsFunction(geometry.get(), in_leaves ? leaf_bounds : primitive_bounds,
                                 nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(),
                                    in_leaves ? intersect_leaf : intersect_primitive);
    rtcSetGeometryOccludedFunction(geometry.get(), in_leaves ? occlude_leaf : occlude_primitive);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(model.scene.get(), geometry.get(), kOwnSurfaces);
    check("adding the surfaces");
}

/// The instance of a placed model, with the transform from the enclosing model's search coordinates
/// to its own; nothing when it is empty or too far away.
std::optional<Instance> Geometry::Impl::instance_of(const PlacedChild& child,
                                                    const Hierarchy& around) const {
    const Placement& placement = *child.placement;
    const Hierarchy& model = models[placement.model];
    const Vec3 center = placement.transform.forward.point(model.space.center) - around.space.center;
    if (model.outline.empty() || !is_within_reach(center)) return std::nullopt;
    const Matrix& inverse = placement.transform.inverse;
    const std::array<Vec3, 4> rows{inverse.row[0], inverse.row[1], inverse.row[2],
                                   -inverse.vector(center)};
    Instance instance;
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t k = 0; k < 3; ++k)
            instance.inverse[3 * row + k] = static_cast<float>(rows[row][k]);
    }
    instance.scene = model.scene.get();
    instance.placement = child.placement;
    instance.first = child.first;
    return instance;
}

/// Box of everything that the search tree of a placed model can find, in the search coordinates of
/// the enclosing model.
Bounds Geometry::Impl::box_of(const Placement& placement, const Hierarchy& around) const {
    const Hierarchy& model = models[placement.model];
    Matrix matrix = placement.transform.forward;
    matrix.row[3] = matrix.point(model.space.center) - around.space.center;
    Bounds bounds;
    for (const Bounds& part : model.outline) extend_transformed(bounds, part, matrix);
    return grown(bounds, around.space.relative * magnitude(bounds));
}

void Geometry::Impl::add_instances(std::uint32_t model) {
    Hierarchy& around = models[model];
    Instances& instances = around.instances;
    for (const PlacedChild& child : placed.paths().children(model)) {
        const std::optional<Instance> instance = instance_of(child, around);
        if (!instance) continue;
        instances.all.push_back(*instance);
        instances.boxes.push_back(box_of(*child.placement, around));
    }
    if (instances.all.empty()) return;
    const embree::GeometryPtr geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
    check("creating the instances");
    rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(instances.all.size()));
    rtcSetGeometryUserData(geometry.get(), &instances);
    rtcSetGeometryBoundsFunction(geometry.get(), instance_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), intersect_instance);
    rtcSetGeometryOccludedFunction(geometry.get(), occlude_instance);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(around.scene.get(), geometry.get(), kInstances);
    check("adding the instances");
}

namespace {

void set_ray(RTCRay& ray, const EmbreeRay& from) {
    ray.org_x = from.origin[0];
    ray.org_y = from.origin[1];
    ray.org_z = from.origin[2];
    ray.tnear = 0;
    ray.dir_x = from.direction[0];
    ray.dir_y = from.direction[1];
    ray.dir_z = from.direction[2];
    ray.time = 0;
    ray.tfar = from.end;
    ray.mask = ~0U;
    ray.id = 0;
    ray.flags = 0;
}

void set_ray(RTCRay16& rays, unsigned i, const EmbreeRay& from) {
    rays.org_x[i] = from.origin[0];
    rays.org_y[i] = from.origin[1];
    rays.org_z[i] = from.origin[2];
    rays.tnear[i] = 0;
    rays.dir_x[i] = from.direction[0];
    rays.dir_y[i] = from.direction[1];
    rays.dir_z[i] = from.direction[2];
    rays.time[i] = 0;
    rays.tfar[i] = from.end;
    rays.mask[i] = ~0U;
    rays.id[i] = i;
    rays.flags[i] = 0;
}

}  // namespace

/// A ray from outside starts where it enters the scene, so that a far origin costs no precision.
/// Nothing when the ray cannot meet the scene, or has NaN coordinates.
std::optional<EmbreeRay> Geometry::Impl::embree_ray(const TracedRay& ray) const {
    Vec3 origin = ray.origin - models[0].space.center;
    if (!is_within_reach(origin) || !is_within_reach(ray.direction) || !(ray.limit > kEpsilon))
        return std::nullopt;
    EmbreeRay result;
    if (!contains(box, origin)) {
        const std::optional<double> start = entry(box, origin, ray.direction);
        if (!start || *start > ray.limit) return std::nullopt;
        result.start = *start;
        origin += ray.direction * *start;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        result.origin[k] = static_cast<float>(origin[k]);
        result.direction[k] = static_cast<float>(ray.direction[k]);
    }
    result.end = embree_end(ray.limit, result.start);
    return result;
}

Geometry::Geometry(GeometryInput input, const std::string& embree_options,
                   const TaskRunner& task_runner)
    : impl_(std::make_unique<Impl>(std::move(input), embree_options, task_runner)) {}
Geometry::~Geometry() = default;
Geometry::Geometry(Geometry&&) noexcept = default;
Geometry& Geometry::operator=(Geometry&&) noexcept = default;

Transform Geometry::instance_transform(InstanceId id) const {
    return impl_->placed.transform(id);
}
Bounds Geometry::bounds() const {
    return impl_->placed.bounds();
}
std::size_t Geometry::instance_count() const {
    return impl_->placed.paths().count();
}
SearchMemory Geometry::memory() const {
    const std::ptrdiff_t embree = impl_->embree_bytes.load(std::memory_order_relaxed);
    SearchMemory memory{static_cast<std::size_t>(std::max<std::ptrdiff_t>(embree, 0)),
                        impl_->placed.memory_bytes()};
    for (const Hierarchy& model : impl_->models)
        memory.tables += model.bvh_primitives.primitive_of.capacity() * sizeof(std::uint32_t) +
                         model.leaves.capacity() * sizeof(QuantizedLeaf) +
                         model.instances.all.capacity() * sizeof(Instance);
    return memory;
}

Hit Geometry::intersect_surface(SurfaceId surface, const RaySegment& ray) const {
    return impl_->placed.intersect_surface(surface, ray);
}

void Geometry::Impl::trace(NearestRay& ray) const {
    const std::optional<EmbreeRay> from = embree_ray(ray);
    if (!from) return;
    NearestQuery query;
    rtcInitIntersectContext(&query);
    query.placed = &placed;
    query.rays = &ray;
    query.start[0] = from->start;
    RTCRayHit hit;
    set_ray(hit.ray, *from);
    hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(models[0].scene.get(), &query, &hit);
}

/// Set up a packet of those rays that can meet the scene; note_start(lane, where it starts [m]).
template <class Traced, class Starts>
void Geometry::Impl::set_packet(std::span<Traced> rays, RTCRayHit16& packet, PacketLanes& valid,
                                Starts note_start) const {
    assert(rays.size() <= kPacket);
    close_lanes(packet);
    for (unsigned i = 0; i < rays.size(); ++i) {
        const std::optional<EmbreeRay> from = embree_ray(rays[i]);
        if (!from) continue;
        set_ray(packet.ray, i, *from);
        valid[i] = -1;
        note_start(i, from->start);
    }
}

void Geometry::Impl::trace(std::span<NearestRay> rays) const {
    alignas(64) PacketLanes valid{};
    RTCRayHit16 hits;
    NearestQuery query;
    rtcInitIntersectContext(&query);
    query.placed = &placed;
    query.rays = rays.data();
    set_packet(rays, hits, valid, [&](unsigned i, double start) { query.start[i] = start; });
    rtcIntersect16(valid.data(), models[0].scene.get(), &query, &hits);
}

void Geometry::Impl::trace(ShadowRay& ray) const {
    const std::optional<EmbreeRay> from = embree_ray(ray);
    if (!from) return;
    ShadowQueries query;
    rtcInitIntersectContext(&query);
    query.placed = &placed;
    query.rays = &ray;
    RTCRay embree;
    set_ray(embree, *from);
    rtcOccluded1(models[0].scene.get(), &query, &embree);
}

void Geometry::Impl::trace(std::span<ShadowRay> rays) const {
    alignas(64) PacketLanes valid{};
    RTCRayHit16 hits;
    ShadowQueries query;
    rtcInitIntersectContext(&query);
    query.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    query.placed = &placed;
    query.rays = rays.data();
    set_packet(rays, hits, valid, [](unsigned, double) {});
    rtcOccluded16(valid.data(), models[0].scene.get(), &query, &hits.ray);
}

bool Geometry::Impl::is_blocked_again(ShadowRay& ray, const Blocker* last) const {
    return last && last->primitive != Blocker::kNone &&
           placed.propose(ray, {last->instance, last->primitive});
}

Hit Geometry::Impl::finish(const RaySegment& segment, const NearestRay& ray) const {
    if (!ray.nearest) return {};
    if (!placed.is_ambiguous(ray)) return placed.hit_of(segment, *ray.nearest);
    std::vector<Candidate> all{*ray.nearest};
    NearestRay again;
    placed.begin_gathering(again, segment, ray, all);
    trace(again);
    if (again.out_of_memory) throw std::bad_alloc();
    return placed.hit_of(segment, placed.resolve(all));
}

Hit Geometry::intersect(const RaySegment& ray) const {
    NearestRay search;
    impl_->placed.begin(search, ray);
    impl_->trace(search);
    return impl_->finish(ray, search);
}

void Geometry::intersect(std::span<const RaySegment> rays, std::span<Hit> out) const {
    assert(rays.size() == out.size());
    if (!impl_->ablation.packets) {
        std::transform(rays.begin(), rays.end(), out.begin(),
                       [this](const RaySegment& ray) { return intersect(ray); });
        return;
    }
    std::array<NearestRay, kPacket> searches;
    for (std::size_t first = 0; first < rays.size(); first += kPacket) {
        const std::size_t count = std::min<std::size_t>(kPacket, rays.size() - first);
        for (std::size_t i = 0; i < count; ++i) impl_->placed.begin(searches[i], rays[first + i]);
        impl_->trace(std::span(searches).first(count));
        for (std::size_t i = 0; i < count; ++i)
            out[first + i] = impl_->finish(rays[first + i], searches[i]);
    }
}

[[gnu::flatten]] Visibility Geometry::visibility(const RaySegment& ray, SurfaceId target,
                                                 Blocker* last) const {
    ShadowRay search;
    impl_->placed.begin(search, ray, target);
    if (impl_->is_blocked_again(search, last)) return Visibility::blocked;
    impl_->trace(search);
    if (last && search.result == Visibility::blocked)
        *last = {search.blocker.instance, search.blocker.primitive};
    return search.result;
}

void Geometry::visibility(std::span<const ShadowQuery> queries,
                          std::span<Visibility> answers) const {
    assert(queries.size() == answers.size());
    if (!impl_->ablation.packets) {
        std::transform(
            queries.begin(), queries.end(), answers.begin(),
            [this](const ShadowQuery& q) { return visibility(q.ray, q.target, q.last); });
        return;
    }
    std::array<ShadowRay, kPacket> rays;
    std::array<std::size_t, kPacket> numbers{};
    std::size_t count = 0;
    const auto trace_packet = [&] {
        impl_->trace(std::span(rays).first(count));
        for (std::size_t k = 0; k < count; ++k) {
            const ShadowRay& ray = rays[k];
            answers[numbers[k]] = ray.result;
            if (ray.result == Visibility::blocked && queries[numbers[k]].last)
                *queries[numbers[k]].last = {ray.blocker.instance, ray.blocker.primitive};
        }
        count = 0;
    };
    for (std::size_t i = 0; i < queries.size(); ++i) {
        impl_->placed.begin(rays[count], queries[i].ray, queries[i].target);
        if (impl_->is_blocked_again(rays[count], queries[i].last)) {
            answers[i] = Visibility::blocked;
            continue;
        }
        numbers[count++] = i;
        if (count == kPacket) trace_packet();
    }
    if (count > 0) trace_packet();
}

}  // namespace lightwalk
