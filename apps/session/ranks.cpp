#include "apps/session/lightwalk/ranks.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/session/local_backend.h"
#include "apps/session/rank_backend.h"
#include "apps/session/rank_scene.h"
#include "apps/session/resident_scene.h"
#include "io/files/module.h"
#include "parallel/comm/mpi_module.h"

namespace lightwalk {
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
    settings.makes_values = caches_ambient_values(work.light) && !work.deterministic;
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
    const SceneFrom from = options_.scene_from;
    RankScene read;
    std::unique_ptr<RankBackend> backend;
    std::string problem;
    std::vector<std::string> facts;
    try {
        read = read_on_ranks(*link_, request, from);
        const auto& scene = read.scene;
        if (scene) {
            if (request.settle) request.settle(scene->scene(), request.options);
            backend = std::make_unique<RankBackend>(*link_, scene, request.options);
            facts = {"Lightwalk " LIGHTWALK_VERSION, "options: " + request.history};
            // None of a rank that shares another one's copy.
            for (const std::string& file : scene->files().digests())
                facts.push_back("file " + file);
        }
    } catch (const std::exception& error) {
        problem = error.what();
    }
    link_->agree(facts, problem,
                 from == SceneFrom::rank0
                     ? ""
                     : "Every rank, or one of each machine, reads its own copy of the scene; with "
                       "--scene-from rank0 rank 0 reads it for all.");
    backend->share_values();
    return Renderer(std::move(backend));
}

Renderer open_renderer(const RendererRequest& request) {
    std::shared_ptr<const CompiledScene> scene =
        request.resident ? request.resident->answer(request) : nullptr;
    if (!scene) scene = read_own_scene(request);
    RendererOptions options = request.options;
    if (request.settle) request.settle(scene->scene(), options);
    return Renderer(std::make_unique<LocalBackend>(scene, options));
}

}  // namespace lightwalk
