#include "apps/rank_options.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string_view>
#include <utility>

#include "apps/commands.h"
#include "core/error.h"
#include "core/model/transform_args.h"
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
         "shared: of each machine one rank reads the scene, and the others share its memory; each: "
         "every rank reads its own copy (a frozen scene is in memory once a machine anyway); "
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

namespace {

/// A number of the environment; -1: there is none.
int number_of(const char* name) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody changes the environment.
    const char* const word = std::getenv(name);
    long number = -1;
    return word != nullptr && parse_integer(word, number) ? static_cast<int>(number) : -1;
}

/// What every other rank does about a command line that one of them cannot understand; rank 0 says
/// why.
void throw_status(int status) {
    if (status == kUsageStatus) throw UsageError("");
    if (status != kSuccessStatus) throw InputError("");
}

/// On rank 0, what the others say of the command line: the first problem, which others are likely
/// to have, too, after its status; "": none.
std::string hear_problems(Communicator& communicator) {
    constexpr std::chrono::milliseconds kPatience{1};
    std::map<int, std::string> problems;  // by rank
    for (int heard = 1; heard < communicator.size();) {
        std::optional<Communicator::Packet> packet = communicator.receive();
        if (!packet) {
            communicator.wait(kPatience);
            continue;
        }
        ++heard;
        if (packet->bytes.front() != '0' + kSuccessStatus)
            problems[packet->from] = std::move(packet->bytes);
    }
    return problems.empty() ? std::string() : problems.begin()->second;
}

}  // namespace

std::string warning_of_copies(int ranks) {
    struct Names {
        const char *processes, *rank;
    };
    // Open MPI, other MPIs and PMI, srun.
    for (const Names& names :
         {Names{"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"}, Names{"PMI_SIZE", "PMI_RANK"},
          Names{"SLURM_STEP_NUM_TASKS", "SLURM_PROCID"}}) {
        const int processes = number_of(names.processes);
        if (processes > ranks && number_of(names.rank) == 0)
            return std::to_string(processes) +
                   " processes were started that do not know of each other: each does all of the "
                   "work. Open MPI's mpirun starts ranks, and srun with --mpi=pmix or pmi2";
    }
    return {};
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
        tell(kSuccessStatus, recorder->take());
        const std::string problem = hear_problems(*communicator);
        tell(problem.empty() ? kSuccessStatus : problem.front() - '0', "");
        if (problem.empty()) return;
        const std::string text = problem.substr(1);
        if (problem.front() == '0' + kUsageStatus) throw UsageError(text);
        throw InputError(program + ": " + text);
    }
    const std::string told = communicator->broadcast({});
    throw_status(told.front() - '0');
    std::string problem(1, static_cast<char>('0' + kSuccessStatus));
    try {
        parse(std::make_shared<FileReplay>(std::string_view(told).substr(1)));
    } catch (const std::exception& error) {
        const bool usage = dynamic_cast<const UsageError*>(&error) != nullptr;
        problem = std::to_string(usage ? kUsageStatus : kFailureStatus) + "rank " +
                  std::to_string(communicator->rank()) + " (" + communicator->host() +
                  "): " + printable(error.what());
    }
    communicator->send(0, problem);
    throw_status(communicator->broadcast({}).front() - '0');
}

Variant resolve_variant(const RankCommand& command, int ranks, int threads, bool ambient) {
    const int least = ambient ? 3 : 2;  // master, ambient master and a worker
    const bool spare = ranks >= least;
    if (ranks == 1 && !command.timeline.empty()) return Variant::hybrid;  // which keeps one
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
