// Glare in a picture, as Python has it.
#include <pybind11/stl.h>

#include "apps/python/bindings.h"
#include "core/glare/dgp.h"
#include "core/glare/glare.h"
#include "io/options/view_options.h"
#include "io/options/view_text.h"

namespace py = pybind11;

namespace lightwalk {
namespace {

GlareReport glare(const py::buffer& pixels, int width, int height, const std::string& view_string,
                  const GlareParams& params) {
    const py::buffer_info info = pixels.request();
    const auto count = static_cast<py::ssize_t>(width) * height;
    if (width < 1 || height < 1 || info.format != "f" || info.size != 3 * count ||
        !PyBuffer_IsContiguous(info.view(), 'C'))
        throw InputError("expected three floats a pixel, in rows");
    const auto* const first = static_cast<const float*>(info.ptr);
    std::vector<Rgb> colors;
    colors.reserve(static_cast<std::size_t>(count));
    for (py::ssize_t i = 0; i < count; ++i)
        colors.emplace_back(first[3 * i], first[3 * i + 1], first[3 * i + 2]);
    View view;
    parse_view_string(view_string, view);
    const py::gil_scoped_release unlocked;
    return analyse_glare({width, height, colors}, view, params);
}

py::tuple triple(const Vec3& v) {
    return py::make_tuple(v.x, v.y, v.z);
}

}  // namespace

void bind_glare(py::module_& module) {
    py::class_<GlareSource>(module, "GlareSource")
        .def_readonly("luminance", &GlareSource::luminance)
        .def_readonly("solid_angle", &GlareSource::solid_angle)
        .def_readonly("position_index", &GlareSource::position_index)
        .def_property_readonly("direction",
                               [](const GlareSource& source) { return triple(source.direction); });
    py::class_<GlareReport>(module, "GlareReport")
        .def_readonly("dgp", &GlareReport::dgp)
        .def_readonly("low_light_correction", &GlareReport::low_light_correction)
        .def_readonly("within_assessments", &GlareReport::within_assessments)
        .def_readonly("vertical_illuminance", &GlareReport::vertical_illuminance)
        .def_readonly("average_luminance", &GlareReport::average_luminance)
        .def_readonly("sources", &GlareReport::sources);
    module.def(
        "glare",
        [](const py::buffer& pixels, int width, int height, const std::string& view,
           double threshold) {
            GlareParams params;
            params.threshold = threshold;
            return glare(pixels, width, height, view, params);
        },
        py::arg("pixels"), py::arg("width"), py::arg("height"), py::arg("view"),
        py::arg("threshold"));
}

}  // namespace lightwalk
