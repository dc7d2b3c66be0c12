#include "apps/scene_session.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <nlohmann/json.hpp>

#include "apps/heap.h"
#include "apps/parse_queue.h"
#include "apps/progress.h"
#include "apps/rank_link.h"
#include "core/light/light_sources.h"
#include "core/material/modifier_factories.h"
#include "io/files/atomic_file.h"
#include "io/scene/file_resources.h"
#include "io/scene/freezing_resources.h"
#include "io/scene/scene_reader.h"
#include "parallel/executor.h"
#include "parallel/executor_task_runner.h"

namespace lightwalk {
namespace {

std::int64_t now_ns() {
    using std::chrono::duration_cast;
    using std::chrono::nanoseconds;
    return duration_cast<nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Beyond this a process holds on to no memory that it has done with; of a smaller one the pages
/// are worth more where they are [bytes].
constexpr std::uint64_t kLarge = std::uint64_t{64} << 20;

void trim_heap() {
    if (peak_memory_bytes() > kLarge) give_back_heap();
}

class NoWarnings final : public WarningSink {
  public:
    void warn(const std::string&) override {}
};

}  // namespace

Stopwatch::Stopwatch() : start_ns_(now_ns()) {}
double Stopwatch::seconds() const {
    return 1e-9 * static_cast<double>(now_ns() - start_ns_);
}

SceneSession::SceneSession(const CommonOptions& options, WarningSink& sink,
                           std::shared_ptr<FileRecorder> source, const std::string& shared_by)
    : warnings(sink),
      files(std::move(source)),
      library(LibraryPath::from_environment(files)),
      workers(options.workers),
      ablation(options.ablation) {
    const Stopwatch watch;
    if (shared_by.empty())
        read(options);
    else
        map(shared_by);
    cost.read_seconds = watch.seconds();
    cost.read_peak_bytes = peak_memory_bytes();
}

void SceneSession::read(const CommonOptions& options) {
    const std::vector<std::string>& names = options.scene_files;
    const auto found = std::ranges::find_if(
        names, [&](const std::string& name) { return is_frozen_scene(name, *files); });
    if (found == names.end()) {
        resources = std::make_unique<FileResources>(library, options.allow_commands, warnings);
        MakeTextPipe pipe;
        if (workers > 1) pipe = [](TextSink& next) { return std::make_unique<ParseQueue>(next); };
        model = read_scene(names, {library, options.allow_commands, {}, pipe}, warnings, &problems);
        return;
    }
    if (names.size() > 1) throw InputError({*found, 0}, "a frozen scene is all of a scene");
    // Every rank maps it itself, also where one reads for all: its pages are shared anyway.
    auto opened = open_frozen_scene(*found, options.stale_allowed);
    files->note_mapped(*found, opened->file().digest());
    model = opened->model();
    frozen = opened.get();
    resources = std::move(opened);
}

void SceneSession::map(const std::string& path) {
    auto opened = open_frozen_scene(path, true);
    model = opened->model();
    resources = std::move(opened);
}

std::string SceneSession::share() {
    const Stopwatch watch;
    FreezingResources asked(*resources);
    raise_problems(asked);
    {
        const std::unique_ptr<Executor> executor = make_executor(kDefaultExecutor, workers);
        NoWarnings later;  // they come when the scene is compiled to be rendered
        const Scene compiled(model, modifier_factory, asked, later, ExecutorTaskRunner(*executor),
                             SceneExtent::without_search);
        try {
            shared = share_scene(compiled, asked);
        } catch (const InputError&) {
            return {};
        }
    }
    map(shared->path());
    cost.read_seconds += watch.seconds();
    cost.read_peak_bytes = peak_memory_bytes();
    return shared->path();
}

void SceneSession::raise_problems(Resources& asked) {
    if (problems.empty()) return;
    try {
        Scene::unsupported(model, modifier_factory, asked, warnings).raise();
    } catch (const InputError& error) {
        problems.add(error);
    }
    problems.raise();
}

void SceneSession::compile(Resources& asked) {
    const std::unique_ptr<Executor> executor = make_executor(kDefaultExecutor, workers);
    compile(asked, ExecutorTaskRunner(*executor));
}

void SceneSession::compile(Resources& asked, const TaskRunner& task_runner) {
    raise_problems(asked);
    trim_heap();
    built = std::make_unique<const Scene>(model, modifier_factory, asked, warnings, task_runner,
                                          SceneExtent::whole, ablation);
    trim_heap();
}

void SceneSession::build(const RenderSettings& settings, RankLink* link) {
    const Stopwatch watch;
    const std::unique_ptr<Executor> executor = make_executor(kDefaultExecutor, workers);
    const ExecutorTaskRunner task_runner(*executor);
    compile(*resources, task_runner);
    auto fresh = std::make_unique<Tracer>(*built, settings.light, warnings, task_runner);
    const RenderOptions& options = settings.light;
    if (options.ambient_bounces > 0 && options.ambient_accuracy > kEpsilon) {
        make_cache(settings, link);
        fresh->use_ambient_cache(freezable.get());
    } else if (!settings.ambient_file.empty()) {
        warnings.warn("the ambient file is not opened: it needs -ab and -aa above zero");
    }
    made = std::move(fresh);
    cost.build_seconds = watch.seconds();
    cost.build_peak_bytes = peak_memory_bytes();
}

void SceneSession::make_cache(const RenderSettings& settings, RankLink* link) {
    const RenderOptions& options = settings.light;
    const SceneCube cube = built->cube();
    ambient = std::make_unique<ConcurrentCache>(ambient_limits(
        cube.origin, cube.size, options.ambient_accuracy, options.ambient_resolution));
    freezable = std::make_unique<PublishedCache>(*ambient);
    if (!settings.ambient_file.empty() && (link == nullptr || link->leads())) {
        ambient_store =
            std::make_unique<AmbientStore>(settings.ambient_file, options, *ambient, warnings);
        known = ambient_store->take_loaded();
        freezable->add(*ambient_store);
    }
    if (link != nullptr) link->exchange(*freezable, known);
}

void SceneSession::warn_of_darkness() const {
    if (!made->lights().shine()) warnings.warn("no light sources found");
}

void write_statistics(const std::string& path, const RunStatistics& s) {
    nlohmann::ordered_json json;
    json["version"] = LIGHTWALK_VERSION;
    json["command"] = s.command;
    json["threads"] = s.threads;
    if (s.ranks > 1) json["ranks"] = s.ranks;
    if (s.width > 0)
        json["picture"] = {{"width", s.width}, {"height", s.height}, {"frames", s.frames}};
    json["seconds"] = {{"read", s.scene.read_seconds},
                       {"build", s.scene.build_seconds},
                       {"render", s.render_seconds}};
    json["rays"] = {{"primary", s.rays.primary},   {"shadow", s.rays.shadow},
                    {"specular", s.rays.specular}, {"transmitted", s.rays.transmitted},
                    {"ambient", s.rays.ambient},   {"total", s.rays.total()}};
    if (s.ambient_values > 0 || s.ambient.computed > 0) {
        json["ambient"] = {
            {"interpolated", s.ambient.interpolated}, {"computed", s.ambient.computed},
            {"incomplete", s.ambient.incomplete},     {"waits", s.ambient.waits},
            {"duplicates", s.ambient.duplicates},     {"cached", s.ambient_values},
            {"cache_bytes", s.ambient_bytes}};
    }
    if (!s.walk.empty()) json["reuse"] = s.walk.json();
    json["rays_per_second"] =
        static_cast<double>(s.rays.total()) / std::max(s.render_seconds, 1e-9);
    json["peak_memory_bytes"] = peak_memory_bytes();
    json["peak_memory_bytes_until"] = {{"read", s.scene.read_peak_bytes},
                                       {"built", s.scene.build_peak_bytes}};
    for (const auto& [rank, report] : s.reports) {
        auto one = nlohmann::ordered_json::parse(report);
        one.erase("spans");
        json["per_rank"].push_back(std::move(one));
    }
    write_file_atomically(path, json.dump(2) + "\n");
}

}  // namespace lightwalk
