#include "apps/rank_starter.h"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <regex>
#include <sstream>

#include "io/files/program_path.h"

namespace lightwalk {
namespace {

using Words = std::vector<std::string>;

// NOLINTBEGIN(concurrency-mt-unsafe): there is one thread, or none that writes the environment

void set_by_default(const char* name, const char* value) {
    (void)setenv(name, value, 0);
}

Words mpirun_words(const RanksToStart& what) {
    Words words{"mpirun"};
    std::string list;
    for (const LaunchHost& host : what.hosts)
        list += (list.empty() ? "" : ",") + host.name + ':' + std::to_string(host.slots);
    if (!what.hosts.empty()) words.insert(words.end(), {"--host", list});
    if (what.ranks > 0) words.insert(words.end(), {"-n", std::to_string(what.ranks)});
    for (const std::string& name : what.variables) words.insert(words.end(), {"-x", name});
    return words;
}

/// srun hands its environment on. Without --input each rank would get what rank 0 reads.
Words srun_words(const RanksToStart& what) {
    Words words{"srun",      "--mpi=pmix",          "--kill-on-bad-exit=1", "--unbuffered",
                "--input=0", "--quit-on-interrupt", "--export=ALL"};
    std::string list;
    for (const LaunchHost& host : what.hosts) list += (list.empty() ? "" : ",") + host.name;
    if (!what.hosts.empty())
        words.insert(words.end(),
                     {"--nodelist=" + list, "--nodes=" + std::to_string(what.hosts.size())});
    if (what.ranks > 0) words.push_back("--ntasks=" + std::to_string(what.ranks));
    // A job's step gets as many cores a rank as it says itself.
    if (const char* const cores = std::getenv("SLURM_CPUS_PER_TASK"))
        words.push_back(std::string("--cpus-per-task=") + cores);
    return words;
}

// NOLINTEND(concurrency-mt-unsafe)

std::string rank_on(const std::string& rank, const std::string& host) {
    return "rank " + rank + (host == machine_name() ? "" : " on " + host);
}

std::string loss_by_mpirun(const std::string& last_words) {
    static const std::regex kTold(
        R"(process rank\s+(\d+)\s+with PID \d+ on node\s+(\S+)\s+exited on\s+signal\s+(\d+))");
    std::smatch found;
    if (!std::regex_search(last_words, found, kTold)) return {};
    const std::string signal = found[3].str();
    return rank_on(found[1], found[2]) +
           (signal == std::to_string(SIGKILL) ? " was killed" : " was ended by signal " + signal);
}

/// The first is who was lost; others are ended for that.
std::string loss_by_srun(const std::string& last_words) {
    static const std::regex kNode(R"(srun: error: Node failure on (\S+))");
    static const std::regex kTask(
        R"(srun: error: (\S+): tasks? (\d+)[-,\d]*: (?!Exited|Terminated)([^\n]+))");
    std::smatch found;
    if (std::regex_search(last_words, found, kNode)) return found[1].str() + " is lost";
    if (!std::regex_search(last_words, found, kTask)) return {};
    return rank_on(found[2], found[1]) +
           (found[3] == "Killed" ? " was killed" : " was ended: " + found[3].str());
}

}  // namespace

RankStarter usual_starter() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): before there are threads
    const bool in_job = std::getenv("SLURM_JOB_ID") != nullptr;
    return in_job && !program_path("srun").empty() ? RankStarter::srun : RankStarter::mpirun;
}

void settle_starter(RankStarter starter) {
    if (starter == RankStarter::srun) {
        (void)unsetenv("SLURM_LABELIO");  // NOLINT: lines would not be those of the ranks
        return;
    }
    // With these mpirun notices that a host is gone, and a rank that is killed holds no lock.
    set_by_default("OMPI_MCA_oob_tcp_keepalive_time", "5");
    set_by_default("OMPI_MCA_oob_tcp_keepalive_intvl", "2");
    set_by_default("OMPI_MCA_oob_tcp_keepalive_probes", "2");
    set_by_default("PMIX_MCA_gds", "hash");
}

std::vector<std::string> starter_words(RankStarter starter, const RanksToStart& what) {
    Words words = starter == RankStarter::srun ? srun_words(what) : mpirun_words(what);
    std::istringstream more(what.more);
    for (std::string word; more >> word;) words.push_back(word);
    return words;
}

std::string starter_package(RankStarter starter) {
    return starter == RankStarter::srun ? "it is in Debian's package slurm-client"
                                        : "it is in Debian's package openmpi-bin";
}

std::string told_loss(RankStarter starter, const std::string& last_words) {
    return starter == RankStarter::srun ? loss_by_srun(last_words) : loss_by_mpirun(last_words);
}

std::string machine_name() {
    std::array<char, 256> name{};
    (void)gethostname(name.data(), name.size() - 1);
    return name.data();
}

}  // namespace lightwalk
