#include "apps/session/lightwalk/ranks.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/session/local_backend.h"
#include "apps/session/rank_backend.h"
#include "io/files/module.h"
#include "parallel/comm/mpi_module.h"

namespace lightwalk {
namespace {

/// What rank 0 says of the scene, before more about it; nothing: it could not read it.
constexpr char kEachItsOwn = 'e', kShared = 's', kRecorded = 'r';

/// Of a file's bytes that stay for a scene that changes.
constexpr std::size_t kLargestKept = std::size_t{1} << 18;

using ScenePtr = std::shared_ptr<CompiledScene>;

std::shared_ptr<FileSource> files_of(const RendererRequest& request) {
    return request.files ? request.files : real_files();
}

/// Not yet compiled.
ScenePtr read_by(const RendererRequest& request, std::shared_ptr<FileRecorder> files,
                 const std::string& shared_by = {}) {
    ScenePtr scene =
        read_compiled_scene(request.source, request.options.warn, std::move(files), shared_by);
    if (request.when_read) request.when_read();
    return scene;
}

ScenePtr read_own(const RendererRequest& request) {
    ScenePtr scene = read_by(request, std::make_shared<FileRecorder>(files_of(request)));
    scene->compile();
    return scene;
}

/// Rank 0's scene, and how the others come to it.
ScenePtr lead_reading(RankLink& link, const RendererRequest& request, SceneFrom from) {
    ScenePtr scene;
    std::string word;
    std::exception_ptr problem;
    try {
        const bool records = from == SceneFrom::rank0;
        const auto recorder = std::make_shared<FileRecorder>(files_of(request), records);
        scene = read_by(request, recorder);
        if (records) {
            scene->compile();  // which reads more
            word = kRecorded + recorder->take();
        } else {
            const std::string path = scene->is_frozen() ? std::string() : scene->share();
            word = path.empty() ? std::string(1, kEachItsOwn) : kShared + path;
        }
    } catch (const std::exception&) {
        problem = std::current_exception();
    }
    (void)link.broadcast(word);
    if (problem) std::rethrow_exception(problem);
    if (from != SceneFrom::rank0) scene->compile();  // as the others do at the same time
    return scene;
}

/// Another rank's scene; null: rank 0 could not read it.
ScenePtr follow_reading(RankLink& link, const RendererRequest& request) {
    const std::string word = link.broadcast({});
    if (word.empty()) return nullptr;
    const std::string_view rest = std::string_view(word).substr(1);
    if (word[0] == kRecorded) {
        const auto replay = std::make_shared<FileReplay>(rest);
        ScenePtr scene = read_by(request, std::make_shared<FileRecorder>(replay));
        scene->compile();
        // A scene that changes may ask once more for what nobody keeps, as function files.
        replay->clear(request.options.steered ? kLargestKept : 0);
        return scene;
    }
    ScenePtr scene;
    if (word[0] == kShared) {
        try {
            scene = read_by(request, std::make_shared<FileRecorder>(), std::string(rest));
        } catch (const InputError&) {  // the system lets no process look at another's
        }
    }
    if (!scene) return read_own(request);
    scene->compile();
    return scene;
}

}  // namespace

bool started_by_mpi() {
    // What Open MPI, PMIx and PMI (srun) set for those they start.
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"}) {
        // NOLINTNEXTLINE(concurrency-mt-unsafe): before there are threads.
        if (std::getenv(name) != nullptr) return true;
    }
    return false;
}

std::unique_ptr<Communicator> open_mpi() {
    std::string error;
    const auto open =
        reinterpret_cast<OpenMpi>(load_from_module(kMpiModule, kOpenMpiSymbol, error));
    std::unique_ptr<Communicator> communicator;
    if (open != nullptr) communicator.reset(open(nullptr, nullptr, error = {}));
    if (!communicator) throw InputError("cannot start MPI: " + error);
    return communicator;
}

bool exchange_values(const RankOptions& options, const RendererOptions& work) {
    // Rays that only ask what they meet need none, and who watches rays is alone. A deterministic
    // run exchanges values in rounds, among all who trace.
    const bool needed = !work.answers_rays || (work.rays.shade && work.observer == nullptr);
    return options.ambient_batch > 0 && needed && !work.keep_coefficients &&
           caches_ambient_values(work.light) && (!work.deterministic || work.steered);
}

Ranks::Ranks(Communicator& communicator, const RankOptions& options, const RendererOptions& work)
    : options_(options),
      threads_(options.variant == Variant::ranks ? 1
               : work.threads > 0                ? work.threads
                                                 : hardware_threads()),
      stop_(work.stop) {
    RankSettings settings;
    settings.slots = threads_;
    settings.ahead = std::max(1, threads_ / 2);
    settings.block = options.block;
    settings.stride = options.stride;
    const bool exchange = exchange_values(options, work);
    settings.ambient_batch = exchange ? static_cast<std::size_t>(options.ambient_batch) : 0;
    settings.rays = work.answers_rays;
    settings.projectors = work.reuse ? options.projectors : 0;
    // Chunks of rays are few, and so are the uncached pixels of a walk's frames: one master deals
    // them out.
    const int masters = work.answers_rays || work.reuse ? 1 : options.masters;
    link_ = std::make_unique<RankLink>(
        communicator, make_topology(options.variant, communicator.size(), exchange, masters),
        settings, options.program, options.failed, options.keep_spans);
}

Ranks::~Ranks() = default;

int Ranks::size() const {
    return link_->ranks();
}

bool Ranks::leads() const {
    return link_->leads();
}

void Ranks::run(FunctionRef<void()> body) {
    const StopFlag never;
    link_->run(body, stop_ != nullptr ? *stop_ : never);
}

std::string Ranks::tell(std::string said) {
    return link_->all_gather(Collective::Group::all, std::move(said)).front();
}

Renderer Ranks::open(const RendererRequest& wanted) {
    RendererRequest request = wanted;
    request.source.threads = request.options.threads = threads_;
    SceneFrom from = options_.scene_from;
    if (from == SceneFrom::shared && (size() == 1 || !link_->on_one_machine()))
        from = SceneFrom::each;
    std::unique_ptr<RankBackend> backend;
    std::string problem;
    std::vector<std::string> facts;
    try {
        const ScenePtr scene = from == SceneFrom::each ? read_own(request)
                               : leads()               ? lead_reading(*link_, request, from)
                                                       : follow_reading(*link_, request);
        if (scene) {
            if (request.settle) request.settle(scene->scene(), request.options);
            backend = std::make_unique<RankBackend>(*link_, scene, request.options);
            facts = {"Lightwalk " LIGHTWALK_VERSION, "options: " + request.history};
            if (from != SceneFrom::shared)  // of which there is one copy
                for (const std::string& file : scene->files().digests())
                    facts.push_back("file " + file);
        }
    } catch (const std::exception& error) {
        problem = error.what();
    }
    link_->agree(facts, problem,
                 from == SceneFrom::rank0
                     ? ""
                     : "Every rank reads its own copy of the scene; with --scene-from rank0 rank 0 "
                       "reads it for all.");
    backend->share_values();
    return Renderer(std::move(backend));
}

Renderer open_renderer(const RendererRequest& request) {
    const ScenePtr scene = read_own(request);
    RendererOptions options = request.options;
    if (request.settle) request.settle(scene->scene(), options);
    return Renderer(std::make_unique<LocalBackend>(scene, options));
}

}  // namespace lightwalk
