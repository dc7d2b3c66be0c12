#include "apps/rank_link.h"

#include <chrono>
#include <cstdio>
#include <exception>
#include <thread>
#include <utility>

#include "apps/commands.h"
#include "apps/interrupt.h"
#include "parallel/ranks/piece_codec.h"

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

RankLink::RankLink(Transport& transport, Topology topology, const RankSettings& settings,
                   std::string program, bool timeline)
    : transport_(transport),
      topology_(std::move(topology)),
      program_(std::move(program)),
      host_(transport.host()),
      timeline_(settings.slots + 1, timeline),
      batch_(topology_.ambient_master ? settings.ambient_batch : 0),
      loop_(transport, topology_, settings, *this, &timeline_) {}

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
        transport_.abort(kFailureStatus);
    }
    if (!whole) {  // the thread may be deep in one pixel; nothing has been written
        std::fflush(nullptr);
        thread.detach();
        transport_.abort(kInterruptedStatus);
    }
    thread.join();
    return status;
}

/// The run is over. Rank 0 ends it; the others tell it, and wait for that.
void RankLink::fail(const std::string& text) {
    loop_.post(Role::program, {0, Role::program}, Failure{host_, text});
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
        loop_.all_gather(joined(own) + separator + printable(problem));
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
        if (batch_ > 0)
            loop_.post(Role::cache, {rank(), Role::ambient_client}, AmbientValues{{}, scene_});
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

void RankLink::exchange(PublishedCache& cache, const std::vector<AmbientRecord>& known) {
    if (batch_ == 0) return;
    const auto send = [this, scene = scene_](AmbientValues values) {
        values.scene = scene;
        loop_.post(Role::cache, {rank(), Role::ambient_client}, std::move(values));
    };
    if (!known.empty()) send({known, scene_});
    const std::lock_guard lock(mutex_);
    cache_ = &cache;
    sender_ = std::make_unique<AmbientSender>(batch_, send);
    cache.add(*sender_);
    for (const AmbientRecord& record : early_values_) cache.take_over(record, *sender_);
    early_values_.clear();
}

void RankLink::spread(const std::vector<AmbientRecord>& known, AmbientCache& cache) {
    std::string mine;
    if (leads())
        mine = encode_message({{0, Role::program}, {0, Role::program}, AmbientValues{known, 0}});
    const std::vector<std::string> all = loop_.all_gather(std::move(mine));
    if (leads()) return;
    const Envelope envelope = decode_message(all.front(), 0, rank());
    const auto* values = std::get_if<AmbientValues>(&envelope.message);
    if (values == nullptr) throw InputError("rank 0's ambient values cannot be read");
    for (const AmbientRecord& record : values->records) cache.insert(record);
}

void RankLink::trace(Executor& executor, MakeRenderer make, const StopFlag& stop) {
    const auto tell = [this](Message message) {
        loop_.post(Role::tracer, {rank(), Role::worker}, std::move(message));
    };
    const auto tracer = std::make_shared<RankTracer>(std::move(make), tell, &timeline_);
    open_tracer([tracer](Message message) { tracer->take(std::move(message)); });
    tracer->run(executor, stop);
}

void RankLink::trace_rays(Executor& executor, AnswerChunk answer, const StopFlag& stop) {
    const auto tell = [this](Message message) {
        loop_.post(Role::tracer, {rank(), Role::worker}, std::move(message));
    };
    const auto tracer = std::make_shared<ChunkTracer>(std::move(answer), tell, &timeline_);
    open_tracer([tracer](Message message) { tracer->take(std::move(message)); });
    tracer->run(executor, stop);
}

void RankLink::draw_walk(Executor& executor, const CloudOptions& cloud, int projectors,
                         MakeWalkRays make, const StopFlag& stop) {
    CloudTracerOptions options;
    options.index = topology_.worker_index(rank()).value_or(0);
    for (const Topology::Worker& worker : topology_.workers) options.workers.push_back(worker.rank);
    options.owners = owners_of(options.workers.size(), projectors);
    options.cloud = cloud;
    options.encode = encode_piece;
    const auto post = [this](Address to, Message message) {
        loop_.post(Role::tracer, to, std::move(message));
    };
    const auto tracer =
        std::make_shared<CloudTracer>(std::move(options), std::move(make), post, &timeline_);
    open_tracer([tracer](Message message) { tracer->take(std::move(message)); });
    tracer->run(executor, stop);
}

void RankLink::open_tracer(std::function<void(Message)> take) {
    const std::lock_guard lock(mutex_);
    tracer_ = std::move(take);
    for (Message& message : untaken_) tracer_(std::move(message));
    untaken_.clear();
}

void RankLink::wait_for_end(const StopFlag& stop) {
    std::unique_lock lock(mutex_);
    while (!finished_ && !stop.requested()) changed_.wait_for(lock, kPatience);
}

void RankLink::report(std::string text) {
    loop_.post(Role::program, {0, Role::program}, Report{std::move(text)});
}

void RankLink::submit(JobStart job, const std::shared_ptr<CheckpointSink>& checkpoint) {
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
    loop_.post(Role::program, {0, Role::master}, std::move(job));
    for (BlockPixels& block : known) {
        const Pixels pixels{{id, block.block}, std::move(block.values)};
        for (const std::size_t i : parts.overlapping(block.block)) {
            loop_.post(Role::program, {topology_.workers[i].rank, Role::worker},
                       cut_pixels(pixels, parts[i]));
        }
    }
}

std::optional<FinishedPicture> RankLink::wait_for(JobId job, const StopFlag& stop,
                                                  FunctionRef<void(double)> progress) {
    std::unique_lock lock(mutex_);
    double told = -1;
    while (!stop.requested()) {
        if (const auto found = pictures_.find(job); found != pictures_.end()) {
            FinishedPicture picture = std::move(found->second);
            pictures_.erase(found);
            shares_.erase(job);
            checkpoints_.erase(job);
            return picture;
        }
        if (const auto share = shares_.find(job); share != shares_.end() && share->second > told) {
            told = share->second;
            progress(told);
        }
        changed_.wait_for(lock, kPatience);
    }
    return std::nullopt;
}

void RankLink::submit(RayChunk chunk) {
    loop_.post(Role::program, {0, Role::master}, std::move(chunk));
}

RankLink::RayNews RankLink::ray_news(bool wait, const StopFlag& stop) {
    std::unique_lock lock(mutex_);
    while (wait && ray_news_.chunks == 0 && ray_news_.answers.empty() && !stop.requested())
        changed_.wait_for(lock, kPatience);
    return std::exchange(ray_news_, {});
}

void RankLink::submit(CloudOrder order) {
    loop_.post(Role::program, {0, Role::master}, std::move(order));
}

std::optional<FinishedFrame> RankLink::wait_for_frame(const StopFlag& stop) {
    std::unique_lock lock(mutex_);
    while (!frame_ && !stop.requested()) changed_.wait_for(lock, kPatience);
    if (stop.requested()) return std::nullopt;
    return std::exchange(frame_, std::nullopt);
}

void RankLink::dismiss() {
    for (int rank = 0; rank < ranks(); ++rank)
        loop_.post(Role::program, {rank, Role::program}, Finish{});
}

void RankLink::forget_cache() {
    const std::lock_guard lock(mutex_);
    cache_ = nullptr;
    sender_.reset();
    early_values_.clear();
}

std::string RankLink::hear(std::string said) {
    {
        const std::lock_guard lock(mutex_);
        finished_ = false;
        tracer_ = nullptr;
        frame_.reset();
        early_values_.clear();
        ++scene_;
    }
    return loop_.all_gather(std::move(said)).front();
}

std::map<int, std::string> RankLink::finish(const StopFlag& stop) {
    dismiss();
    std::unique_lock lock(mutex_);
    while (static_cast<int>(reports_.size()) < ranks() - 1 && !stop.requested())
        changed_.wait_for(lock, kPatience);
    return std::move(reports_);
}

/// Called by the thread that serves the messages.
void RankLink::take(Envelope envelope) {
    Message& message = envelope.message;
    if (const auto* failure = std::get_if<Failure>(&message)) {
        std::fprintf(stderr, "%s%s\n", named(envelope.from.rank, failure->host).c_str(),
                     printable(failure->text).c_str());
        transport_.abort(kFailureStatus);
    }
    const std::lock_guard lock(mutex_);
    if (auto* values = std::get_if<AmbientValues>(&message)) {
        if (values->scene != scene_) return;
        if (!cache_)
            early_values_.insert(early_values_.end(), values->records.begin(),
                                 values->records.end());
        else
            for (const AmbientRecord& record : values->records) cache_->take_over(record, *sender_);
    } else if (auto* picture = std::get_if<FinishedPicture>(&message)) {
        pictures_[picture->job] = std::move(*picture);
    } else if (const auto* progress = std::get_if<Progress>(&message)) {
        shares_[progress->job] = progress->done;
    } else if (auto* pixels = std::get_if<Pixels>(&message)) {
        if (const auto checkpoint = checkpoints_.find(pixels->work.job);
            checkpoint != checkpoints_.end())
            checkpoint->second->keep({pixels->work.block, std::move(pixels->values), {}});
    } else if (const auto* ask = std::get_if<AskChunks>(&message)) {
        ray_news_.chunks += ask->chunks;
        ray_news_.rays = ask->rays;
    } else if (auto* answer = std::get_if<ChunkAnswer>(&message)) {
        ray_news_.answers.push_back(std::move(*answer));
    } else if (auto* frame = std::get_if<FinishedFrame>(&message)) {
        frame_ = std::move(*frame);
    } else if (auto* report = std::get_if<Report>(&message)) {
        reports_[envelope.from.rank] = std::move(report->payload);
    } else {
        if (std::holds_alternative<Finish>(message)) finished_ = true;
        if (tracer_)
            tracer_(std::move(message));
        else
            untaken_.push_back(std::move(message));
    }
    changed_.notify_all();
}

}  // namespace lightwalk
