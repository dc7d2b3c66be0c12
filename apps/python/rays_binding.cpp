// Rays and contributions, as Python has them.
#include <pybind11/stl.h>

#include <algorithm>
#include <cstring>

#include "apps/contrib_command.h"
#include "apps/python/bindings.h"
#include "apps/python/python_call.h"
#include "apps/session/render_backend.h"
#include "apps/session/replications.h"
#include "apps/trace_command.h"
#include "core/math/student_t.h"
#include "core/transport/ray.h"
#include "io/contributions/contribution_tally.h"

namespace py = pybind11;

namespace lightwalk {
namespace {

/// Six numbers a ray: origin and direction.
std::vector<RayQuery> queries_of(const py::buffer& numbers) {
    const py::buffer_info info = numbers.request();
    if (info.format != "d" || info.itemsize != sizeof(double) || info.size % 6 != 0 ||
        !PyBuffer_IsContiguous(info.view(), 'C'))
        throw InputError("expected six numbers a ray, in rows");
    const auto* const first = static_cast<const double*>(info.ptr);
    std::vector<RayQuery> queries;
    queries.reserve(static_cast<std::size_t>(info.size / 6));
    for (const double* v = first; v != first + info.size; v += 6)
        queries.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
    return queries;
}

/// What a ray finds, as threads write it down.
struct FoundLight {
    Rgb radiance;
    std::int32_t surface = -1;
    double distance = kHuge;
};
struct FoundSurface {
    FoundLight light;
    Vec3 position, normal;
};

struct PythonRays {
    NumberArray<float> radiance;
    NumberArray<float> half_width;  ///< of its intervals; empty: not asked for
    NumberArray<double> distance, normal, position;
    NumberArray<std::int32_t> surface;
};

FoundLight light_of(const Ray& ray, const Hit& first) {
    return {ray.value, first.exists() ? index(first.surface) : -1,
            first.exists() ? first.t : kHuge};
}

FoundSurface surface_of(const Ray& ray, const Hit& first) {
    const FoundLight light = light_of(ray, first);
    if (!first.exists()) return {light, {}, {}};
    if (first.t >= kHuge) return {light, {}, -ray.direction};  // a light source at infinity
    return {light, first.position, first.normal};
}

void append(NumberArray<double>& array, const Vec3& v) {
    array.numbers.insert(array.numbers.end(), {v.x, v.y, v.z});
}

void add(PythonRays& rays, const FoundLight& found) {
    const Rgb& value = found.radiance;
    rays.radiance.numbers.insert(rays.radiance.numbers.end(), {value.r, value.g, value.b});
    rays.distance.numbers.push_back(found.distance);
    rays.surface.numbers.push_back(found.surface);
}

void add(PythonRays& rays, const FoundSurface& found) {
    add(rays, found.light);
    append(rays.normal, found.normal);
    append(rays.position, found.position);
}

template <class Found>
PythonRays rays_of(const std::string& bytes) {
    const std::size_t count = bytes.size() / sizeof(Found);
    PythonRays rays;
    rays.radiance.numbers.reserve(3 * count);
    rays.distance.numbers.reserve(count);
    rays.surface.numbers.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        Found found;
        std::memcpy(&found, bytes.data() + i * sizeof found, sizeof found);
        add(rays, found);
    }
    return rays;
}

template <class Found>
void append_bytes(const Found& found, std::string& bytes) {
    bytes.append(reinterpret_cast<const char*>(&found), sizeof found);
}

/// Of the first of several answers all, but the mean of all radiances, and its intervals.
template <class Found>
PythonRays rays_of(const std::vector<std::string>& answers) {
    PythonRays rays = rays_of<Found>(answers.front());
    if (answers.size() == 1) return rays;
    std::vector<NumberArray<float>> radiances;
    radiances.reserve(answers.size());
    for (const std::string& bytes : answers) radiances.push_back(rays_of<Found>(bytes).radiance);
    rays.half_width.numbers.reserve(rays.radiance.numbers.size());
    std::vector<double> values(answers.size());
    for (std::size_t i = 0; i < rays.radiance.numbers.size(); ++i) {
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] = static_cast<double>(radiances[k].numbers[i]);
        const MeanInterval interval = mean_interval(values);
        rays.radiance.numbers[i] = static_cast<float>(interval.mean);
        rays.half_width.numbers.push_back(static_cast<float>(interval.half_width));
    }
    return rays;
}

/// What one of `count` answers tells of its progress, as that of all of them.
TakeProgressReport part_of(TakeProgressReport take, int answer, int count) {
    if (!take) return take;
    return [take = std::move(take), answer, count](RenderProgress progress) {
        progress.done = (answer + progress.done) / count;
        if (count > 1) progress.seconds_left.reset();
        take(progress);
    };
}

RendererOptions trace_options(TraceCommand& command, bool shade, bool sensor) {
    RenderOptions& light = command.common.settings.light;
    if (!shade) {  // do not prepare light sources
        light.redirections = 0;
        light.shadow_threshold = 0;
    }
    RendererOptions options = renderer_options(command.common);
    options.answers_rays = true;
    options.rays.sensor = sensor;
    options.rays.shade = shade;
    return options;
}

/// @param interval  answers to each ray, from 2 on; 0: one, without an interval
std::pair<PythonRays, Words> trace(const PythonScene& scene, const Words& words,
                                   const py::buffer& numbers, bool sensor, bool shade,
                                   bool surfaces, int interval, py::object listener) {
    RayTask task{queries_of(numbers)};
    TraceCommand command;
    take_options(command, words);
    KeptWarnings warnings;
    ProgressTeller teller(std::move(listener));
    RendererOptions options = trace_options(command, shade, sensor);
    options.warn = [&](const std::string& text) { warnings.warn(text); };
    options.record = [surfaces](const RayQuery&, const Ray& ray, const Hit& first,
                                std::string& bytes) {
        if (surfaces)
            append_bytes(surface_of(ray, first), bytes);
        else
            append_bytes(light_of(ray, first), bytes);
    };
    const int count = std::max(interval, 1);
    std::vector<std::string> answers;
    for (int k = 0; k < count; ++k) {
        RendererOptions one = interval > 0 ? replication_options(options, k) : options;
        one.progress = part_of(teller.taker(), k, count);
        std::optional<Renderer> renderer;
        {
            const py::gil_scoped_release unlocked;
            renderer.emplace(scene.scene, one);
            if (shade && k == 0) renderer->backend().session().warn_of_darkness();
        }
        answers.push_back(wait_for_task(*renderer, renderer->start(task), teller).bytes);
    }
    const py::gil_scoped_release unlocked;
    PythonRays rays = surfaces ? rays_of<FoundSurface>(answers) : rays_of<FoundLight>(answers);
    return {std::move(rays), warnings.take()};
}

struct PythonContributions {
    std::vector<std::pair<std::string, std::size_t>> modifiers;  ///< with their bins
    NumberArray<double> numbers;  ///< a ray after the other, of each column three
};

/// Lists of rays whose answers fit into memory beside what is returned.
void contribute(Renderer& renderer, const std::vector<RayQuery>& queries, std::size_t most,
                std::vector<double>& numbers, ProgressTeller& teller) {
    for (std::size_t begin = 0; begin < queries.size(); begin += most) {
        const auto first = queries.begin() + static_cast<std::ptrdiff_t>(begin);
        const auto count = static_cast<std::ptrdiff_t>(std::min(most, queries.size() - begin));
        RayTask task{{first, first + count}, begin};
        const RayBytes found = wait_for_task(renderer, renderer.start(std::move(task)), teller);
        const std::size_t size = numbers.size();
        numbers.resize(size + found.bytes.size() / sizeof(double));
        if (!found.bytes.empty())
            std::memcpy(numbers.data() + size, found.bytes.data(), found.bytes.size());
    }
}

std::pair<PythonContributions, Words> contrib(const PythonScene& scene, const Words& words,
                                              const py::buffer& numbers, bool sensor,
                                              py::object listener) {
    const std::vector<RayQuery> queries = queries_of(numbers);
    ContribCommand command;
    take_options(command, words);
    command.common.request.options.rays.sensor = sensor;
    KeptWarnings warnings;
    const std::vector<TrackedModifier> tracked = tracked_modifiers(command);
    settle_contrib_command(command, tracked, warnings);
    for (const std::string& name : missing_modifiers(scene.scene.compiled()->scene(), tracked))
        throw InputError("the scene has no modifier \"" + name + '"');
    ProgressTeller teller(std::move(listener));
    RendererOptions options = renderer_options(command.common);
    options.warn = [&](const std::string& text) { warnings.warn(text); };
    options.progress = teller.taker();
    options.make_tally = [&](const Tracer& tracer) {
        return std::make_unique<ContributionTally>(tracer, tracked, command.values, warnings);
    };
    Renderer renderer(scene.scene, options);
    PythonContributions result;
    for (const TrackedModifier& modifier : tracked)
        result.modifiers.emplace_back(modifier.name, modifier.bins);
    result.numbers.numbers.reserve(3 * column_count(tracked) * queries.size());
    contribute(renderer, queries, rays_at_once(command, tracked), result.numbers.numbers, teller);
    return {std::move(result), warnings.take()};
}

}  // namespace

void bind_rays(py::module_& module) {
    py::class_<PythonRays>(module, "Rays")
        .def_readonly("radiance", &PythonRays::radiance)
        .def_readonly("half_width", &PythonRays::half_width)
        .def_readonly("distance", &PythonRays::distance)
        .def_readonly("position", &PythonRays::position)
        .def_readonly("normal", &PythonRays::normal)
        .def_readonly("surface", &PythonRays::surface);
    module.def("trace", &trace, py::arg("scene"), py::arg("words"), py::arg("rays"),
               py::arg("sensor"), py::arg("shade"), py::arg("surfaces"), py::arg("interval"),
               py::arg("listener"));
    py::class_<PythonContributions>(module, "Contributions")
        .def_readonly("modifiers", &PythonContributions::modifiers)
        .def_readonly("numbers", &PythonContributions::numbers);
    module.def("contrib", &contrib, py::arg("scene"), py::arg("words"), py::arg("rays"),
               py::arg("sensor"), py::arg("listener"));
}

}  // namespace lightwalk
