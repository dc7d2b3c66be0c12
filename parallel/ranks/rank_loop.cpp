#include "parallel/ranks/rank_loop.h"

#include <algorithm>
#include <utility>

namespace lightwalk {
namespace {

using std::chrono::microseconds;
constexpr microseconds kWalkPatience{400};

RankSettings with_timed_encoding(RankSettings settings, Timeline* timeline) {
    const int row = timeline != nullptr ? timeline->message_row() : 0;
    settings.encode = [encode = settings.encode, timeline, row](const PixelRectangle& block,
                                                                std::vector<PixelValue> values) {
        const TimedActivity timed(timeline, row, Activity::compress);
        return encode(block, std::move(values));
    };
    return settings;
}

}  // namespace

Patience patience_of(const Topology& topology) {
    if (topology.ranks == 1) return {microseconds{20000}, microseconds{20000}};
    return {topology.traces(0) ? microseconds{200} : microseconds{50}, microseconds{2000}};
}

RankLoop::RankLoop(Communicator& communicator, const Topology& topology,
                   const RankSettings& settings, LocalEnd& local, Timeline* timeline)
    : communicator_(communicator),
      topology_(topology),
      local_(local),
      timeline_(timeline),
      draws_walks_(settings.projectors > 0),
      roles_(communicator.rank(), topology, with_timed_encoding(settings, timeline)) {}

void RankLoop::post(int to, Message message) {
    const Activity activity = activity_of(message);
    post(activity, [from = communicator_.rank(), to, carried = std::move(message)](
                       RankRoles&, Outbox& out) mutable {
        out.messages.push_back({from, to, std::move(carried)});
    });
}

void RankLoop::post(Activity activity, Step step) {
    {
        const std::lock_guard lock(mutex_);
        posted_.push_back({activity, std::move(step)});
    }
    communicator_.wake();
}

Collective RankLoop::perform(Collective share) {
    std::unique_lock lock(mutex_);
    Operation& operation = operations_[static_cast<std::size_t>(share.group)];
    share.round = operation.round++;
    posted_.push_back({Activity::serve, [from = communicator_.rank(), carried = std::move(share)](
                                            RankRoles&, Outbox& out) mutable {
                           out.messages.push_back({from, 0, std::move(carried)});
                       }});
    communicator_.wake();
    answered_.wait(lock, [&] { return operation.result.has_value() || over_; });
    if (!operation.result) throw Aborted{1};
    return *std::exchange(operation.result, std::nullopt);
}

std::vector<std::string> RankLoop::all_gather(Collective::Group group, std::string bytes) {
    return perform({group, Collective::Operation::gather, 0, false, {std::move(bytes)}, {}}).parts;
}

std::vector<std::uint64_t> RankLoop::all_reduce(Collective::Group group,
                                                std::vector<std::uint64_t> numbers) {
    return perform({group, Collective::Operation::sum, 0, false, {}, std::move(numbers)}).numbers;
}

std::string RankLoop::broadcast(std::string bytes) {
    std::unique_lock lock(mutex_);
    to_broadcast_ = std::move(bytes);
    communicator_.wake();
    answered_.wait(lock, [&] { return broadcast_.has_value() || over_; });
    if (!broadcast_) throw Aborted{1};
    return *std::exchange(broadcast_, std::nullopt);
}

void RankLoop::serve_broadcast() {
    std::optional<std::string> bytes;
    {
        const std::lock_guard lock(mutex_);
        bytes = std::exchange(to_broadcast_, std::nullopt);
    }
    if (!bytes) return;
    std::string got = communicator_.broadcast(*std::move(bytes));
    {
        const std::lock_guard lock(mutex_);
        broadcast_ = std::move(got);
    }
    answered_.notify_all();
}

void RankLoop::end() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    communicator_.wake();
}

bool RankLoop::run(const StopFlag& stop) {
    take_step(Activity::serve, [](RankRoles& roles, Outbox& out) { roles.begin(out); });
    Patience patience = patience_of(topology_);
    // A frame of a walk is a chain of short steps, each of which waits for messages of the last.
    if (draws_walks_) patience.longest = std::min(patience.longest, kWalkPatience);
    microseconds wait = patience.shortest;
    while (shutdown_ != ShutdownPhase::over && !stop.requested()) {
        serve_broadcast();
        const bool posted = serve_posted();
        const ShutdownPhase before = shutdown_;
        const bool served = serve_arrived() || posted;
        exchange_values_in_time();
        advance_shutdown();
        if (served || shutdown_ != before) {
            wait = patience.shortest;
            continue;
        }
        communicator_.wait(wait);
        wait = std::min(patience.longest, 2 * wait);
    }
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    answered_.notify_all();
    const bool whole = shutdown_ == ShutdownPhase::over;
    if (whole) communicator_.flush();
    return whole;
}

/// Values go out now and then also where they do not make a batch, and a rank that makes none is
/// told of others' all the same: rank 0 may keep a file of them.
void RankLoop::exchange_values_in_time() {
    constexpr std::chrono::seconds kOften{1};
    if (!roles_.ambient_client() || shutdown_ != ShutdownPhase::none) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - exchanged_ < kOften) return;
    exchanged_ = now;
    exchange_values();
}

void RankLoop::exchange_values() {
    AmbientValues own = local_.unsent_values();
    take_step(Activity::exchange, [&](RankRoles& roles, Outbox& out) {
        if (!own.records.empty()) roles.ambient_client()->offer(std::move(own), out);
        roles.ambient_client()->ask(out);
    });
}

void RankLoop::advance_shutdown() {
    {
        const std::lock_guard lock(mutex_);
        if (!ended_ || !posted_.empty()) return;
    }
    std::optional<AmbientClient>& client = roles_.ambient_client();
    if (client && client->waits_for_answer()) return;
    const auto join_round = [&](std::uint32_t round) {
        Outbox out;
        out.messages.push_back({communicator_.rank(), 0,
                                Collective{Collective::Group::shutdown,
                                           Collective::Operation::gather,
                                           round,
                                           false,
                                           {},
                                           {}}});
        dispatch(std::move(out));
    };
    switch (shutdown_) {
        case ShutdownPhase::none:
            shutdown_ = ShutdownPhase::telling;
            if (client) exchange_values();
            return;
        case ShutdownPhase::telling:
            shutdown_ = ShutdownPhase::told;
            return join_round(0);
        case ShutdownPhase::all_told:
            shutdown_ = ShutdownPhase::hearing;
            if (client && communicator_.rank() == 0) exchange_values();
            return;
        case ShutdownPhase::hearing:
            shutdown_ = ShutdownPhase::waiting;
            if (client) client->close();
            return join_round(1);
        case ShutdownPhase::told:
        case ShutdownPhase::waiting:
        case ShutdownPhase::over:
            return;
    }
}

bool RankLoop::serve_posted() {
    std::deque<Posted> posted;
    {
        const std::lock_guard lock(mutex_);
        posted.swap(posted_);
    }
    for (const Posted& one : posted) take_step(one.activity, one.step);
    return !posted.empty();
}

bool RankLoop::serve_arrived() {
    bool any = false;
    while (std::optional<Communicator::Packet> packet = communicator_.receive()) {
        any = true;
        Outbox out;
        out.messages.push_back({packet->from, communicator_.rank(), decode_message(packet->bytes)});
        dispatch(std::move(out));
    }
    return any;
}

void RankLoop::take_step(Activity activity, const Step& step) {
    Outbox out;
    {
        const TimedActivity timed(timeline_, timeline_ != nullptr ? timeline_->message_row() : 0,
                                  activity);
        step(roles_, out);
        hand_out(out);
    }
    dispatch(std::move(out));
}

/// Messages to this rank at once, and what follows from them, in order; others to the wire.
void RankLoop::dispatch(Outbox first) {
    std::deque<Envelope> due;
    const auto add = [&](Outbox& out) {
        hand_out(out);
        std::move(out.messages.begin(), out.messages.end(), std::back_inserter(due));
    };
    add(first);
    for (; !due.empty(); due.pop_front()) {
        Envelope& envelope = due.front();
        if (envelope.to != communicator_.rank()) {
            std::string bytes = encode_message(envelope.message);
            {
                const std::lock_guard lock(counts_mutex_);
                counts_.add(envelope.message, bytes.size());
            }
            communicator_.send(envelope.to, std::move(bytes));
            continue;
        }
        const TimedActivity timed(timeline_, timeline_ != nullptr ? timeline_->message_row() : 0,
                                  activity_of(envelope.message));
        Outbox out;
        roles_.handle(envelope.from, std::move(envelope.message), out);
        add(out);
    }
}

void RankLoop::hand_out(Outbox& out) {
    for (TracerNews& news : std::exchange(out.tracers, {})) local_.take(std::move(news));
    for (ProgramNews& news : std::exchange(out.program, {})) local_.take(std::move(news));
    for (AmbientValues& news : std::exchange(out.cache, {})) local_.take(std::move(news));
    for (Collective& result : std::exchange(out.results, {})) conclude(std::move(result));
}

void RankLoop::conclude(Collective result) {
    if (result.group == Collective::Group::shutdown) {
        shutdown_ = result.round == 0 ? ShutdownPhase::all_told : ShutdownPhase::over;
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        operations_[static_cast<std::size_t>(result.group)].result = std::move(result);
    }
    answered_.notify_all();
}

}  // namespace lightwalk
