#include "tests/simulation/picture_run.h"

#include <algorithm>
#include <utility>

#include "parallel/ranks/assembly.h"

namespace lightwalk::simulation {
namespace {

PixelValue value_of(int picture, int x, int y) {
    return {{static_cast<float>(x), static_cast<float>(y), static_cast<float>(picture)},
            static_cast<float>(x * 1000 + y)};
}

BlockPixels block_of(int picture, const PixelRectangle& block) {
    BlockPixels pixels{block, {}, {}, {}};
    pixels.values.reserve(block.pixels());
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x) pixels.values.push_back(value_of(picture, x, y));
    return pixels;
}

template <class Visit>
void for_pixels(const PixelRectangle& block, int width, Visit visit) {
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x)
            visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x));
}

}  // namespace

std::string description_of(const PicturePlan& plan) {
    return description_of(plan, "blocks of " + std::to_string(plan.block) + ", " +
                                    std::to_string(plan.pictures) + " pictures");
}

void PictureRun::change(RankSettings& settings) const {
    settings.block = plan_.block;
    settings.stride = plan_.stride;
}

bool PictureRun::all_done() const {
    return std::all_of(pictures_.begin(), pictures_.end(),
                       [](const auto& one) { return one.second.done; });
}

bool PictureRun::all_drawn() const {
    return static_cast<int>(pictures_.size()) == plan_.pictures && all_done();
}

void PictureRun::lead(RankLink& link) {
    for (int number = 0; number < plan_.pictures; ++number) {
        Picture& picture = pictures_[link.new_number()];
        picture.number = number;
        start_picture(link, picture);
    }
    while (!all_done() && !stop_of(0).requested()) take_some(link);
}

void PictureRun::start_picture(RankLink& link, Picture& picture) {
    const PixelRectangle area{0, 0, plan_.width, plan_.height};
    picture.traced.assign(area.pixels(), 0);
    picture.known.assign(area.pixels(), false);
    PictureJob job{static_cast<JobId>(picture.number + 1), area, 1, true, "", {}, true};
    const std::vector<BlockPixels> kept = disk_[picture.number];
    for (const BlockPixels& block : kept) {
        job.known.push_back(block.block);
        for_pixels(block.block, plan_.width, [&](std::size_t i) { picture.known[i] = true; });
    }
    link.start({job});
    const std::vector<int> workers = topology_.worker_ranks();
    const SubImages parts(area, workers.size());
    for (std::size_t k = 0; k < kept.size(); ++k) {
        if (planted_.forgets_known && k == kept.size() / 2) continue;
        const Pixels pixels{{job.job, kept[k].block}, kept[k].values};
        for (const std::size_t i : parts.overlapping(kept[k].block))
            link.post(workers[i], WorkResult{cut_pixels(pixels, parts[i])});
    }
}

void PictureRun::take(ProgramNews news) {
    if (auto* finished = std::get_if<FinishedPicture>(&news)) {
        const auto picture = pictures_.find(finished->job);
        if (picture == pictures_.end()) return complain("a picture that nobody began");
        check(*finished, picture->second);
    } else if (auto* logged = std::get_if<LoggedPixels>(&news)) {
        keep(std::move(*logged));
    } else if (const auto* progress = std::get_if<Progress>(&news)) {
        if (progress->done > 1 + 1e-9) complain("more than the picture is done");
    }
}

void PictureRun::keep(LoggedPixels logged) {
    const PixelRectangle& block = logged.pixels.work.block;
    const auto picture = pictures_.find(logged.pixels.work.job);
    if (picture == pictures_.end()) return complain("a block of a picture that nobody began");
    const int number = picture->second.number;
    if (logged.pixels.values != block_of(number, block).values)
        complain("a block is kept whose pixels are others");
    for (const BlockPixels& other : disk_[number])
        if (!intersection(other.block, block).empty()) complain("a block is kept twice");
    disk_[number].push_back({block, std::move(logged.pixels.values), {}, {}});
}

void PictureRun::trace(RankLink& link) {
    if (plan_.slots == 1) return trace_on_thread(link);
    std::exception_ptr problem;
    const auto beside = [&] {
        try {
            trace_on_thread(link);
        } catch (const Killed&) {
            throw;
        } catch (...) {
            link.inbox().close();
            problem = std::current_exception();
        }
    };
    threads_->side_by_side(beside, [&] { trace_on_thread(link); });
    if (problem) std::rethrow_exception(problem);
}

void PictureRun::trace_on_thread(RankLink& link) {
    while (const auto item = link.inbox().next(stop_of(link.rank()))) {
        const auto* block = std::get_if<TracerInbox::PictureBlock>(&*item);
        if (block == nullptr) continue;
        try {
            trace_block(link, block->work);
        } catch (const std::exception&) {
            link.inbox().close();
            throw;
        }
    }
}

void PictureRun::trace_block(RankLink& link, const JobBlock& work) {
    const Time begin = world_.now();
    work_a_while(link.rank());
    Picture& picture = pictures_.at(work.job);
    for_pixels(work.block, plan_.width, [&](std::size_t i) {
        if (++picture.traced[i] > 1) complain("a pixel is traced twice");
        if (picture.known[i]) complain("a pixel is traced that was known");
    });
    link.finish_work(
        {FinishedWork::Payload::block, work.job, static_cast<std::uint32_t>(work.block.pixels()),
         in_seconds(world_.now() - begin)},
        Pixels{work, block_of(picture.number, work.block).values});
}

void PictureRun::check(const FinishedPicture& finished, Picture& picture) {
    if (std::exchange(picture.done, true)) complain("a picture is finished twice");
    const Frame frame = assemble_picture(finished, plan_.width, plan_.height);
    for (int y = 0; y < plan_.height; ++y) {
        for (int x = 0; x < plan_.width; ++x) {
            const auto at = static_cast<std::size_t>((plan_.height - 1 - y) * plan_.width + x);
            const PixelValue got{frame.radiance[at], frame.distance[at]};
            if (got != value_of(picture.number, x, y)) complain("a pixel is another one's");
        }
    }
    for (std::size_t i = 0; i < picture.traced.size(); ++i)
        if (picture.traced[i] + (picture.known[i] ? 1 : 0) != 1)
            complain("a pixel of the picture is not traced once");
}

}  // namespace lightwalk::simulation
