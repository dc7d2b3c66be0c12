#include "apps/rank_options.h"

#include <cstdlib>

#include "core/error.h"
#include "io/files/module.h"
#include "parallel/ranks/mpi_module.h"

namespace lightwalk {
namespace {

Variant variant_named(const std::string& name) {
    if (name == "threads") return Variant::threads;
    if (name == "ranks") return Variant::ranks;
    if (name == "hybrid") return Variant::hybrid;
    throw UsageError("option --variant: expected threads, ranks or hybrid, found \"" + name + "\"");
}

SceneFrom scene_from_named(const std::string& name) {
    if (name == "shared") return SceneFrom::shared;
    if (name == "each") return SceneFrom::each;
    if (name == "rank0") return SceneFrom::rank0;
    throw UsageError("option --scene-from: expected shared, each or rank0, found \"" + name + "\"");
}

int count_or_auto(OptionWords& words, int most) {
    const std::string option = words.option();
    const std::string text = words.text();
    if (text == "auto") return 0;
    std::size_t used = 0;
    int count = 0;
    try {
        count = std::stoi(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (used == 0 || used != text.size() || count < 1 || count > most) {
        throw UsageError("option " + option + ": expected auto or a number from 1 to " +
                         std::to_string(most) + ", found \"" + text + "\"");
    }
    return count;
}

}  // namespace

bool parse_rank_option(OptionWords& words, RankOptions& options) {
    constexpr int kLargestBlock = 4096, kLargestStride = 1 << 20, kMostMasters = 4096;
    constexpr int kLargestBatch = 1 << 16;
    const std::string& word = words.option();
    if (word == "--variant") {
        options.variant = variant_named(words.text());
    } else if (word == "--scene-from") {
        options.scene_from = scene_from_named(words.text());
    } else if (word == "--block") {
        options.block = count_or_auto(words, kLargestBlock);
    } else if (word == "--stride") {
        options.stride = count_or_auto(words, kLargestStride);
    } else if (word == "--masters") {
        options.masters = count_or_auto(words, kMostMasters);
    } else if (word == "--timeline") {
        options.timeline = words.text();
    } else if (word == "--ambient-batch") {
        options.ambient_batch = words.integer();
        if (options.ambient_batch < 0 || options.ambient_batch > kLargestBatch)
            throw UsageError("option --ambient-batch: expected a number from 0 to 65536");
    } else {
        return false;
    }
    return true;
}

std::vector<std::string> rank_option_names() {
    return {"--variant", "--scene-from",    "--block",   "--stride",
            "--masters", "--ambient-batch", "--timeline"};
}

bool started_by_mpi() {
    // What Open MPI, PMIx and PMI (srun) set for those they start.
    for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"}) {
        // NOLINTNEXTLINE(concurrency-mt-unsafe): before there are threads.
        if (std::getenv(name) != nullptr) return true;
    }
    return false;
}

std::unique_ptr<Transport> open_mpi() {
    std::string error;
    const auto open =
        reinterpret_cast<OpenMpi>(load_from_module(kMpiModule, kOpenMpiSymbol, error));
    std::unique_ptr<Transport> transport;
    if (open != nullptr) transport.reset(open(nullptr, nullptr, error = {}));
    if (!transport) throw InputError("cannot start MPI: " + error);
    return transport;
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
