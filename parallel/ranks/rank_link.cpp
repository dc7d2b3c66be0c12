#include "parallel/ranks/rank_link.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <map>
#include <utility>

namespace lightwalk {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::microseconds;

/// What a rank says of itself before the work begins.
struct Declaration {
    std::string host, problem;
    std::vector<std::string> facts;
};
template <class Wire>
void visit_fields(Wire& wire, Declaration& own) {
    wire(own.host, own.problem, own.facts);
}

RankSettings with_timed_encoding(RankSettings settings, Timeline& timeline) {
    settings.encode = [encode = settings.encode, &timeline](const PixelRectangle& block,
                                                            std::vector<PixelValue> values) {
        const TimedActivity timed(timeline, timeline.message_row(), Activity::compress);
        return encode(block, std::move(values));
    };
    return settings;
}

}  // namespace

Patience patience_of(const Topology& topology) {
    if (topology.ranks == 1) return {microseconds{20000}, microseconds{20000}};
    return {topology.traces(0) ? microseconds{200} : microseconds{50}, microseconds{2000}};
}

RankLink::RankLink(Communicator& communicator, const Topology& topology,
                   const RankSettings& settings, std::string program, TakeFailure failed,
                   bool keep_spans)
    : communicator_(communicator),
      threads_(settings.threads),
      topology_(topology),
      program_(std::move(program)),
      host_(communicator.host()),
      failed_(std::move(failed)),
      timeline_(settings.slots + 1, keep_spans),
      patience_(patience_of(topology)),
      roles_(communicator.rank(), topology, with_timed_encoding(settings, timeline_)),
      pulse_(communicator.rank(), communicator.size(), settings.pulse),
      hosts_(static_cast<std::size_t>(communicator.size())),
      owners_(roles_.collectives().members(Collective::Group::owners)),
      inbox_(threads_),
      cache_(settings.ambient_batch, [this](AmbientValues values) {
          post(Activity::exchange, [carried = std::move(values)](RankRoles& roles, Outbox& out) {
              roles.ambient_client()->offer(carried, out);
          });
      }) {
    // A frame of a walk is a chain of short steps, each of which waits for messages of the last.
    constexpr microseconds kWalkPatience{400};
    if (settings.projectors > 0) patience_.longest = std::min(patience_.longest, kWalkPatience);
}

// The program's threads.

void RankLink::run(FunctionRef<void()> body, const StopFlag& stop) {
    std::exception_ptr problem;
    const auto program = [&] {
        try {
            guard([&] {
                try {
                    body();
                } catch (const AgreedProblem&) {
                    problem = std::current_exception();
                }
                // What was sent to a third rank before the first of two rounds has arrived when
                // the second one ends: nothing is on its way to anyone.
                meet();
                meet();
            });
        } catch (const Aborted&) {
            return;
        }
        const std::lock_guard lock(mutex_);
        ended_ = true;
        communicator_.wake();
    };
    const auto leave = [&] {
        {
            const std::lock_guard lock(mutex_);
            over_ = true;
        }
        threads_->notify(changed_);
        inbox_.close();
    };
    threads_->side_by_side(program, [&] {
        try {
            handle_messages(stop);
        } catch (...) {
            leave();
            throw;
        }
        leave();
    });
    if (problem) std::rethrow_exception(problem);
}

void RankLink::guard(FunctionRef<void()> task) {
    try {
        task();
    } catch (const std::exception& error) {
        fail(error.what());
    }
}

/// Rank 0 is told, and ends the run; where it does not, this rank does.
void RankLink::fail(const std::string& text) {
    constexpr std::chrono::seconds kPatience{1};
    post(0, Notice{Failure{host_, text}});
    std::unique_lock lock(mutex_);
    if (!failure_) failure_ = {text, threads_->now() + kPatience};
    threads_->wait_until(changed_, lock, [&] { return over_; });
    throw Aborted{kFailed};
}

void RankLink::post(int to, Message message) {
    const Activity activity = activity_of(message);
    post(activity,
         [from = rank(), to, carried = std::move(message)](RankRoles&, Outbox& out) mutable {
             out.messages.push_back({from, to, std::move(carried)});
         });
}

void RankLink::post(Activity activity, Step step) {
    {
        const std::lock_guard lock(mutex_);
        posted_.push_back({activity, std::move(step)});
    }
    communicator_.wake();
}

void RankLink::finish_work(const FinishedWork& finished, TracedWork traced) {
    post(Activity::send,
         [finished, carried = std::move(traced)](RankRoles& roles, Outbox& out) mutable {
             roles.worker().finish(finished, std::move(carried), out);
         });
}

void RankLink::start(Announcement announcement) {
    post(Activity::handle, [carried = std::move(announcement)](RankRoles& roles, Outbox& out) {
        std::visit([&](const auto& job) { roles.queue().start(job, out); }, carried.job);
    });
}

void RankLink::add(RayChunk chunk) {
    post(Activity::handle, [carried = std::move(chunk)](RankRoles& roles, Outbox& out) mutable {
        roles.queue().add(std::move(carried), out);
    });
}

Collective RankLink::perform(Collective share) {
    Operation& operation = operations_[static_cast<std::size_t>(share.group)];
    share.round = operation.round++;
    post(0, std::move(share));
    std::unique_lock lock(mutex_);
    threads_->wait_until(changed_, lock, [&] { return operation.result.has_value() || over_; });
    if (!operation.result) throw Aborted{kFailed};
    return *std::exchange(operation.result, std::nullopt);
}

std::vector<std::string> RankLink::all_gather(Collective::Group group, std::string bytes) {
    return perform({group, 0, false, {std::move(bytes)}, {}}).parts;
}

std::vector<std::uint64_t> RankLink::all_reduce(Collective::Group group,
                                                std::vector<std::uint64_t> numbers) {
    return perform({group, 0, false, {std::string()}, std::move(numbers)}).numbers;
}

std::string RankLink::broadcast(std::string bytes) {
    post(Activity::handle, [this, own = std::move(bytes)](RankRoles&, Outbox&) {
        std::string got = communicator_.broadcast(own, [this] {
            (void)handle_arrived();
            keep_pulse();
        });
        {
            const std::lock_guard lock(mutex_);
            broadcast_ = std::move(got);
        }
        threads_->notify(changed_);
    });
    std::unique_lock lock(mutex_);
    threads_->wait_until(changed_, lock, [&] { return broadcast_.has_value() || over_; });
    if (!broadcast_) throw Aborted{kFailed};
    return *std::exchange(broadcast_, std::nullopt);
}

int RankLink::Workers::index() const {
    return static_cast<int>(link_.topology_.worker_index(link_.rank()).value_or(0));
}

int RankLink::Workers::size() const {
    return static_cast<int>(link_.topology_.workers.size());
}

int RankLink::Rounds::index() const {
    return link_.traces() ? link_.workers_.index() : -1;
}

int RankLink::Rounds::parts() const {
    return size() + (link_.topology_.traces(0) ? 0 : 1);
}

std::vector<std::string> RankLink::Rounds::all_gather(std::string mine) {
    std::vector<std::string> parts = link_.all_gather(Collective::Group::rounds, std::move(mine));
    if (!link_.topology_.traces(0)) std::rotate(parts.begin(), parts.begin() + 1, parts.end());
    return parts;
}

void RankLink::agree(const std::vector<std::string>& facts, const std::string& problem,
                     const std::string& advice) {
    const std::vector<std::string> all = all_gather(
        Collective::Group::all, wire::encode(Declaration{host_, printable(problem), facts}));
    Declaration first;
    std::vector<std::string> hosts;
    std::map<std::string, int> problems;  // text -> rank that has it
    std::vector<std::string> lines;
    bool differ = false;
    for (int rank = 0; rank < ranks(); ++rank) {
        const auto one = wire::decode<Declaration>(all[static_cast<std::size_t>(rank)]);
        if (rank == 0) first = one;
        hosts.push_back(one.host);
        if (!one.problem.empty()) {
            if (problems.emplace(one.problem, rank).second)
                lines.push_back(named(rank, one.host) + one.problem);
            continue;
        }
        // The first difference: others may follow from it.
        const auto [own, rank_0s] = std::mismatch(one.facts.begin(), one.facts.end(),
                                                  first.facts.begin(), first.facts.end());
        if (own == one.facts.end() || rank_0s == first.facts.end()) continue;
        differ = true;
        lines.push_back(named(rank, one.host) + *own + ", but rank 0 (" + first.host + ") has " +
                        *rank_0s);
    }
    agreed_ = timeline_.since(Clock::now());
    if (lines.empty()) return watch_others(std::move(hosts));
    if (!leads()) throw AgreedProblem("");
    if (problems.size() == 1 && !differ && problems.begin()->second == 0)
        throw AgreedProblem(first.problem);
    if (!advice.empty() && problem.empty() && !problems.empty()) lines.push_back(advice);
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
    throw AgreedProblem(text);
}

void RankLink::watch_others(std::vector<std::string> hosts) {
    if (communicator_.on_one_machine()) return;
    post(Activity::handle, [this, all = std::move(hosts)](RankRoles&, Outbox&) { hosts_ = all; });
    round_trip_ = shortest_round_trip(everyone_);
}

void RankLink::end_work() {
    if (exchanges_values()) {
        flush_values();
        meet();                       // all have told what they had,
        if (leads()) flush_values();  // and rank 0 hears it
        cache_.close();
    }
    inbox_.reopen();
    meet();
    post(Activity::exchange, [](RankRoles& roles, Outbox&) {
        if (roles.ambient_master()) roles.ambient_master()->clear();
        if (roles.ambient_client()) roles.ambient_client()->clear();
    });
}

/// Until what this rank has made is told, and what the others had told by then is here.
void RankLink::flush_values() {
    std::unique_lock lock(mutex_);
    posted_.push_back({Activity::exchange, [this](auto& roles, auto& out) { tell(roles, out); }});
    flushing_ = true;
    communicator_.wake();
    threads_->wait_until(changed_, lock, [&] { return !flushing_ || over_; });
    if (flushing_) throw Aborted{kFailed};
}

std::deque<ProgramNews> RankLink::take_news(bool wait, const StopFlag& stop) {
    // A signal's handler cannot notify: its request is looked for now and then.
    constexpr std::chrono::milliseconds kPatience{20};
    std::unique_lock lock(mutex_);
    while (wait && news_.empty() && !stop.requested()) {
        if (over_) throw Aborted{kFailed};
        threads_->wait_for(changed_, lock, kPatience);
    }
    return std::exchange(news_, {});
}

/// The way that announcements take, so that it overtakes none: sub-queues tell their workers.
void RankLink::dismiss() {
    for (int to = 0; to < ranks(); ++to)
        if (!topology_.below_sub_queue(to)) post(to, Notice{Finish{}});
}

RankReport RankLink::report() const {
    RankReport report;
    report.host = host_;
    report.rows = timeline_.rows_since(agreed_);
    const std::lock_guard lock(mutex_);
    report.counts = counts_;
    return report;
}

// The thread that handles the messages.

void RankLink::handle_messages(const StopFlag& stop) {
    try {
        if (!communicator_.on_one_machine()) pulse_.start(threads_->now());
        take_step(Activity::handle, [](RankRoles& roles, Outbox& out) { roles.begin(out); });
        microseconds wait = patience_.shortest;
        while (goes_on()) {
            if (stop.requested()) {  // a thread may be deep in one pixel: it is not waited for
                std::fflush(nullptr);
                communicator_.abort(kStopped);
            }
            const bool posted = run_posted();
            const bool handled = handle_arrived() || posted;
            exchange_values_in_time();
            keep_pulse();
            note_flushed();
            if (handled) {
                wait = patience_.shortest;
                continue;
            }
            communicator_.wait(wait);
            wait = std::min(patience_.longest, 2 * wait);
        }
        communicator_.flush();
    } catch (const std::exception& error) {
        end_run(rank(), host_, error.what());
    }
}

/// Whether the run has neither ended nor, for all that this rank knows, failed.
bool RankLink::goes_on() {
    std::optional<OwnFailure> failure;
    {
        const std::lock_guard lock(mutex_);
        if (ended_) return false;
        if (failure_ && threads_->now() > failure_->patience) failure = failure_;
    }
    if (failure) end_run(rank(), host_, failure->text);
    return true;
}

bool RankLink::run_posted() {
    std::deque<Posted> posted;
    {
        const std::lock_guard lock(mutex_);
        posted.swap(posted_);
    }
    for (const Posted& one : posted) take_step(one.activity, one.step);
    return !posted.empty();
}

bool RankLink::handle_arrived() {
    bool any = false;
    while (std::optional<Communicator::Packet> packet = communicator_.receive()) {
        any = true;
        pulse_.heard(packet->from, threads_->now());
        Outbox out;
        out.messages.push_back({packet->from, rank(), decode_message(packet->bytes)});
        dispatch(std::move(out));
    }
    return any;
}

/// Values go out now and then also where they do not make a batch, and a rank that makes none is
/// told of others' all the same: rank 0 may keep a file of them.
void RankLink::exchange_values_in_time() {
    constexpr std::chrono::seconds kOften{1};
    const Clock::time_point now = threads_->now();
    if (now - exchanged_ < kOften || !cache_.is_open()) return;
    exchanged_ = now;
    take_step(Activity::exchange, [this](auto& roles, auto& out) { tell(roles, out); });
}

void RankLink::keep_pulse() {
    const Pulse::Beat beat = pulse_.beat(threads_->now());
    if (beat.lost) {
        const auto silence = std::chrono::duration_cast<std::chrono::seconds>(pulse_.silence());
        end_run(*beat.lost, hosts_[static_cast<std::size_t>(*beat.lost)],
                "nothing has been heard of it for " + std::to_string(silence.count()) +
                    " s: is its host still there? (Where mpirun does not end by itself, "
                    "interrupt it twice.)");
    }
    if (!beat.due) return;
    Outbox out;
    for (int to = leads() ? 1 : 0; to < (leads() ? ranks() : 1); ++to)
        out.messages.push_back({rank(), to, Notice{Alive{}}});
    dispatch(std::move(out));
}

void RankLink::tell(RankRoles& roles, Outbox& out) {
    roles.ambient_client()->offer(cache_.unsent(), out);
    roles.ambient_client()->ask(out);
}

void RankLink::note_flushed() {
    {
        const std::lock_guard lock(mutex_);
        if (!flushing_ || !posted_.empty() || !roles_.ambient_client()->is_flushed()) return;
        flushing_ = false;
    }
    threads_->notify(changed_);
}

void RankLink::take_step(Activity activity, const Step& step) {
    Outbox out;
    {
        const TimedActivity timed(timeline_, timeline_.message_row(), activity);
        step(roles_, out);
        hand_out(out);
    }
    dispatch(std::move(out));
}

/// Messages to this rank at once, and what follows from them, in order; others to the wire.
void RankLink::dispatch(Outbox first) {
    std::deque<Envelope> due;
    const auto add = [&](Outbox& out) {
        hand_out(out);
        std::move(out.messages.begin(), out.messages.end(), std::back_inserter(due));
    };
    add(first);
    for (; !due.empty(); due.pop_front()) {
        Envelope& envelope = due.front();
        if (envelope.to != rank()) {
            std::string bytes = encode_message(envelope.message);
            {
                const std::lock_guard lock(mutex_);
                counts_.add(envelope.message, bytes.size());
            }
            communicator_.send(envelope.to, std::move(bytes));
            continue;
        }
        const TimedActivity timed(timeline_, timeline_.message_row(),
                                  activity_of(envelope.message));
        Outbox out;
        roles_.handle(envelope.from, std::move(envelope.message), out);
        add(out);
    }
}

void RankLink::hand_out(Outbox& out) {
    for (TracerNews& news : std::exchange(out.tracers, {})) inbox_.push(std::move(news));
    for (ProgramNews& news : std::exchange(out.program, {})) push_news(std::move(news));
    for (const AmbientValues& news : std::exchange(out.cache, {})) cache_.merge(news);
    for (Collective& result : std::exchange(out.results, {})) {
        {
            const std::lock_guard lock(mutex_);
            operations_[static_cast<std::size_t>(result.group)].result = std::move(result);
        }
        threads_->notify(changed_);
    }
}

void RankLink::push_news(ProgramNews news) {
    if (const auto* told = std::get_if<RankNotice>(&news)) {
        const Notice& notice = told->notice;
        if (const auto* failure = std::get_if<Failure>(&notice.notice))
            end_run(told->from, failure->host, failure->text);
        if (std::holds_alternative<Finish>(notice.notice)) return inbox_.close();
        if (std::holds_alternative<Alive>(notice.notice)) return;
    }
    {
        const std::lock_guard lock(mutex_);
        news_.push_back(std::move(news));
    }
    threads_->notify(changed_);
}

void RankLink::end_run(int rank, const std::string& host, const std::string& text) {
    if (failed_) failed_(named(rank, host) + printable(text));
    communicator_.abort(kFailed);
}

std::string RankLink::named(int rank, const std::string& host) const {
    return program_ + ": rank " + std::to_string(rank) + (host.empty() ? "" : " (" + host + ")") +
           ": ";
}

}  // namespace lightwalk
