#pragma once
// Options of runs on many ranks.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/session/lightwalk/ranks.h"
#include "core/math/function_ref.h"
#include "io/files/file_source.h"
#include "io/options/option_rows.h"

namespace lightwalk {

struct RankCommand {
    std::optional<Variant> variant;  ///< --variant; nothing: follows from how we were started
    RankOptions options;             ///< --block --stride --masters --ambient-batch --scene-from
    std::string timeline;            ///< --timeline: file for the spans of all threads; "" is none
};

[[nodiscard]] std::vector<OptionRow> rank_option_rows(RankCommand& command);

/// Understands the command line: rank 0 first, by the files, environment and standard input it has;
/// then the others, by what rank 0 has read of these. `parse` throws UsageError or InputError for
/// what is wrong; when that is so on rank 0, the others throw the same without a text, and when on
/// another, rank 0 throws it, naming that rank, and all others without a text.
/// @param communicator  null: this process is alone
void parse_on_ranks(Communicator* communicator, const std::string& program,
                    FunctionRef<void(const std::shared_ptr<FileSource>&)> parse);

/// What there is to warn of where a launcher has started several processes that do not share the
/// work, as srun does without PMI: each would do all of it. For the first of them; "" is nothing.
/// @param ranks  that share the work
[[nodiscard]] std::string warning_of_copies(int ranks);

/// The variant that runs: the one asked for, or else `hybrid` where ranks have several threads or
/// are too few to spare any, and `ranks` otherwise. Throws UsageError where it cannot be.
/// @param threads  of each rank
[[nodiscard]] Variant resolve_variant(const RankCommand& command, int ranks, int threads,
                                      bool ambient);

/// This process among those that mpirun started; null: it works alone. Throws UsageError for a
/// variant that cannot be, and for --variant ranks or hybrid in a process that nothing but a shell
/// started.
/// @param program  how messages name it
[[nodiscard]] std::unique_ptr<Ranks> join_ranks(Communicator* communicator,
                                                const RankCommand& command,
                                                const std::string& program,
                                                const RendererOptions& work);

/// By all ranks, or by this process where it is alone.
[[nodiscard]] inline Renderer open_renderer(Ranks* ranks, const RendererRequest& request) {
    return ranks != nullptr ? ranks->open(request) : open_renderer(request);
}

}  // namespace lightwalk
