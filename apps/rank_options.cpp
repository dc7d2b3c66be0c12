#include "apps/rank_options.h"

#include <cstdio>
#include <string_view>

#include "apps/commands.h"
#include "core/error.h"
#include "io/options/option_words.h"
#include "parallel/comm/communicator.h"

namespace lightwalk {

std::vector<OptionRow> rank_option_rows(RankCommand& command) {
    RankOptions& o = command.options;
    return {
        {"Many processes, on one machine or many: mpirun -n RANKS lightwalk ...",
         SectionTitle{"render"}},
        {"--variant WHICH",
         choice(command.variant, {{"threads", Variant::threads},
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
        {"--timeline FILE.json", &command.timeline,
         "what every thread did when: opens in ui.perfetto.dev. --stats has the sums, by rank"}};
}

void parse_on_ranks(Communicator* communicator, const std::string& program,
                    FunctionRef<void(const std::shared_ptr<FileSource>&)> parse) {
    if (communicator == nullptr || communicator->size() == 1) return parse(real_files());
    // What goes round: an exit status, and where that is 0 what rank 0 has read.
    const auto tell = [&](int status, const std::string& recording) {
        (void)communicator->broadcast(std::to_string(status) + recording);
    };
    if (communicator->rank() == 0) {
        const auto recorder = std::make_shared<FileRecorder>(real_files(), true);
        try {
            parse(recorder);
        } catch (const UsageError&) {
            tell(kUsageStatus, "");
            throw;
        } catch (const std::exception&) {
            tell(kFailureStatus, "");
            throw;
        }
        return tell(kSuccessStatus, recorder->take());
    }
    const std::string told = communicator->broadcast({});
    if (told.front() == '0' + kUsageStatus) throw UsageError("");
    if (told.front() != '0' + kSuccessStatus) throw InputError("");
    try {
        parse(std::make_shared<FileReplay>(std::string_view(told).substr(1)));
    } catch (const std::exception& error) {
        const bool usage = dynamic_cast<const UsageError*>(&error) != nullptr;
        std::fprintf(stderr, "%s: rank %d (%s): %s\n", program.c_str(), communicator->rank(),
                     communicator->host().c_str(), printable(error.what()).c_str());
        communicator->abort(usage ? kUsageStatus : kFailureStatus);
    }
}

Variant resolve_variant(const RankCommand& command, int ranks, int threads, bool ambient) {
    const int least = ambient ? 3 : 2;  // master, ambient master and a worker
    const bool spare = ranks >= least;
    if (!command.variant) return threads > 1 || ranks <= least ? Variant::hybrid : Variant::ranks;
    if (*command.variant == Variant::threads && ranks > 1)
        throw UsageError("--variant threads is one process, but mpirun started " +
                         std::to_string(ranks));
    if (*command.variant == Variant::ranks && !spare) {
        throw UsageError("--variant ranks needs at least " + std::to_string(least) +
                         " ranks here: a master, " +
                         (ambient ? "an ambient master and workers" : "and workers"));
    }
    return *command.variant;
}

std::unique_ptr<Ranks> join_ranks(Communicator* communicator, const RankCommand& command,
                                  const std::string& program, const RendererOptions& work) {
    if (communicator == nullptr && command.variant.value_or(Variant::threads) != Variant::threads)
        throw UsageError(
            "--variant ranks and hybrid need several processes: start them with mpirun -n RANKS "
            "lightwalk ...");
    if (communicator == nullptr) return nullptr;
    RankOptions options = command.options;
    options.variant = resolve_variant(command, communicator->size(), work.threads,
                                      exchange_values(options, work));
    if (options.variant == Variant::threads) return nullptr;
    options.keep_spans = !command.timeline.empty();
    options.program = program;
    options.failed = [](const std::string& message) {
        std::fprintf(stderr, "%s\n", message.c_str());
    };
    return std::make_unique<Ranks>(*communicator, options, work);
}

}  // namespace lightwalk
