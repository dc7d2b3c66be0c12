#include "apps/walk/scene_follower.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <new>
#include <utility>

#include "core/error.h"
#include "io/files/settled_files.h"
#include "io/formats/words.h"
#include "io/rad/rad_file.h"

namespace lightwalk {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kLook{500}, kLookCloser{100};

std::vector<std::string> lines_of(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) lines.emplace_back(take_line(text));
    return lines;
}

/// Those of `before` that are others now.
std::vector<std::string> changed_files(const FileStates& before, const FileStates& now) {
    std::vector<std::string> changed;
    for (const auto& [path, state] : before) {
        const auto found = now.find(path);
        if (found != now.end() && found->second != state) changed.push_back(path);
    }
    return changed;
}

/// Whether a primitive's string argument may be the name by which a file was found: without its
/// folders, and where pictures go by another extension without that.
bool may_name(std::string_view argument, const std::filesystem::path& path) {
    const auto name = std::filesystem::path(argument.substr(0, argument.find('#')));
    return !name.empty() && name.stem() == path.stem();
}

/// Whether all that is read of a file is the text of a scene. Of luminaires' files, object files
/// and glTF files there are data beside it.
bool is_text_alone(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    constexpr std::array<const char*, 7> kOthers{".ies", ".ldt",  ".obj", ".mtl",
                                                 ".glb", ".gltf", ".bin"};
    return std::ranges::find(kOthers, extension) == kOthers.end();
}

/// Adds the modifiers to the difference that may use a file which is no scene text.
/// @return  false: it is used otherwise, by surfaces or nobody knows
bool add_users(const Model& model, const std::string& file, std::vector<std::size_t>& users) {
    const std::filesystem::path path(file);
    const auto names_it = [&](const auto& strings) {
        for (std::size_t i = 0; i < strings.size(); ++i)
            if (may_name(strings[i], path)) return true;
        return false;
    };
    for (std::size_t i = 0; i < model.surfaces.size(); ++i)
        if (const SurfacePrimitive surface = model.surfaces[i];
            !surface.strings.empty() && names_it(surface.strings))
            return false;
    const std::size_t before = users.size();
    for (std::size_t i = 0; i < model.modifiers.size(); ++i)
        if (names_it(model.modifiers[i].strings)) users.push_back(i);
    return users.size() > before;
}

/// Memory that the system has for those who ask [bytes]; nothing where it does not say.
std::optional<std::uint64_t> free_memory() {
    constexpr std::uint64_t kKilo = 1024;
    std::ifstream file("/proc/meminfo");
    std::string name, unit;
    for (std::uint64_t amount = 0; file >> name >> amount; std::getline(file, unit))
        if (name == "MemAvailable:") return kKilo * amount;
    return std::nullopt;
}

/// Whether another scene of the size of this one would hardly find room beside it.
bool is_larger_than_free(const Scene& scene) {
    const SceneMemory memory = scene.memory();
    const std::uint64_t own =
        memory.surfaces + memory.shapes + memory.meshes + memory.search.tree + memory.search.tables;
    const std::optional<std::uint64_t> room = free_memory();
    return room && 2 * own > *room;  // building takes more than what is built
}

}  // namespace

SceneFollower::SceneFollower(LoadedFiles loaded)
    : loaded_(std::move(loaded)),
      loaded_states_(loaded_.files->recorded()),
      watch_(loaded_.files),
      thread_([this] { run(); }) {}

SceneFollower::~SceneFollower() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        changed_.notify_all();
    }
    thread_.join();
}

std::optional<SceneNews> SceneFollower::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, std::nullopt);
}

void SceneFollower::settle(bool loaded) {
    const std::lock_guard lock(mutex_);
    settled_ = loaded;
    changed_.notify_all();
}

bool SceneFollower::pause(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, time, [&] { return ends_; });
    return !ends_;
}

void SceneFollower::run() {
    SettledFiles settled(watch_->recorded());
    std::chrono::milliseconds wait = kLook;
    while (pause(wait)) {
        const bool read = settled.are_to_be_read(watch_->now(), Clock::now());
        wait = settled.change() ? kLookCloser : kLook;
        if (!read) continue;
        const Clock::time_point begin = Clock::now();
        read_anew();
        settled = SettledFiles(watch_->recorded());
        const auto took =
            std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - begin);
        wait = std::max(kLookCloser, took);
    }
}

/// Compiles it where it is another one than before; null: it is the same.
std::shared_ptr<CompiledScene> SceneFollower::read(const std::shared_ptr<WatchedFiles>& files,
                                                   SceneNews& news, LoadedFiles& next) {
    std::shared_ptr<CompiledScene> scene =
        read_compiled_scene(loaded_.source, loaded_.warn, std::make_shared<FileRecorder>(files));
    next.texts.clear();
    for (const auto& [path, state] : files->recorded()) next.texts.insert(path);
    news.difference = scene->compare_with(*loaded_.scene);
    bool others = false;
    std::vector<std::size_t> users;
    for (const std::string& file : news.files) {
        if (loaded_.texts.contains(file) && is_text_alone(file)) continue;
        others = true;
        if (!add_users(scene->model(), file, users)) news.all_differs = true;
    }
    std::vector<std::size_t>& modifiers = news.difference.modifiers;
    modifiers.insert(modifiers.end(), users.begin(), users.end());
    std::ranges::sort(modifiers);
    modifiers.erase(std::unique(modifiers.begin(), modifiers.end()), modifiers.end());
    if (news.difference.is_none() && !others) return nullptr;
    if (news.difference.same_geometry && !others) {
        try {
            scene->compile_on(loaded_.scene);
            files->record(loaded_states_);  // what has not changed was not read again
            return scene;
        } catch (const GeometryChange&) {
            news.all_differs = true;
        }
    }
    scene->compile();
    return scene;
}

void SceneFollower::read_anew() {
    const auto files = std::make_shared<WatchedFiles>();
    const FileStates before = watch_->now();
    SceneNews news;
    news.files = changed_files(loaded_states_, before);
    news.begins_anew = is_larger_than_free(loaded_.scene->scene()) ||
                       std::ranges::any_of(news.files, [](const std::string& file) {
                           return is_rad_file_name(file);
                       });
    LoadedFiles next = loaded_;
    next.files = files;
    try {
        if (!news.begins_anew) news.scene = next.scene = read(files, news, next);
    } catch (const InputError& error) {
        news.problems = lines_of(error.what());
    } catch (const std::bad_alloc&) {
        news.problems = {"there is no memory for the scene as it is now"};
    }
    const bool mended = failed_ && news.problems.empty();
    failed_ = !news.problems.empty();
    if (!news.scene) files->record(before);
    watch_ = files;
    if (news.scene || failed_ || mended || news.begins_anew) tell(std::move(news), std::move(next));
}

void SceneFollower::tell(SceneNews news, LoadedFiles next) {
    const bool has_scene = news.scene != nullptr;
    std::unique_lock lock(mutex_);
    news_ = std::move(news);
    settled_.reset();
    changed_.wait(lock, [&] { return settled_ || ends_; });
    if (!has_scene || !settled_.value_or(false)) return;
    loaded_ = std::move(next);
    loaded_states_ = loaded_.files->recorded();
}

}  // namespace lightwalk
