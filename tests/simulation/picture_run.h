#pragma once
// Pictures drawn by simulated ranks: the real link, roles, inboxes and messages; the program that
// uses them, and what a pixel is, stand for those of `render`.
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "parallel/block_renderer.h"
#include "parallel/ranks/rank_link.h"
#include "tests/simulation/network.h"
#include "tests/simulation/world.h"

namespace lightwalk::simulation {

/// What befalls one rank.
struct Fault {
    enum class Kind {
        stop,       ///< its process does not run for a while
        unplug,     ///< its cable is pulled for a while
        kill,       ///< its process ends
        cut,        ///< its host is gone
        fail,       ///< the next piece of work that it traces cannot be traced
        interrupt,  ///< somebody interrupts it
    };
    Kind kind = Kind::stop;
    int rank = 0;
    std::uint64_t message = 0;  ///< once so many have been sent; 0: see time
    Time time{};
    Time lasts{};

    [[nodiscard]] bool passes() const { return kind == Kind::stop || kind == Kind::unplug; }
};
[[nodiscard]] const char* name_of(Fault::Kind kind);

/// A run of ranks.
struct Plan {
    Variant variant = Variant::ranks;
    int ranks = 4, masters = 1;
    int slots = 1, ahead = 1;
    int block = 8, stride = 0;
    int width = 40, height = 32, pictures = 1;
    Time longest_delay = milliseconds(1), longest_block = milliseconds(100);
    bool broadcasts = false;  ///< something before the work begins
    std::vector<Fault> faults;
};
[[nodiscard]] std::string description_of(const Plan& plan);

/// Errors that are planted, to see that they are found.
struct Planted {
    Mishap mishap;               ///< null: none
    bool forgets_known = false;  ///< the master does not pass on one of the blocks that it kept
    bool never_loses_patience = false;  ///< nobody watches others' silence
};

/// What the master has kept of each picture: blocks, as they lie on a disk.
using Disk = std::map<int, std::vector<BlockPixels>>;

/// How a run ended, and what it did.
struct Outcome {
    bool ended = false;                 ///< before the world's time was over
    bool finished = false;              ///< with all pictures, on all ranks
    std::vector<std::string> failures;  ///< that ranks told
    std::string wrong;                  ///< "": nothing
    Time end{}, last_fault{};
    std::uint64_t messages = 0;
};

/// Plays one run. What it finds on the disk is known, and what it keeps is added to it.
class PictureRun {
  public:
    PictureRun(Fibers& fibers, const Plan& plan, const Planted& planted, Disk& disk,
               std::uint64_t seed);
    [[nodiscard]] Outcome play();

  private:
    struct Picture {
        int number = 0;
        std::vector<int> traced;  ///< how often, by pixel
        std::vector<bool> known;  ///< from an earlier run
        bool done = false;
    };

    void plant_faults();
    void befall(const Fault& fault);
    void play_rank(int rank);
    void program(RankLink& link);
    void lead(RankLink& link);
    void start_picture(RankLink& link, Picture& picture);
    void take(ProgramNews news);
    void keep(LoggedPixels logged);
    void trace(RankLink& link);
    void trace_on_thread(RankLink& link);
    void trace_block(RankLink& link, const JobBlock& work);
    void check(const FinishedPicture& finished, Picture& picture);
    void check_end();
    void complain(std::string text) {
        if (outcome_.wrong.empty()) outcome_.wrong = std::move(text);
    }

    const Plan& plan_;
    const Planted& planted_;
    Disk& disk_;
    World world_;
    Network network_;
    Topology topology_;
    std::shared_ptr<WorldThreads> threads_;
    std::vector<StopFlag> stop_;  ///< by rank
    std::vector<bool> fails_;     ///< by rank: see Fault::Kind::fail
    std::map<JobId, Picture> pictures_;
    std::vector<int> reports_;  ///< by rank
    int left_ = 0;              ///< ranks that have returned
    bool may_end_ = false;      ///< something has befallen a rank that no run has to bear
    Time silent_{};             ///< how long ranks were, one after the other
    Outcome outcome_;
};

}  // namespace lightwalk::simulation
