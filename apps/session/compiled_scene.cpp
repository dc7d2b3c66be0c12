#include "apps/session/compiled_scene.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "apps/session/heap.h"
#include "apps/session/parse_queue.h"
#include "apps/session/stopwatch.h"
#include "core/material/modifier_factories.h"
#include "io/language/primitive_text.h"
#include "io/scene/binary_models.h"
#include "io/scene/extended_resources.h"
#include "io/scene/file_resources.h"
#include "io/scene/freezing_resources.h"
#include "io/scene/scene_reader.h"
#include "parallel/executor.h"
#include "parallel/executor_task_runner.h"

namespace lightwalk {
namespace {

/// Beyond this a process holds on to no memory that it has done with; of a smaller one the pages
/// are worth more where they are [bytes].
constexpr std::uint64_t kLarge = std::uint64_t{64} << 20;

LibraryPath library_of(const SceneSource& source, const std::shared_ptr<FileSource>& files) {
    return source.library.empty() ? LibraryPath::from_environment(files)
                                  : LibraryPath(source.library, files);
}

/// Primitives as a scene file has them.
std::string scene_text(const std::vector<ScenePrimitive>& primitives) {
    constexpr int kExactDigits = 17;
    std::string text;
    for (const ScenePrimitive& p : primitives)
        write_primitive({p.modifier, p.type, {}, p.name, p.strings, p.numbers, {}}, kExactDigits,
                        text);
    return text;
}

}  // namespace

std::uint64_t peak_memory_bytes() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return static_cast<std::uint64_t>(used.ru_maxrss) * 1024;  // Linux counts in KiB
}

void CallbackWarnings::warn(const std::string& message) {
    if (!take_) return;
    const std::lock_guard lock(mutex_);
    take_(message);
}

namespace {

struct WarningScene {
    WarningScene(const SceneSource& source, TakeWarning warn, std::shared_ptr<FileRecorder> files,
                 const std::string& shared_by)
        : warnings(std::move(warn)), scene(source, warnings, std::move(files), shared_by) {}
    CallbackWarnings warnings;
    CompiledScene scene;
};

}  // namespace

CompiledScene::CompiledScene(const SceneSource& source, WarningSink& warnings,
                             std::shared_ptr<FileRecorder> files, const std::string& shared_by)
    : warnings_(warnings),
      files_(std::move(files)),
      library_(library_of(source, files_)),
      threads_(source.threads > 0 ? source.threads : hardware_threads()),
      trim_heap_(source.trim_heap),
      ablation_(source.ablation) {
    const Stopwatch watch;
    if (!shared_by.empty())
        map_shared(shared_by);
    else if (source.files.empty())
        read_bytes(source);
    else
        read(source);
    cost_.read_seconds = watch.seconds();
    cost_.read_peak_bytes = peak_memory_bytes();
}

CompiledScene::CompiledScene(const std::shared_ptr<const CompiledScene>& base,
                             const ModelChange& change, WarningSink& warnings)
    : base_(base->base_ ? base->base_ : base),
      warnings_(warnings),
      files_(base->files_),
      library_(base->library_),
      threads_(base->threads_),
      trim_heap_(base->trim_heap_),
      ablation_(base->ablation_),
      resources_(base->resources_),
      frozen_(base->frozen_),
      extended_(true),
      model_(base->model_),
      keys_(base->keys_),
      sources_moved_(base->sources_moved_) {
    const Stopwatch watch;
    const std::unique_ptr<Executor> executor = make_executor(kDefaultExecutor, threads_);
    const ExecutorTaskRunner task_runner(*executor);
    try {
        scene_ = std::make_shared<const Scene>(base->scene_, change, modifier_factory, *resources_,
                                               warnings_, task_runner);
    } catch (const GeometryChange&) {
        model_ = changed_model(*model_, change);
        scene_ = std::make_shared<const Scene>(model_, modifier_factory, *resources_, warnings_,
                                               task_runner, SceneExtent::whole, ablation_, keys_);
    }
    cost_.build_seconds = watch.seconds();
    cost_.build_peak_bytes = peak_memory_bytes();
}

void CompiledScene::read(const SceneSource& source) {
    const std::vector<std::string>& names = source.files;
    if (!source.bytes.empty() || !source.primitives.empty())
        throw InputError("a scene comes from files or from memory, not from both");
    const auto is_frozen = [&](const std::string& name) { return is_frozen_scene(name, *files_); };
    const bool first = is_frozen(names.front());
    const auto late = std::find_if(names.begin() + 1, names.end(), is_frozen);
    if (late != names.end()) throw InputError({*late, 0}, kOneBase);
    if (!first) return read_files(source, nullptr);
    // Every rank maps it itself, also where one reads for all: its pages are shared anyway.
    std::unique_ptr<FrozenScene> base =
        open_frozen_scene(files_->place_of(names.front()), source.allow_stale);
    files_->note_mapped(names.front(), base->file().digest());
    if (names.size() > 1) return read_files(source, std::move(base));
    adopt(std::move(base));
}

/// Scene files, alone or, behind its name, in addition to a frozen scene.
void CompiledScene::read_files(const SceneSource& source, std::unique_ptr<FrozenScene> base) {
    auto library = std::make_unique<FileResources>(library_, source.allow_commands, warnings_);
    MakeTextPipe pipe;
    if (threads_ > 1) pipe = [](TextSink& next) { return std::make_unique<ParseQueue>(next); };
    const std::span<const std::string> names = source.files;
    extended_ = base != nullptr;
    const SceneReadOptions options{
        library_, source.allow_commands, {}, pipe, extended_ ? base->model() : nullptr};
    model_ = read_scene(names.subspan(extended_ ? 1 : 0), options, warnings_, &problems_);
    frozen_ = base.get();
    if (extended_)
        resources_ = std::make_unique<ExtendedResources>(std::move(base), std::move(library));
    else
        resources_ = std::move(library);
}

void CompiledScene::read_bytes(const SceneSource& source) {
    if (!source.bytes.empty() && !source.primitives.empty())
        throw InputError("a scene comes from bytes or from primitives, not from both");
    if (is_frozen_scene(source.bytes)) return map_bytes(source);
    resources_ = std::make_unique<FileResources>(library_, source.allow_commands, warnings_);
    const SceneReadOptions options{library_, source.allow_commands, {}, {}};
    if (is_octree(source.bytes))
        model_ = read_octree(source.bytes, source.name, options, warnings_, &problems_);
    else
        model_ =
            parse_scene(source.primitives.empty() ? source.bytes : scene_text(source.primitives),
                        source.name, options, warnings_);
}

/// A frozen scene shows its bytes, from an address that is a multiple of 8 on.
void CompiledScene::map_bytes(const SceneSource& source) {
    const std::size_t size = source.bytes.size();
    const auto owner = std::make_shared<std::vector<std::uint64_t>>((size + 7) / 8);
    std::memcpy(owner->data(), source.bytes.data(), size);
    const std::span bytes(reinterpret_cast<const std::byte*>(owner->data()), size);
    adopt(std::make_unique<FrozenScene>(FrozenFile(owner, bytes, source.name)));
}

void CompiledScene::adopt(std::unique_ptr<FrozenScene> opened) {
    model_ = opened->model();
    frozen_ = opened.get();
    resources_ = std::move(opened);
}

/// What a process shares was not frozen, as far as others are concerned.
void CompiledScene::map_shared(const std::string& path) {
    adopt(open_frozen_scene(path, true));
    frozen_ = nullptr;
}

std::string CompiledScene::share() {
    const Stopwatch watch;
    FreezingResources asked(*resources_);
    problems_.raise();
    {
        const std::unique_ptr<Executor> executor = make_executor(kDefaultExecutor, threads_);
        CallbackWarnings later({});  // they come when the scene is compiled to be rendered
        const Scene compiled(model_, modifier_factory, asked, later, ExecutorTaskRunner(*executor),
                             SceneExtent::without_search);
        try {
            shared_ = share_scene(compiled, asked);
        } catch (const InputError&) {
            return {};
        }
    }
    map_shared(shared_->path());
    cost_.read_seconds += watch.seconds();
    cost_.read_peak_bytes = peak_memory_bytes();
    return shared_->path();
}

void CompiledScene::compile(Resources& asked) {
    const Stopwatch watch;
    const std::unique_ptr<Executor> executor = make_executor(kDefaultExecutor, threads_);
    problems_.raise();
    trim_heap();
    sources_moved_ = false;
    scene_ = std::make_shared<const Scene>(model_, modifier_factory, asked, warnings_,
                                           ExecutorTaskRunner(*executor), SceneExtent::whole,
                                           ablation_, keys_);
    trim_heap();
    cost_.build_seconds = watch.seconds();
    cost_.build_peak_bytes = peak_memory_bytes();
}

ModelDifference CompiledScene::compare_with(const CompiledScene& before) {
    constexpr std::size_t kMostPieces = 256;
    problems_.raise();
    ComparedModel compared = compare_models(before.model(), model_);
    model_ = std::move(compared.model);
    ModelDifference& difference = compared.difference;
    sources_moved_ = before.sources_moved_ || !difference.sources_in_place;
    if (!before.sources_moved_ && before.keys_.pieces() < kMostPieces) {
        keys_ = before.keys_;
        if (difference.before_count != difference.after_count)
            keys_ =
                keys_.replaced(difference.first, difference.before_count, difference.after_count);
    } else if (!difference.same_geometry) {
        difference.keys_kept = false;
    }
    return difference;
}

void CompiledScene::compile_on(const std::shared_ptr<const CompiledScene>& before) {
    const Stopwatch watch;
    const std::unique_ptr<Executor> executor = make_executor(kDefaultExecutor, threads_);
    scene_ = std::make_shared<const Scene>(before->scene_, unchanged(*model_), modifier_factory,
                                           *resources_, warnings_, ExecutorTaskRunner(*executor));
    base_ = before->base_ ? before->base_ : before;
    cost_.build_seconds = watch.seconds();
    cost_.build_peak_bytes = peak_memory_bytes();
}

void CompiledScene::trim_heap() const {
    if (trim_heap_ && peak_memory_bytes() > kLarge) give_back_heap();
}

std::shared_ptr<CompiledScene> read_compiled_scene(const SceneSource& source, TakeWarning warn,
                                                   std::shared_ptr<FileRecorder> files,
                                                   const std::string& shared_by) {
    const auto made =
        std::make_shared<WarningScene>(source, std::move(warn), std::move(files), shared_by);
    return {made, &made->scene};
}

}  // namespace lightwalk
