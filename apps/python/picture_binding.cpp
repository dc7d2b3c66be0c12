// Pictures and the frames of walks, as Python has them.
#include <pybind11/stl.h>

#include "apps/python/bindings.h"
#include "apps/python/python_call.h"
#include "apps/render_command.h"
#include "apps/session/render_backend.h"
#include "io/options/view_options.h"
#include "io/options/view_text.h"
#include "io/picture/tone.h"

namespace py = pybind11;

namespace lightwalk {
namespace {

/// What is a plain array of floats to numpy.
NumberArray<float> floats_of(const std::vector<Rgb>& colors) {
    static_assert(sizeof(Rgb) == 3 * sizeof(float));
    const auto* const first = reinterpret_cast<const float*>(colors.data());
    return {{first, first + 3 * colors.size()}};
}

struct PythonPicture {
    int width = 0, height = 0;
    NumberArray<float> radiance, distance, error;
    std::vector<std::pair<std::string, NumberArray<float>>> layers;
    std::uint64_t rays = 0;
    std::string view;  ///< as a header line has it
};

PythonPicture python_picture(RenderedPicture&& rendered, const View& view) {
    PythonPicture picture{rendered.width,
                          rendered.height,
                          floats_of(rendered.radiance),
                          {std::move(rendered.distance)},
                          {std::move(rendered.error)},
                          {},
                          rendered.rays,
                          view_text(view)};
    for (const RenderedLayer& layer : rendered.layers)
        picture.layers.emplace_back(layer.name, floats_of(layer.radiance));
    return picture;
}

View view_of(const Words& words, View view) {
    const std::shared_ptr<FileSource> files = real_files();
    OptionWords options(words, files);
    while (options.at_option()) {
        if (!take_view_option(options, view, *files))
            throw UsageError("not a part of a view: \"" + options.option() + '"');
    }
    return view;
}

/// The pictures of one command line: `lightwalk render`, or `animate`, whose frames reuse each
/// other's points.
class PictureMaker {
  public:
    PictureMaker(const PythonScene& scene, const std::string& command, const Words& words,
                 bool with_distances, py::object listener)
        : command_(command), teller_(std::move(listener)) {
        take_options(command_, words);
        if (command_.walk) resolve_path();
        command_.common.request.options.use_distances = with_distances;
        command_.output.layers = command_.common.request.options.light_groups.has_value();
        settle_render_command(command_, warnings_);
        RendererOptions options = renderer_options(command_.common);
        options.warn = [this](const std::string& text) { warnings_.warn(text); };
        options.progress = teller_.taker();
        const py::gil_scoped_release unlocked;
        if (command_.walk && command_.walk->way != WalkCommand::Way::none)
            views_ = walk_views(*command_.walk, command_.view, scene.scene.compiled()->scene());
        renderer_.emplace(scene.scene, options);
        renderer_->backend().session().warn_of_darkness();
    }
    PictureMaker(const PictureMaker&) = delete;
    PictureMaker& operator=(const PictureMaker&) = delete;

    /// The view that the command line tells.
    PythonPicture make() { return make_view(command_.view); }
    /// A change of that view.
    PythonPicture make_changed(const Words& view) {
        return make_view(view_of(view, command_.view));
    }
    /// How many frames the command line's path has.
    [[nodiscard]] std::size_t path_length() const { return views_.size(); }
    PythonPicture make_frame(std::size_t number) { return make_view(views_.at(number)); }
    [[nodiscard]] Words take_warnings() { return warnings_.take(); }

  private:
    void resolve_path() {
        const WalkCommand& walk = *command_.walk;
        if (walk.way == WalkCommand::Way::none && walk.path.empty()) return;
        resolve_walk(*command_.walk, command_.view, *real_files());
    }

    PythonPicture make_view(const View& view) {
        const PictureSize size = picture_size(command_, view, warnings_);
        if (size.width <= 0 || size.height <= 0)
            throw UsageError("options -x and -y: the picture has no pixels");
        PictureTask task;
        task.view = view;
        task.before = before_;
        task.width = size.width;
        task.height = size.height;
        RenderedPicture rendered =
            wait_for_task(*renderer_, renderer_->start(std::move(task)), teller_);
        if (command_.walk) before_ = view;
        return python_picture(std::move(rendered), view);
    }

    RenderCommand command_;
    ProgressTeller teller_;
    KeptWarnings warnings_;
    std::vector<View> views_;     ///< of the path
    std::optional<View> before_;  ///< of the frame before
    std::optional<Renderer> renderer_;
};

void save(const std::string& path, const py::buffer& pixels, int width, int height,
          const Words& header) {
    const Picture picture = picture_of(pixels, width, height);
    const py::gil_scoped_release unlocked;
    check_picture_name(path);
    write_picture(path, picture, {header}, {});
}

}  // namespace

Picture picture_of(const py::buffer& pixels, int width, int height) {
    const py::buffer_info info = pixels.request();
    const auto count = static_cast<py::ssize_t>(width) * height;
    if (width < 1 || height < 1 || info.itemsize != sizeof(float) || info.format != "f" ||
        info.size != 3 * count || !PyBuffer_IsContiguous(info.view(), 'C'))
        throw InputError("expected three floats a pixel, in rows");
    const auto* const first = static_cast<const float*>(info.ptr);
    Picture picture{width, height, {}};
    picture.pixels.reserve(static_cast<std::size_t>(count));
    for (py::ssize_t i = 0; i < count; ++i)
        picture.pixels.emplace_back(first[3 * i], first[3 * i + 1], first[3 * i + 2]);
    return picture;
}

void bind_pictures(py::module_& module) {
    py::class_<PythonPicture>(module, "Picture")
        .def_readonly("width", &PythonPicture::width)
        .def_readonly("height", &PythonPicture::height)
        .def_readonly("radiance", &PythonPicture::radiance)
        .def_readonly("distance", &PythonPicture::distance)
        .def_readonly("error", &PythonPicture::error)
        .def_readonly("rays", &PythonPicture::rays)
        .def_readonly("view", &PythonPicture::view)
        .def_property_readonly("layers", [](PythonPicture& picture) {
            py::dict layers;
            for (auto& [name, radiance] : picture.layers) layers[py::str(name)] = radiance;
            return layers;
        });
    py::class_<PictureMaker>(module, "PictureMaker")
        .def(py::init<const PythonScene&, const std::string&, const Words&, bool, py::object>(),
             py::arg("scene"), py::arg("command"), py::arg("words"), py::arg("with_distances"),
             py::arg("listener"))
        .def("make", &PictureMaker::make)
        .def("make_changed", &PictureMaker::make_changed, py::arg("view"))
        .def("make_frame", &PictureMaker::make_frame, py::arg("number"))
        .def("path_length", &PictureMaker::path_length)
        .def("take_warnings", &PictureMaker::take_warnings);
    module.def(
        "view_text", [](const Words& words) { return view_text(view_of(words, {})); },
        py::arg("words"));
    module.def("save", &save, py::arg("path"), py::arg("pixels"), py::arg("width"),
               py::arg("height"), py::arg("header"));
}

}  // namespace lightwalk
