// Scenes, as Python has them.
#include <pybind11/stl.h>

#include "apps/python/bindings.h"
#include "apps/python/python_call.h"
#include "apps/session/compiled_scene.h"

namespace py = pybind11;

namespace lightwalk {
namespace {

std::unique_ptr<PythonScene> load(const SceneSource& source) {
    const auto warnings = std::make_shared<KeptWarnings>();
    std::optional<LoadedScene> scene;
    wait_for(
        [&] {
            scene.emplace(source, [warnings](const std::string& text) { warnings->warn(text); });
        },
        [] {}, [] {});
    return std::make_unique<PythonScene>(PythonScene{warnings, std::move(*scene)});
}

/// @param names  of surfaces, by their numbers
std::vector<std::string> surface_names(const PythonScene& scene,
                                       const std::vector<std::int32_t>& numbers) {
    std::vector<std::string> names;
    const Scene& compiled = scene.scene.compiled()->scene();
    for (const std::int32_t number : numbers)
        names.emplace_back(number < 0 ? std::string_view()
                                      : compiled.surface(SurfaceId{number}).name());
    return names;
}

}  // namespace

void bind_scene(py::module_& module) {
    py::class_<SceneSource>(module, "SceneSource")
        .def(py::init<>())
        .def_readwrite("files", &SceneSource::files)
        .def_property(
            "bytes", [](const SceneSource& source) { return py::bytes(source.bytes); },
            [](SceneSource& source, const py::bytes& bytes) { source.bytes = bytes; })
        .def_readwrite("name", &SceneSource::name)
        .def_readwrite("library", &SceneSource::library)
        .def_readwrite("allow_commands", &SceneSource::allow_commands)
        .def_readwrite("allow_stale", &SceneSource::allow_stale)
        .def_readwrite("threads", &SceneSource::threads);
    py::class_<PythonScene>(module, "Scene")
        .def(py::init(&load), py::arg("source"))
        .def("take_warnings", [](const PythonScene& scene) { return scene.warnings->take(); })
        .def("surface_names", &surface_names, py::arg("numbers"))
        .def("digest", [](const PythonScene& scene) { return scene.scene.digest(); })
        .def("bounds", [](const PythonScene& scene) {
            const LoadedScene::Box box = scene.scene.bounds();
            return std::pair(triple(box.lower), triple(box.upper));
        });
    module.def(
        "freeze",
        [](const SceneSource& source, const std::string& path) {
            KeptWarnings warnings;
            wait_for(
                [&] {
                    freeze_scene(source, path,
                                 [&](const std::string& text) { warnings.warn(text); });
                },
                [] {}, [] {});
            return warnings.take();
        },
        py::arg("source"), py::arg("path"));
}

}  // namespace lightwalk
