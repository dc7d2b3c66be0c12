#pragma once
// What the files of the Python module have in common.
#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "apps/common_options.h"
#include "apps/session/lightwalk/renderer.h"
#include "apps/session/lightwalk/scene.h"
#include "io/picture/picture.h"

namespace lightwalk {

/// Options of a command as its command line has them, without its name: "-ab", "2".
using Words = std::vector<std::string>;

/// Warnings, kept until Python asks for them. Callable from many threads.
class KeptWarnings final : public WarningSink {
  public:
    void warn(const std::string& message) override {
        const std::lock_guard lock(mutex_);
        constexpr std::size_t kMost = 1000;
        if (messages_.size() < kMost) messages_.push_back(message);
    }
    /// Those since the last call.
    [[nodiscard]] Words take() {
        const std::lock_guard lock(mutex_);
        return std::exchange(messages_, {});
    }

  private:
    std::mutex mutex_;
    Words messages_;
};

/// A scene, and what it warns of.
struct PythonScene {
    std::shared_ptr<KeptWarnings> warnings;
    LoadedScene scene;
};

/// Numbers that belong to Python as soon as numpy has asked for them (the buffer protocol).
template <class Number>
struct NumberArray {
    std::vector<Number> numbers;
};

/// Reads the options of a command, without a scene. Throws UsageError.
/// @param command  with the defaults of its options
template <class Command>
void take_options(Command& command, const Words& words) {
    const std::shared_ptr<FileSource> files = real_files();
    const OptionTable table = option_table(command, files);
    read_command_line(OptionWords(words, files), table, command.common);
    if (!command.common.scene_files().empty())
        throw UsageError("an option's value stands without its option: \"" +
                         command.common.scene_files().front() + '"');
    check_render_settings(command.common.settings);
    command.common.request.options.stop = nullptr;  // an interrupt ends the call, not all of them
}

[[nodiscard]] inline std::tuple<double, double, double> triple(const Vec3& v) {
    return {v.x, v.y, v.z};
}

/// The pixels of an array of three floats each, rows from the top. Throws InputError for others.
[[nodiscard]] Picture picture_of(const pybind11::buffer& pixels, int width, int height);

// Parts of the module.
void bind_arrays(pybind11::module_& module);
void bind_options(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_pictures(pybind11::module_& module);
void bind_rays(pybind11::module_& module);
void bind_glare(pybind11::module_& module);

}  // namespace lightwalk
