// What mpirun and srun are told, and what they tell.
#include "apps/rank_starter.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace lightwalk::test {
namespace {

std::string line_of(RankStarter starter, const RanksToStart& what) {
    std::string line;
    for (const std::string& word : starter_words(starter, what))
        line += (line.empty() ? "" : " ") + word;
    return line;
}

}  // namespace

TEST_CASE("rank starter: hosts, ranks and variables are named as each program wants them") {
    const RanksToStart here{2, {}, {"TOKEN"}, "--more words"};
    const RanksToStart far{3, {{"a", 2}, {"b", 1}}, {"TOKEN"}, ""};
    CHECK(line_of(RankStarter::mpirun, here) == "mpirun -n 2 -x TOKEN --more words");
    CHECK(line_of(RankStarter::mpirun, far) == "mpirun --host a:2,b:1 -n 3 -x TOKEN");
    (void)unsetenv("SLURM_CPUS_PER_TASK");
    const std::string srun =
        "srun --mpi=pmix --kill-on-bad-exit=1 --unbuffered --input=0 --quit-on-interrupt "
        "--export=ALL";
    CHECK(line_of(RankStarter::srun, {}) == srun);
    CHECK(line_of(RankStarter::srun, here) == srun + " --ntasks=2 --more words");
    CHECK(line_of(RankStarter::srun, far) == srun + " --nodelist=a,b --nodes=2 --ntasks=3");
    (void)setenv("SLURM_CPUS_PER_TASK", "8", 1);
    CHECK(line_of(RankStarter::srun, here) == srun + " --ntasks=2 --cpus-per-task=8 --more words");
    (void)unsetenv("SLURM_CPUS_PER_TASK");
}

TEST_CASE("rank starter: who was lost is the first that was killed, not those that follow it") {
    const std::string here = machine_name();
    const auto mpirun = [](const std::string& text) {
        return told_loss(RankStarter::mpirun, text);
    };
    CHECK(mpirun("mpirun noticed that process rank 2 with PID 17 on node " + here +
                 " exited on signal 9 (Killed).") == "rank 2 was killed");
    CHECK(mpirun("process rank 2 with PID 17 on node\nfar exited on signal 11") ==
          "rank 2 on far was ended by signal 11");
    CHECK(mpirun("all is well").empty());
    const auto srun = [](const std::string& text) { return told_loss(RankStarter::srun, text); };
    CHECK(srun("srun: error: " + here + ": task 3: Killed\nsrun: error: far: task 0: Killed\n") ==
          "rank 3 was killed");
    CHECK(srun("srun: error: far: tasks 0-1: Terminated\n"
               "srun: error: far: task 2: Segmentation fault\n") ==
          "rank 2 on far was ended: Segmentation fault");
    CHECK(srun("srun: error: far: tasks 4,7-8: Killed\n") == "rank 4 on far was killed");
    CHECK(srun("srun: error: far: task 0: Exited with exit code 1\n").empty());
    CHECK(srun("srun: error: Node failure on far\nsrun: error: near: task 0: Killed\n") ==
          "far is lost");
}

}  // namespace lightwalk::test
