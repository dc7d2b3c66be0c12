#pragma once
// Options of runs on many ranks, and whether this process is one of several.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/options/option_rows.h"
#include "parallel/comm/communicator.h"
#include "parallel/ranks/topology.h"

namespace lightwalk {

/// Who reads a scene's files.
enum class SceneFrom {
    shared,  ///< rank 0 alone where all are on one machine, and they share its memory; else each
    each,    ///< every rank its own copy of them
    rank0,   ///< rank 0 alone, for all
};

struct RankOptions {
    std::optional<Variant> variant;  ///< --variant; nothing: follows from how we were started
    int block = 0;                   ///< --block [pixels]; 0: auto
    int stride = 0;                  ///< --stride; 0: auto
    int masters = 0;                 ///< --masters; 0: auto
    int ambient_batch = 16;          ///< --ambient-batch; 0: no values are exchanged
    SceneFrom scene_from = SceneFrom::shared;  ///< --scene-from
    std::string timeline;  ///< --timeline: file for the spans of all threads; "" is none
};

[[nodiscard]] std::vector<OptionRow> rank_option_rows(RankOptions& options);

/// Whether mpirun or srun started this process.
[[nodiscard]] bool started_by_mpi();
/// The wire to the other ranks. Throws InputError when MPI cannot be loaded or started.
[[nodiscard]] std::unique_ptr<Communicator> open_mpi();

/// Throws UsageError for --variant ranks or hybrid in a process that nothing but a shell started.
void check_launch(const RankOptions& options, bool by_mpi);

/// The variant that runs: the one asked for, or else `hybrid` where ranks have several threads or
/// are too few to spare any, and `ranks` otherwise. Throws UsageError where it cannot be.
/// @param threads  of each rank
[[nodiscard]] Variant resolve_variant(const RankOptions& options, int ranks, int threads,
                                      bool ambient);

}  // namespace lightwalk
