#include "parallel/work_queue/worker.h"

#include <algorithm>
#include <utility>

namespace lightwalk {
namespace {

/// Calls `row(from, to, width)` with indices into the row-by-row pixels of `a` and `b` for each row
/// of `part`, which lies in both.
template <class Row>
void for_rows(const PixelRectangle& part, const PixelRectangle& a, const PixelRectangle& b,
              Row row) {
    const auto index = [&](const PixelRectangle& of, int y) {
        return static_cast<std::ptrdiff_t>(of.index({part.x0, y}));
    };
    for (int y = part.y0; y < part.y1; ++y) row(index(a, y), index(b, y), part.width());
}

/// Of each pixel there are as many values as light groups.
void copy_groups(const std::vector<Rgb>& from, std::ptrdiff_t first, std::vector<Rgb>& to,
                 std::ptrdiff_t at, int width, std::size_t groups) {
    const auto each = static_cast<std::ptrdiff_t>(groups);
    std::copy_n(from.begin() + first * each, width * each, to.begin() + at * each);
}

}  // namespace

Pixels cut_pixels(const Pixels& pixels, const PixelRectangle& part) {
    Pixels cut{{pixels.work.job, intersection(pixels.work.block, part)}, {}};
    if (pixels.values.empty() || cut.work.block.empty()) return cut;
    cut.values.resize(cut.work.block.pixels());
    const std::size_t groups = pixels.groups.size() / pixels.values.size();
    cut.groups.resize(cut.values.size() * groups);
    for_rows(cut.work.block, pixels.work.block, cut.work.block,
             [&](std::ptrdiff_t from, std::ptrdiff_t to, int width) {
                 std::copy_n(pixels.values.begin() + from, width, cut.values.begin() + to);
                 copy_groups(pixels.groups, from, cut.groups, to, width, groups);
             });
    return cut;
}

void Worker::begin(Outbox& out) {
    send(options_.queue,
         WorkRequest{static_cast<std::uint32_t>(options_.slots + options_.ahead), {}}, out);
}

void Worker::handle(Announcement announcement, Outbox& out) {
    std::visit(Overloaded{[&](PictureJob& job) { start(std::move(job), out); },
                          [&](auto& order) { out.tracers.emplace_back(std::move(order)); }},
               announcement.job);
}

void Worker::finish(const FinishedWork& finished, TracedWork traced, Outbox& out) {
    send(options_.queue, WorkRequest{1, {finished}}, out);
    std::visit(Overloaded{[&](Pixels& pixels) { share_out(std::move(pixels), out); },
                          [&](RayAnswer& answer) { send(0, WorkResult{std::move(answer)}, out); },
                          [&](TracedRun& run) {
                              const int owner = options_.workers->at(run.owner);
                              send(owner, WorkResult{std::move(run)}, out);
                          }},
               traced);
}

void Worker::start(PictureJob message, Outbox& out) {
    const JobId id = message.job;
    std::erase_if(jobs_, [&](const auto& entry) { return entry.first + kJobsAtOnce <= id; });
    Job& job = jobs_[id];
    job.started = true;
    job.keep = message.keep;
    job.log = message.log;
    job.parts = SubImages(message.area, options_.workers->size());
    job.missing = message.keep ? own_part(job).pixels() : 0;
    job.there.resize(job.missing);
    out.tracers.emplace_back(std::move(message));
    for (Pixels& pixels : std::exchange(job.early, {})) store(std::move(pixels), out);
}

void Worker::share_out(Pixels pixels, Outbox& out) {
    const auto found = jobs_.find(pixels.work.job);
    if (found == jobs_.end() || !found->second.keep) return;
    if (found->second.log) send(0, WorkResult{LoggedPixels{pixels}}, out);
    // The own pixels last: with them the job may be over.
    const SubImages parts = found->second.parts;
    for (const std::size_t i : parts.overlapping(pixels.work.block)) {
        if (i != options_.index)
            send((*options_.workers)[i], WorkResult{cut_pixels(pixels, parts[i])}, out);
    }
    const PixelRectangle own = intersection(pixels.work.block, parts[options_.index]);
    if (own.empty()) return;
    const bool whole = own.pixels() == pixels.work.block.pixels();
    store(whole ? std::move(pixels) : cut_pixels(pixels, parts[options_.index]), out);
}

void Worker::store(Pixels pixels, Outbox& out) {
    Job& job = jobs_[pixels.work.job];
    if (!job.started) {
        job.early.push_back(std::move(pixels));
        return;
    }
    const PixelRectangle part = own_part(job);
    const PixelRectangle& block = pixels.work.block;
    if (job.missing == 0) return;  // known from an earlier run, and traced again
    if (!pixels.values.empty()) job.values.resize(part.pixels());
    const std::size_t groups = pixels.groups.size() / std::max<std::size_t>(block.pixels(), 1);
    if (groups > 0) job.groups.resize(part.pixels() * groups);
    for_rows(block, block, part, [&](std::ptrdiff_t from, std::ptrdiff_t to, int width) {
        if (!pixels.values.empty())
            std::copy_n(pixels.values.begin() + from, width, job.values.begin() + to);
        copy_groups(pixels.groups, from, job.groups, to, width, groups);
        for (int x = 0; x < width; ++x) {
            auto there = job.there[static_cast<std::size_t>(to + x)];
            job.missing -= there ? 0 : 1;
            there = true;
        }
    });
    if (job.missing > 0) return;
    send(0, FinishedPart{finished_part(pixels.work.job, job)}, out);
}

PicturePart Worker::finished_part(JobId id, Job& job) const {
    const PixelRectangle area = own_part(job);
    PicturePart part{{id, area}, options_.encode(area, std::exchange(job.values, {}))};
    const std::vector<Rgb> groups = std::exchange(job.groups, {});
    const std::size_t count = groups.size() / area.pixels();
    for (std::size_t g = 0; g < count; ++g) {
        std::vector<PixelValue> layer(area.pixels());
        for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = {groups[i * count + g], 0};
        part.layers.push_back(options_.encode(area, std::move(layer)));
    }
    return part;
}

}  // namespace lightwalk
