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
    const Picture picture = picture_of(pixels, width, height);
    View view;
    parse_view_string(view_string, view);
    const py::gil_scoped_release unlocked;
    return analyse_glare({width, height, picture.pixels}, view, params);
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
