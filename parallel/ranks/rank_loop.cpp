#include "parallel/ranks/rank_loop.h"

#include <utility>

namespace lightwalk {
namespace {

using std::chrono::microseconds;
constexpr microseconds kWalkPatience{400};
constexpr std::uint32_t kAmongTracers = 0x80000000;  ///< bit of the rounds of these alone
constexpr std::uint32_t kLastValues = 0xfffffffe,
                        kGoodbye = 0xffffffff;  ///< the last rounds of all

int tracing_threads(const Topology& topology, const RankSettings& settings) {
    return settings.slots * static_cast<int>(topology.workers.size());
}

std::shared_ptr<const std::vector<int>> worker_ranks(const Topology& topology) {
    std::vector<int> ranks;
    for (const Topology::Worker& worker : topology.workers) ranks.push_back(worker.rank);
    return std::make_shared<const std::vector<int>>(std::move(ranks));
}

/// Workers below a master.
std::size_t workers_of(const std::vector<Address>& children) {
    return static_cast<std::size_t>(std::count_if(
        children.begin(), children.end(), [](const Address& c) { return c.role == Role::worker; }));
}

}  // namespace

Patience patience_of(const Topology& topology) {
    if (topology.ranks == 1) return {microseconds{20000}, microseconds{20000}};
    return {topology.traces(0) ? microseconds{200} : microseconds{50}, microseconds{2000}};
}

RankLoop::RankLoop(Transport& transport, const Topology& topology, const RankSettings& settings,
                   LocalEnd& local, Timeline* timeline)
    : transport_(transport), topology_(topology), local_(local), timeline_(timeline) {
    const int rank = transport.rank();
    if (settings.rays)
        make_chunk_roles(settings);
    else if (settings.projectors > 0)
        make_cloud_roles(settings);
    else
        make_block_roles(settings);
    if (topology.ambient_master && settings.ambient_batch > 0) {
        if (*topology.ambient_master == rank)
            ambient_master_.emplace(Address{rank, Role::ambient_master});
        ambient_client_.emplace(Address{rank, Role::ambient_client},
                                Address{*topology.ambient_master, Role::ambient_master},
                                settings.ambient_batch);
    }
}

EncodePiece RankLoop::timed_encoding(EncodePiece encode) const {
    return [encode = std::move(encode), timeline = timeline_](const PixelRectangle& block,
                                                              std::vector<PixelValue> values) {
        const TimedActivity timed(timeline, timeline != nullptr ? timeline->message_row() : 0,
                                  Activity::compress);
        return encode(block, std::move(values));
    };
}

void RankLoop::make_block_roles(const RankSettings& settings) {
    const int rank = transport_.rank();
    if (rank == 0) {
        master_.emplace(
            Address{0, Role::master}, topology_.children, topology_.workers.size(),
            BlockPolicy{settings.block, settings.stride, tracing_threads(topology_, settings)});
    }
    for (const Topology::SubMaster& sub : topology_.sub_masters) {
        if (sub.rank != rank) continue;
        sub_master_.emplace(Address{rank, Role::master}, Address{0, Role::master}, sub.children,
                            workers_of(sub.children) * static_cast<std::size_t>(settings.slots));
    }
    if (const auto index = topology_.worker_index(rank)) {
        worker_.emplace(WorkerOptions{{rank, Role::worker},
                                      {topology_.workers[*index].master, Role::master},
                                      *index,
                                      worker_ranks(topology_),
                                      settings.slots,
                                      settings.ahead,
                                      timed_encoding(settings.encode)});
    }
}

void RankLoop::make_chunk_roles(const RankSettings& settings) {
    constexpr int kChunksAThread = 4;  // one is traced, others wait there, here, or to be written
    const int rank = transport_.rank();
    if (rank == 0) {
        const int window = kChunksAThread * tracing_threads(topology_, settings);
        chunk_master_.emplace(Address{0, Role::master}, static_cast<std::uint32_t>(window));
    }
    if (topology_.traces(rank)) {
        chunk_worker_.emplace(Address{rank, Role::worker}, Address{0, Role::master}, settings.slots,
                              settings.ahead);
    }
}

void RankLoop::make_cloud_roles(const RankSettings& settings) {
    const int rank = transport_.rank();
    const auto workers = worker_ranks(topology_);
    const std::size_t owners = owners_of(workers->size(), settings.projectors);
    if (rank == 0) {
        cloud_master_.emplace(Address{0, Role::master}, *workers, owners,
                              tracing_threads(topology_, settings));
    }
    if (const auto index = topology_.worker_index(rank)) {
        cloud_worker_.emplace(CloudWorkerOptions{{rank, Role::worker},
                                                 {0, Role::master},
                                                 *index,
                                                 owners,
                                                 settings.slots,
                                                 settings.ahead});
    }
}

void RankLoop::post(Role from, Address to, Message message) {
    {
        const std::lock_guard lock(mutex_);
        posted_.push_back({{transport_.rank(), from}, to, std::move(message)});
    }
    transport_.wake();
}

std::vector<std::string> RankLoop::gather(std::string bytes, bool tracers) {
    std::unique_lock lock(mutex_);
    const std::uint32_t round = round_++ | (tracers ? kAmongTracers : 0);
    posted_.push_back(
        {{transport_.rank(), Role::worker}, {0, Role::master}, Gather{round, {std::move(bytes)}}});
    transport_.wake();
    answered_.wait(lock, [&] { return gathered_.has_value() || over_; });
    if (!gathered_) throw Aborted{1};
    return *std::exchange(gathered_, std::nullopt);
}

std::string RankLoop::broadcast(std::string bytes) {
    std::unique_lock lock(mutex_);
    to_broadcast_ = std::move(bytes);
    transport_.wake();
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
    std::string got = transport_.broadcast(*std::move(bytes));
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
    transport_.wake();
}

bool RankLoop::run(const StopFlag& stop) {
    begin();
    Patience patience = patience_of(topology_);
    // A frame of a walk is a chain of short steps, each of which waits for messages of the last.
    if (cloud_master_ || cloud_worker_)
        patience.longest = std::min(patience.longest, kWalkPatience);
    microseconds wait = patience.shortest;
    while (shutdown_ != ShutdownPhase::over && !stop.requested()) {
        serve_broadcast();
        const bool posted = serve_posted();
        const ShutdownPhase before = shutdown_;
        const bool served = serve_arrived() || posted;
        exchange_values_in_time();
        say_goodbye();
        if (served || shutdown_ != before) {
            wait = patience.shortest;
            continue;
        }
        transport_.wait(wait);
        wait = std::min(patience.longest, 2 * wait);
    }
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    answered_.notify_all();
    const bool whole = shutdown_ == ShutdownPhase::over;
    if (whole) transport_.flush();
    return whole;
}

/// Values go out now and then also where they do not make a batch, and a rank that makes none is
/// told of others' all the same: rank 0 may keep a file of them.
void RankLoop::exchange_values_in_time() {
    constexpr std::chrono::seconds kOften{1};
    if (!ambient_client_ || shutdown_ != ShutdownPhase::none) return;
    const auto now = std::chrono::steady_clock::now();
    if (now - exchanged_ < kOften) return;
    exchanged_ = now;
    exchange_values();
}

void RankLoop::exchange_values() {
    const Address client{transport_.rank(), Role::ambient_client};
    AmbientValues own = local_.unsent_values();
    if (!own.records.empty()) dispatch({{client.rank, Role::cache}, client, std::move(own)});
    Outbox out;
    ambient_client_->ask(out);
    for (Envelope& envelope : out) dispatch(std::move(envelope));
}

/// In two rounds. Before the first each rank that has ended tells its last values; then rank 0,
/// which may keep a file of them, hears these. After the second nothing is on its way to anyone.
void RankLoop::say_goodbye() {
    {
        const std::lock_guard lock(mutex_);
        if (!ended_ || !posted_.empty()) return;
    }
    const bool asks = ambient_client_.has_value();
    if (asks && ambient_client_->waits_for_answer()) return;
    const auto say = [&](std::uint32_t round) {
        dispatch({{transport_.rank(), Role::worker}, {0, Role::master}, Gather{round, {}}});
    };
    switch (shutdown_) {
        case ShutdownPhase::none:
            shutdown_ = ShutdownPhase::telling;
            if (asks) exchange_values();
            return;
        case ShutdownPhase::telling:
            shutdown_ = ShutdownPhase::told;
            say(kLastValues);
            return;
        case ShutdownPhase::heard:
            shutdown_ = ShutdownPhase::hearing;
            if (asks && transport_.rank() == 0) exchange_values();
            return;
        case ShutdownPhase::hearing:
            shutdown_ = ShutdownPhase::said;
            if (asks) ambient_client_->close();
            say(kGoodbye);
            return;
        case ShutdownPhase::told:
        case ShutdownPhase::said:
        case ShutdownPhase::over:
            return;
    }
}

void RankLoop::begin() {
    Outbox out;
    if (sub_master_) sub_master_->begin(out);
    if (worker_) worker_->begin(out);
    if (chunk_master_) chunk_master_->begin(out);
    if (chunk_worker_) chunk_worker_->begin(out);
    if (cloud_worker_) cloud_worker_->begin(out);
    for (Envelope& envelope : out) dispatch(std::move(envelope));
}

bool RankLoop::serve_posted() {
    std::deque<Envelope> posted;
    {
        const std::lock_guard lock(mutex_);
        posted.swap(posted_);
    }
    for (Envelope& envelope : posted) dispatch(std::move(envelope));
    return !posted.empty();
}

bool RankLoop::serve_arrived() {
    bool any = false;
    while (std::optional<Transport::Packet> packet = transport_.receive()) {
        any = true;
        dispatch(decode_message(packet->bytes, packet->from, transport_.rank()));
    }
    return any;
}

/// Local messages at once, and what follows from them, in order; others to the wire.
void RankLoop::dispatch(Envelope first) {
    std::deque<Envelope> due;
    due.push_back(std::move(first));
    while (!due.empty()) {
        Envelope envelope = std::move(due.front());
        due.pop_front();
        if (envelope.to.rank != transport_.rank()) {
            std::string bytes = encode_message(envelope);
            {
                const std::lock_guard lock(counts_mutex_);
                counts_.add(envelope.message, bytes.size());
            }
            transport_.send(envelope.to.rank, std::move(bytes));
            continue;
        }
        Outbox out;
        deliver(std::move(envelope), out);
        std::move(out.begin(), out.end(), std::back_inserter(due));
    }
}

Activity RankLoop::activity_of(const Message& message) {
    if (std::holds_alternative<Pixels>(message) || std::holds_alternative<BlockDone>(message))
        return Activity::send;
    if (std::holds_alternative<TracedPixelResults>(message) ||
        std::holds_alternative<CloudPoints>(message))
        return Activity::send;
    return std::holds_alternative<AmbientValues>(message) ? Activity::exchange : Activity::serve;
}

void RankLoop::deliver(Envelope envelope, Outbox& out) {
    const TimedActivity timed(timeline_, timeline_ != nullptr ? timeline_->message_row() : 0,
                              activity_of(envelope.message));
    if (std::holds_alternative<Gather>(envelope.message)) {
        serve_gather(std::move(envelope), out);
        return;
    }
    switch (envelope.to.role) {
        case Role::master:
            if (sub_master_)
                sub_master_->handle(std::move(envelope), out);
            else if (master_)
                master_->handle(std::move(envelope), out);
            else if (chunk_master_)
                chunk_master_->handle(std::move(envelope), out);
            else if (cloud_master_)
                cloud_master_->handle(std::move(envelope), out);
            return;
        case Role::worker:
            if (worker_)
                worker_->handle(std::move(envelope), out);
            else if (chunk_worker_)
                chunk_worker_->handle(std::move(envelope), out);
            else if (cloud_worker_)
                cloud_worker_->handle(std::move(envelope), out);
            return;
        case Role::ambient_master:
            if (ambient_master_) ambient_master_->handle(std::move(envelope), out);
            return;
        case Role::ambient_client:
            if (ambient_client_) ambient_client_->handle(std::move(envelope), out);
            return;
        default:
            local_.take(std::move(envelope));
    }
}

void RankLoop::serve_gather(Envelope envelope, Outbox& out) {
    auto& message = std::get<Gather>(envelope.message);
    if (envelope.to.role != Role::master && message.round >= kLastValues) {
        shutdown_ = message.round == kGoodbye ? ShutdownPhase::over : ShutdownPhase::heard;
        return;
    }
    if (envelope.to.role != Role::master) {  // all parts
        {
            const std::lock_guard lock(mutex_);
            gathered_ = std::move(message.parts);
        }
        answered_.notify_all();
        return;
    }
    // The numbers of the last rounds, in which all take part, hold every bit.
    const bool tracers = message.round < kLastValues && (message.round & kAmongTracers) != 0;
    const auto members =
        tracers ? topology_.workers.size() : static_cast<std::size_t>(transport_.size());
    const int from = envelope.from.rank;
    const std::optional<std::size_t> place =
        tracers ? topology_.worker_index(from) : static_cast<std::size_t>(from);
    if (!place) return;
    Round& round = rounds_[message.round];
    if (round.parts.empty()) {
        round.parts.resize(members);
        round.missing = static_cast<int>(members);
    }
    round.parts[*place] = message.parts.empty() ? std::string() : std::move(message.parts.front());
    if (--round.missing > 0) return;
    const Gather all{message.round, std::move(round.parts)};
    rounds_.erase(message.round);
    for (std::size_t i = 0; i < members; ++i) {
        const int rank = tracers ? topology_.workers[i].rank : static_cast<int>(i);
        out.push_back({{0, Role::master}, {rank, Role::worker}, all});
    }
}

}  // namespace lightwalk
