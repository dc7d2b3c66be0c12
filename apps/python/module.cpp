// The module lightwalk.bin._core: what the Python package `lightwalk` is made of. Its functions
// take the words of command lines and plain buffers; the package gives them names, arrays and
// docstrings.
#include <pybind11/pybind11.h>

#include <cstdint>

#include "apps/python/bindings.h"
#include "io/options/option_words.h"

namespace py = pybind11;

namespace lightwalk {
namespace {

template <class Number>
void bind_array(py::module_& module, const char* name) {
    py::class_<NumberArray<Number>>(module, name, py::buffer_protocol())
        .def("__len__", [](const NumberArray<Number>& array) { return array.numbers.size(); })
        .def_buffer([](NumberArray<Number>& array) {
            return py::buffer_info(array.numbers.data(),
                                   static_cast<py::ssize_t>(array.numbers.size()));
        });
}

/// As one of the package's exceptions.
void raise_as(const char* name, const char* message) {
    const py::object type = py::module_::import("lightwalk._errors").attr(name);
    PyErr_SetString(type.ptr(), message);
}

}  // namespace

void bind_arrays(py::module_& module) {
    bind_array<float>(module, "Floats");
    bind_array<double>(module, "Doubles");
    bind_array<std::int32_t>(module, "Integers");
}

}  // namespace lightwalk

PYBIND11_MODULE(_core, module) {
    module.doc() = "Lightwalk's renderer, for the package lightwalk.";
    module.attr("version") = LIGHTWALK_VERSION;
    py::register_exception_translator([](std::exception_ptr problem) {
        try {
            if (problem) std::rethrow_exception(problem);
        } catch (const lightwalk::InputError& error) {
            lightwalk::raise_as("InputError", error.what());
        } catch (const lightwalk::UsageError& error) {
            lightwalk::raise_as("OptionError", error.what());
        }
    });
    lightwalk::bind_arrays(module);
    lightwalk::bind_options(module);
    lightwalk::bind_scene(module);
    lightwalk::bind_pictures(module);
    lightwalk::bind_rays(module);
    lightwalk::bind_glare(module);
}
