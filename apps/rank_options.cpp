#include "apps/rank_options.h"

#include <cstdlib>

#include "core/error.h"
#include "io/files/module.h"
#include "parallel/comm/mpi_module.h"

namespace lightwalk {
std::vector<OptionRow> rank_option_rows(RankOptions& o) {
    return {
        {"Many processes, on one machine or many: mpirun -n RANKS lightwalk ...",
         SectionTitle{"render"}},
        {"--variant WHICH",
         choice(o.variant, {{"threads", Variant::threads},
                            {"ranks", Variant::ranks},
                            {"hybrid", Variant::hybrid}}),
         "threads: one process, no ranks; ranks: one thread a rank, one rank is the master, with "
         "-ab another one the ambient master; hybrid: ranks of threads (-n each), rank 0 traces "
         "beside being the master. Without: hybrid where ranks have several threads (-n, or what "
         "mpirun binds them to) or are too few to spare any, otherwise ranks"},
        {"--scene-from WHO",
         choice(o.scene_from, {{"shared", SceneFrom::shared},
                               {"each", SceneFrom::each},
                               {"rank0", SceneFrom::rank0}}),
         "shared: on one machine rank 0 reads the scene, and all share its memory; on several as "
         "each: every rank reads its own copy (a frozen scene is in memory once a machine anyway); "
         "rank0: rank 0 reads it for all, where the others do not see its files"},
        {"--block auto|N", &o.block,
         "side of the blocks of pixels that are handed out; auto: follows how long they take",
         With{.least = 1, .most = 4096, .zero = "auto"}},
        {"--stride auto|N", &o.stride,
         "distance of the blocks that are handed out one after the other, in blocks; auto: the "
         "number of workers",
         With{.least = 1, .most = 1 << 20, .zero = "auto"}},
        {"--masters auto|N", &o.masters,
         "number of masters: each of those below rank 0 serves a group of workers",
         With{.least = 1, .most = 4096, .zero = "auto"}},
        {"--ambient-batch N", &o.ambient_batch,
         "ambient values that a worker collects before it sends them to the other ranks; 0: none "
         "are exchanged",
         With{.least = 0, .most = 1 << 16}},
        {"--timeline FILE.json", &o.timeline,
         "what every thread did when: opens in ui.perfetto.dev. --stats has the sums, by rank"}};
}

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

void check_launch(const RankOptions& options, bool by_mpi) {
    if (by_mpi || options.variant.value_or(Variant::threads) == Variant::threads) return;
    throw UsageError(
        "--variant ranks and hybrid need several processes: start them with mpirun -n RANKS "
        "lightwalk ...");
}

Variant resolve_variant(const RankOptions& options, int ranks, int threads, bool ambient) {
    const int least = ambient ? 3 : 2;  // master, ambient master and a worker
    const bool spare = ranks >= least;
    if (!options.variant) return threads > 1 || ranks <= least ? Variant::hybrid : Variant::ranks;
    if (*options.variant == Variant::threads && ranks > 1)
        throw UsageError("--variant threads is one process, but mpirun started " +
                         std::to_string(ranks));
    if (*options.variant == Variant::ranks && !spare) {
        throw UsageError("--variant ranks needs at least " + std::to_string(least) +
                         " ranks here: a master, " +
                         (ambient ? "an ambient master and workers" : "and workers"));
    }
    return *options.variant;
}

}  // namespace lightwalk
