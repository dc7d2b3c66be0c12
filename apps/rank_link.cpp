#include "apps/rank_link.h"

#include <chrono>
#include <cstdio>
#include <exception>
#include <thread>
#include <utility>

#include "apps/commands.h"
#include "apps/interrupt.h"
#include "parallel/comm/core_fields.h"

namespace lightwalk {
namespace {

/// A signal's handler cannot notify: those who wait look for its request now and then.
constexpr std::chrono::milliseconds kPatience{20};

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + '\n';
    return text;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
        lines.push_back(text.substr(begin, end - begin));
    return lines;
}

}  // namespace

RankLink::RankLink(Communicator& communicator, Topology topology, const RankSettings& settings,
                   std::string program, bool timeline)
    : communicator_(communicator),
      topology_(std::move(topology)),
      program_(std::move(program)),
      host_(communicator.host()),
      timeline_(settings.slots + 1, timeline),
      batch_(topology_.ambient_master ? settings.ambient_batch : 0),
      loop_(communicator, topology_, settings, *this, &timeline_),
      workers_(loop_, topology_, communicator.rank()),
      encode_(settings.encode) {}

std::string RankLink::named(int rank, const std::string& host) const {
    return program_ + ": rank " + std::to_string(rank) + " (" + host + "): ";
}

int RankLink::run(FunctionRef<int()> body, const StopFlag& stop) {
    int status = kFailureStatus;
    std::thread thread([&] {
        try {
            status = body();
            loop_.end();
        } catch (const AgreedProblem& problem) {
            status = problem.status;
            loop_.end();
        } catch (const Aborted&) {
            status = kFailureStatus;
        } catch (const std::exception& error) {
            fail(error.what());
        }
    });
    bool whole = false;
    try {
        whole = loop_.run(stop);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s%s\n", named(rank(), host_).c_str(),
                     printable(error.what()).c_str());
        communicator_.abort(kFailureStatus);
    }
    if (!whole) {  // the thread may be deep in one pixel; nothing has been written
        std::fflush(nullptr);
        thread.detach();
        communicator_.abort(kInterruptedStatus);
    }
    thread.join();
    return status;
}

/// The run is over. Rank 0 ends it; the others tell it, and wait for that.
void RankLink::fail(const std::string& text) {
    loop_.post(0, Notice{Failure{host_, text}});
    std::this_thread::sleep_for(std::chrono::seconds(1));
    std::fprintf(stderr, "%s%s\n", named(rank(), host_).c_str(), printable(text).c_str());
    std::_Exit(kFailureStatus);
}

void RankLink::agree(const std::vector<std::string>& facts, const std::string& problem, int status,
                     const std::string& advice) {
    // Line 0: exit status; 1: host; then the facts; a problem's text comes after a line of its own.
    std::vector<std::string> own{std::to_string(status), host_};
    own.insert(own.end(), facts.begin(), facts.end());
    const std::string separator = "--\n";
    const std::vector<std::string> all =
        loop_.all_gather(Collective::Group::all, joined(own) + separator + printable(problem));
    std::vector<std::string> first;
    std::map<std::string, int> problems;  // text -> rank that has it
    int worst = kSuccessStatus, others = 0;
    std::string told;
    for (int rank = 0; rank < ranks(); ++rank) {
        const std::string& part = all[static_cast<std::size_t>(rank)];
        const std::size_t cut = part.find(separator);
        const std::vector<std::string> lines = lines_of(part.substr(0, cut));
        const std::string text = part.substr(cut + separator.size());
        if (first.empty()) first = lines;
        if (!text.empty()) {
            worst = std::max(worst, std::stoi(lines[0]));
            if (problems.emplace(text, rank).second) told += named(rank, lines[1]) + text + '\n';
            continue;
        }
        // The first difference: others may follow from it.
        for (std::size_t i = 2; i < std::min(lines.size(), first.size()); ++i) {
            if (lines[i] == first[i]) continue;
            ++others;
            told += named(rank, lines[1]) + lines[i] + ", but rank 0 (" + first[1] + ") has " +
                    first[i] + '\n';
            break;
        }
    }
    agreed_ = Timeline::Clock::now();  // all ranks have just heard the same
    if (problems.empty() && others == 0) {
        // Rank 0 may have brought values of a file.
        if (batch_ > 0) offer({{}, scene_});
        return;
    }
    if (leads()) {
        const bool same = problems.size() == 1 && others == 0 && problems.begin()->second == 0;
        if (!advice.empty() && problem.empty() && !problems.empty()) told += advice + '\n';
        if (same) told = problems.begin()->first + '\n';
        std::fprintf(stderr, "%s", told.c_str());
    }
    forget_cache();
    throw AgreedProblem{worst == kSuccessStatus ? kFailureStatus : worst, told};
}

void RankLink::offer(AmbientValues values) {
    loop_.post(Activity::exchange,
               [carried = std::move(values)](RankRoles& roles, Outbox& out) mutable {
                   roles.ambient_client()->offer(std::move(carried), out);
               });
}

void RankLink::exchange(PublishedCache& cache, const std::vector<AmbientRecord>& known) {
    if (batch_ == 0) return;
    const auto send = [this, scene = scene_](std::vector<AmbientRecord> records) {
        offer({std::move(records), scene});
    };
    if (!known.empty()) send(known);
    const std::lock_guard lock(mutex_);
    cache_ = &cache;
    sender_ = std::make_unique<AmbientSender>(batch_, send);
    cache.add(*sender_);
    for (const AmbientRecord& record : early_values_) cache.take_over(record, *sender_);
    early_values_.clear();
}

void RankLink::spread(const std::vector<AmbientRecord>& known, AmbientCache& cache) {
    const std::vector<std::string> all =
        loop_.all_gather(Collective::Group::all, leads() ? wire::encode(known) : std::string());
    if (leads()) return;
    for (const AmbientRecord& record : wire::decode<std::vector<AmbientRecord>>(all.front()))
        cache.insert(record);
}

TraceFunctions RankLink::trace_functions() {
    return {{}, {}, [this](const FinishedWork& finished, TracedWork traced) {
                loop_.post(Activity::send, [finished, carried = std::move(traced)](
                                               RankRoles& roles, Outbox& out) mutable {
                    roles.worker().finish(finished, std::move(carried), out);
                });
            }};
}

void RankLink::trace(Executor& executor, MakeRenderer make, const StopFlag& stop) {
    TraceFunctions functions = trace_functions();
    functions.make_renderer = std::move(make);
    trace_work(inbox_, functions, executor, stop, &timeline_);
}

void RankLink::trace_rays(Executor& executor, AnswerChunk answer, const StopFlag& stop) {
    TraceFunctions functions = trace_functions();
    functions.answer_chunk = std::move(answer);
    trace_work(inbox_, functions, executor, stop, &timeline_);
}

void RankLink::draw_walk(Executor& executor, const CloudOptions& cloud, int projectors,
                         const MakeWalkRays& make, const StopFlag& stop) {
    WalkPartOptions options;
    options.index = topology_.worker_index(rank()).value_or(0);
    for (const Topology::Worker& worker : topology_.workers) options.workers.push_back(worker.rank);
    options.owners = owners_of(options.workers.size(), projectors);
    options.cloud = cloud;
    options.encode = encode_;
    draw_frames(loop_, inbox_, options, make, executor, stop, &timeline_);
}

void RankLink::wait_for_end(const StopFlag& stop) {
    inbox_.wait_for_end(stop);
}

void RankLink::report(std::string text) {
    loop_.post(0, Notice{Report{std::move(text)}});
}

template <class Found>
auto RankLink::wait_until(const StopFlag& stop, Found found) -> decltype(found()) {
    std::unique_lock lock(mutex_);
    while (!stop.requested()) {
        if (auto result = found()) return result;
        changed_.wait_for(lock, kPatience);
    }
    return std::nullopt;
}

void RankLink::submit(PictureJob job, const std::shared_ptr<CheckpointSink>& checkpoint) {
    std::vector<BlockPixels> known;
    if (checkpoint) {
        known = checkpoint->known();
        job.log = true;
        for (const BlockPixels& pixels : known) job.known.push_back(pixels.block);
        const std::lock_guard lock(mutex_);
        checkpoints_[job.job] = checkpoint;
    }
    const JobId id = job.job;
    const SubImages parts(job.area, topology_.workers.size());
    loop_.post(Activity::serve, [carried = std::move(job)](RankRoles& roles, Outbox& out) {
        roles.queue().start(carried, out);
    });
    for (BlockPixels& block : known) {
        const Pixels pixels{{id, block.block}, std::move(block.values)};
        for (const std::size_t i : parts.overlapping(block.block))
            loop_.post(topology_.workers[i].rank, WorkResult{cut_pixels(pixels, parts[i])});
    }
}

std::optional<FinishedPicture> RankLink::wait_for(JobId job, const StopFlag& stop,
                                                  FunctionRef<void(double)> progress) {
    double told = -1;
    return wait_until(stop, [&]() -> std::optional<FinishedPicture> {
        if (const auto share = shares_.find(job); share != shares_.end() && share->second > told) {
            told = share->second;
            progress(told);
        }
        const auto found = pictures_.find(job);
        if (found == pictures_.end()) return std::nullopt;
        FinishedPicture picture = std::move(found->second);
        pictures_.erase(found);
        shares_.erase(job);
        checkpoints_.erase(job);
        return picture;
    });
}

void RankLink::submit(RayChunk chunk) {
    loop_.post(Activity::serve,
               [carried = std::move(chunk)](RankRoles& roles, Outbox& out) mutable {
                   roles.queue().add(std::move(carried), out);
               });
}

RankLink::RayNews RankLink::ray_news(bool wait, const StopFlag& stop) {
    const auto some = [&]() -> std::optional<RayNews> {
        if (wait && ray_news_.chunks == 0 && ray_news_.answers.empty()) return std::nullopt;
        return std::exchange(ray_news_, {});
    };
    return wait_until(stop, some).value_or(RayNews{});
}

void RankLink::submit(FrameOrder& order) {
    order.number = ++last_order_;
    loop_.post(Activity::serve,
               [order](RankRoles& roles, Outbox& out) { roles.queue().start(order, out); });
}

std::optional<FinishedFrame> RankLink::wait_for_frame(const StopFlag& stop) {
    return wait_until(stop, [&] { return std::exchange(frame_, std::nullopt); });
}

void RankLink::dismiss() {
    for (int rank = 0; rank < ranks(); ++rank) loop_.post(rank, Notice{Finish{}});
}

void RankLink::forget_cache() {
    const std::lock_guard lock(mutex_);
    cache_ = nullptr;
    sender_.reset();
    early_values_.clear();
}

std::string RankLink::next_command(std::string said) {
    inbox_.reopen();
    {
        const std::lock_guard lock(mutex_);
        frame_.reset();
        early_values_.clear();
        ++scene_;
    }
    return loop_.all_gather(Collective::Group::all, std::move(said)).front();
}

std::map<int, std::string> RankLink::finish(const StopFlag& stop) {
    dismiss();
    (void)wait_until(stop, [&] {
        const bool all = static_cast<int>(reports_.size()) >= ranks() - 1;
        return all ? std::optional(true) : std::nullopt;
    });
    const std::lock_guard lock(mutex_);
    return std::move(reports_);
}

void RankLink::take(AmbientValues news) {
    const std::lock_guard lock(mutex_);
    if (news.scene != scene_) return;
    if (cache_ == nullptr)
        early_values_.insert(early_values_.end(), news.records.begin(), news.records.end());
    else
        for (const AmbientRecord& record : news.records) cache_->take_over(record, *sender_);
}

AmbientValues RankLink::unsent_values() {
    const std::lock_guard lock(mutex_);
    return {sender_ ? sender_->unsent() : std::vector<AmbientRecord>{}, scene_};
}

void RankLink::take(ProgramNews news) {
    {
        const std::lock_guard lock(mutex_);
        std::visit(
            Overloaded{
                [&](FinishedPicture& picture) { pictures_[picture.job] = std::move(picture); },
                [&](const Progress& progress) { shares_[progress.job] = progress.done; },
                [&](LoggedPixels& logged) {
                    const JobBlock& work = logged.pixels.work;
                    const auto checkpoint = checkpoints_.find(work.job);
                    if (checkpoint != checkpoints_.end())
                        checkpoint->second->keep({work.block, std::move(logged.pixels.values), {}});
                },
                [&](const ChunksWanted& wanted) {
                    ray_news_.chunks += wanted.chunks;
                    ray_news_.rays = wanted.rays;
                },
                [&](RayAnswer& answer) { ray_news_.answers.push_back(std::move(answer)); },
                [&](FinishedFrame& frame) { frame_ = std::move(frame); },
                [&](const RankNotice& notice) { take(notice); }},
            news);
    }
    changed_.notify_all();
}

void RankLink::take(const RankNotice& notice) {
    std::visit(Overloaded{[&](const Failure& failure) {
                              std::fprintf(stderr, "%s%s\n",
                                           named(notice.from, failure.host).c_str(),
                                           printable(failure.text).c_str());
                              communicator_.abort(kFailureStatus);
                          },
                          [&](const Finish&) { inbox_.close(); },
                          [&](const Report& report) { reports_[notice.from] = report.payload; }},
               notice.notice.notice);
}

}  // namespace lightwalk
