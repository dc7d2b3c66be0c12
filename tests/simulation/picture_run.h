#pragma once
// Pictures drawn by simulated ranks: the program that draws them, and what a pixel is, stand for
// those of `render`.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "parallel/block_renderer.h"
#include "tests/simulation/rank_run.h"

namespace lightwalk::simulation {

struct PicturePlan : RankPlan {
    int block = 8, stride = 0;
    int width = 40, height = 32, pictures = 1;
};
[[nodiscard]] std::string description_of(const PicturePlan& plan);

/// What the master has kept of each picture: blocks, as they lie on a disk.
using Disk = std::map<int, std::vector<BlockPixels>>;

/// Plays one run. What it finds on the disk is known, and what it keeps is added to it.
class PictureRun final : public RankRun {
  public:
    PictureRun(Fibers& fibers, const PicturePlan& plan, const Planted& planted, Disk& disk,
               std::uint64_t seed)
        : RankRun(fibers, plan, planted, seed), plan_(plan), disk_(disk) {}

  private:
    struct Picture {
        int number = 0;
        std::vector<int> traced;  ///< how often, by pixel
        std::vector<bool> known;  ///< from an earlier run
        bool done = false;
    };

    void change(RankSettings& settings) const override;
    void lead(RankLink& link) override;
    void trace(RankLink& link) override;
    void take(ProgramNews news) override;
    [[nodiscard]] bool all_drawn() const override;
    [[nodiscard]] bool all_done() const;
    void start_picture(RankLink& link, Picture& picture);
    void keep(LoggedPixels logged);
    void trace_on_thread(RankLink& link);
    void trace_block(RankLink& link, const JobBlock& work);
    void check(const FinishedPicture& finished, Picture& picture);

    const PicturePlan& plan_;
    Disk& disk_;
    std::map<JobId, Picture> pictures_;
};

}  // namespace lightwalk::simulation
