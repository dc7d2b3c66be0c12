#pragma once
// The programs that start ranks: Open MPI's mpirun, and Slurm's srun.
#include <string>
#include <vector>

#include "apps/launch_hosts.h"

namespace lightwalk {

enum class RankStarter { mpirun, srun };

/// srun in a job of Slurm's, where it is installed.
[[nodiscard]] RankStarter usual_starter();
/// Sets what it reads from the environment, unless the user has. Before there are threads.
void settle_starter(RankStarter starter);

struct RanksToStart {
    int ranks = 0;                       ///< 0: as many as the program thinks
    LaunchHosts hosts;                   ///< none: those that the program knows
    std::vector<std::string> variables;  ///< of the environment, which all ranks need
    std::string more;                    ///< further words, with spaces between them
};
/// What stands before the words of the ranks' program.
[[nodiscard]] std::vector<std::string> starter_words(RankStarter starter, const RanksToStart& what);

/// Why it could not be started, in which package it is.
[[nodiscard]] std::string starter_package(RankStarter starter);

/// By what it has written to standard error, "rank 2 was killed", "rank 1 on far was ended by
/// signal 11", "far is lost"; "": it tells of no loss.
[[nodiscard]] std::string told_loss(RankStarter starter, const std::string& last_words);

/// The name by which others know this machine.
[[nodiscard]] std::string machine_name();

}  // namespace lightwalk
