#include "tests/simulation/picture_run.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "parallel/ranks/assembly.h"

namespace lightwalk::simulation {
namespace {

/// A run without faults takes less, whatever its delays.
constexpr Time kLongest = seconds(4000);

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

RankSettings settings_of(const Plan& plan, const Planted& planted) {
    RankSettings settings;
    settings.slots = plan.slots;
    settings.ahead = plan.ahead;
    settings.block = plan.block;
    settings.stride = plan.stride;
    settings.ambient_batch = 0;
    if (planted.never_loses_patience) settings.pulse.silence = std::chrono::hours(24);
    return settings;
}

double in_seconds(Time time) {
    return std::chrono::duration<double>(time).count();
}

}  // namespace

const char* name_of(Fault::Kind kind) {
    constexpr const char* kNames[] = {"stop", "unplug", "kill", "cut", "fail", "interrupt"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::string description_of(const Plan& plan) {
    std::ostringstream text;
    text << plan.ranks << (plan.variant == Variant::ranks ? " ranks" : " hybrid ranks") << ", "
         << plan.masters << " masters, " << plan.slots << "+" << plan.ahead << " slots, blocks of "
         << plan.block << ", " << plan.pictures << " pictures, delays to "
         << in_seconds(plan.longest_delay) << " s, blocks to " << in_seconds(plan.longest_block)
         << " s" << (plan.broadcasts ? ", broadcast" : "");
    for (const Fault& fault : plan.faults) {
        text << "; " << name_of(fault.kind) << " rank " << fault.rank << " at ";
        if (fault.message > 0)
            text << "message " << fault.message;
        else
            text << in_seconds(fault.time) << " s";
        if (fault.passes()) text << " for " << in_seconds(fault.lasts) << " s";
    }
    return text.str();
}

PictureRun::PictureRun(Fibers& fibers, const Plan& plan, const Planted& planted, Disk& disk,
                       std::uint64_t seed)
    : plan_(plan),
      planted_(planted),
      disk_(disk),
      world_(fibers, plan.ranks, seed),
      network_(world_, plan.longest_delay),
      topology_(make_topology(plan.variant, plan.ranks, false, plan.masters)),
      threads_(std::make_shared<WorldThreads>(world_)),
      stop_(static_cast<std::size_t>(plan.ranks)),
      fails_(static_cast<std::size_t>(plan.ranks)),
      reports_(static_cast<std::size_t>(plan.ranks)) {}

Outcome PictureRun::play() {
    network_.set_mishap(planted_.mishap);
    plant_faults();
    for (int rank = 0; rank < plan_.ranks; ++rank)
        world_.start(rank, [this, rank] { play_rank(rank); });
    outcome_.ended = world_.run(kLongest);
    outcome_.end = world_.now();
    outcome_.messages = network_.sent();
    check_end();
    return outcome_;
}

void PictureRun::plant_faults() {
    for (const Fault& fault : plan_.faults) {
        const auto act = [this, &fault] { befall(fault); };
        if (fault.message > 0)
            network_.after_messages(fault.message, [this, act] { world_.at(world_.now(), act); });
        else
            world_.at(fault.time, act);
    }
}

void PictureRun::befall(const Fault& fault) {
    if (!world_.lives(fault.rank)) return;
    const auto rank = static_cast<std::size_t>(fault.rank);
    const Time until = world_.now() + fault.lasts;
    outcome_.last_fault = std::max(outcome_.last_fault, fault.passes() ? until : world_.now());
    may_end_ = may_end_ || !fault.passes();
    if (fault.passes()) silent_ += fault.lasts;
    switch (fault.kind) {
        case Fault::Kind::stop:
            return world_.stop(fault.rank, until);
        case Fault::Kind::unplug:
            return network_.unplug(fault.rank, until);
        case Fault::Kind::kill:
            return network_.end_all(fault.rank);
        case Fault::Kind::cut:
            return network_.cut(fault.rank);
        case Fault::Kind::fail:
            fails_[rank] = true;
            return;
        case Fault::Kind::interrupt:
            return stop_[rank].request();
    }
}

void PictureRun::play_rank(int rank) {
    try {
        const std::unique_ptr<Communicator> wire = network_.end(rank);
        RankSettings settings = settings_of(plan_, planted_);
        settings.threads = threads_;
        RankLink link(*wire, topology_, settings, "simulation",
                      [this](const std::string& text) { outcome_.failures.push_back(text); });
        link.run([&] { program(link); }, stop_[static_cast<std::size_t>(rank)]);
        network_.left(rank);
        ++left_;
    } catch (const Killed&) {
    } catch (const Aborted&) {
        complain("a rank has returned from a run that was ended");
    } catch (const std::exception& error) {
        complain(std::string("an exception left a rank: ") + error.what());
    }
}

// As RankBackend::run.
void PictureRun::program(RankLink& link) {
    link.agree({"the same"}, "");
    if (plan_.broadcasts && link.broadcast(link.leads() ? "known" : "") != "known")
        complain("a broadcast brings something else");
    if (link.leads()) {
        const auto tracing = [&] {
            try {
                link.guard([&] { trace(link); });
            } catch (const Aborted&) {
            }
        };
        threads_->side_by_side(tracing, [&] { link.guard([&] { lead(link); }); });
    } else {
        trace(link);
        link.post(0, Notice{Report{std::to_string(link.rank())}});
    }
    link.end_work();
}

void PictureRun::lead(RankLink& link) {
    for (int number = 0; number < plan_.pictures; ++number) {
        Picture& picture = pictures_[link.new_number()];
        picture.number = number;
        start_picture(link, picture);
    }
    const auto all_done = [this] {
        return std::all_of(pictures_.begin(), pictures_.end(),
                           [](const auto& one) { return one.second.done; });
    };
    const auto take_some = [&] {
        for (ProgramNews& news : link.take_news(true, stop_[0])) take(std::move(news));
    };
    while (!all_done() && !stop_[0].requested()) take_some();
    link.dismiss();
    const auto told = [this] { return std::count(reports_.begin() + 1, reports_.end(), 0) == 0; };
    while (!told() && !stop_[0].requested()) take_some();
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
    } else if (const auto* told = std::get_if<RankNotice>(&news)) {
        const auto* report = std::get_if<Report>(&told->notice.notice);
        if (report == nullptr || report->payload != std::to_string(told->from) ||
            ++reports_[static_cast<std::size_t>(told->from)] > 1)
            complain("a report that is not the rank's");
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
    if (!link.traces()) return link.inbox().wait_for_end(stop_[0]);
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
    while (const auto item = link.inbox().next(stop_[static_cast<std::size_t>(link.rank())])) {
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
    const Time time = world_.chance().up_to(plan_.longest_block);
    world_.sleep(time);
    if (fails_[static_cast<std::size_t>(link.rank())]) {
        outcome_.last_fault = std::max(outcome_.last_fault, world_.now());
        throw std::runtime_error("cannot trace");
    }
    Picture& picture = pictures_.at(work.job);
    for_pixels(work.block, plan_.width, [&](std::size_t i) {
        if (++picture.traced[i] > 1) complain("a pixel is traced twice");
        if (picture.known[i]) complain("a pixel is traced that was known");
    });
    link.finish_work({FinishedWork::Payload::block, work.job,
                      static_cast<std::uint32_t>(work.block.pixels()), in_seconds(time)},
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

/// Whether the run has ended, or gone on, as promised.
void PictureRun::check_end() {
    // A silence that is borne, and the time between two signs of life, each to be delivered.
    constexpr Time kBorne = seconds(12), kNoticed = seconds(60);
    const bool all_left = left_ == plan_.ranks;
    outcome_.finished = all_left && static_cast<int>(pictures_.size()) == plan_.pictures &&
                        std::all_of(pictures_.begin(), pictures_.end(),
                                    [](const auto& one) { return one.second.done; });
    if (!network_.late().empty()) complain(network_.late() + " after a rank's end");
    if (!outcome_.ended) complain("it does not end");
    const bool may_end = may_end_ || silent_ > kBorne;
    if (!may_end && !outcome_.finished)
        complain("it has not drawn the picture: " +
                 (outcome_.failures.empty() ? std::string("says nothing") : outcome_.failures[0]));
    const bool lost = !outcome_.finished && may_end;
    if (lost && outcome_.end > outcome_.last_fault + kNoticed)
        complain("a loss is noticed too late");
    if (outcome_.finished && !outcome_.failures.empty())
        complain("it is finished and tells of a failure");
}

}  // namespace lightwalk::simulation
