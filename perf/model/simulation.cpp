#include "perf/model/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "parallel/blocks.h"
#include "parallel/ranks/rank_link.h"
#include "perf/model/simulation_state.h"

namespace lightwalk {
namespace {

constexpr double kOrderBytes = 400;  ///< of what an announcement says of view and options
constexpr double kHeadStart = 10;  ///< ranks are there so long before the picture is asked for [s]
constexpr double kReach = 0.5;     ///< of an ambient value, see AmbientSites

CellCosts prepass_cells(const CostMap& map) {
    return map.prepass.width > 0 ? map.prepass : map.picture;
}

const Pixels* pixels_in(const Message& message) {
    const auto* result = std::get_if<WorkResult>(&message);
    return result != nullptr ? std::get_if<Pixels>(&result->result) : nullptr;
}

const PicturePart* picture_part(const Message& message) {
    const auto* finished = std::get_if<FinishedPart>(&message);
    return finished != nullptr ? std::get_if<PicturePart>(&finished->part) : nullptr;
}

}  // namespace

Simulation::Simulation(const CostMap& map, const Machine& machine, const SimulatedRun& run)
    : map_(map),
      machine_(machine),
      run_(run),
      picture_costs_(map.picture, run.width, run.height),
      prepass_costs_(prepass_cells(map), prepass_cells(map).width, prepass_cells(map).height) {
    const bool exchange = run.ambient && run.ambient_batch > 0;
    if (run.variant == Variant::threads) {
        topology_.ranks = 1;
        topology_.workers.push_back({0, 0});
    } else {
        topology_ = make_topology(run.variant, run.ranks, exchange, run.masters);
    }
    const Patience patience = patience_of(topology_);
    shortest_wait_ = std::chrono::duration<double>(patience.shortest).count();
    longest_wait_ = std::chrono::duration<double>(patience.longest).count();
    if (run.ambient) {
        sites_ = std::make_unique<AmbientSites>(map, kReach, run.seed);
        picture_ = map.prepass.width > 0 ? 1 : 0;
        prediction_.values_needed = sites_->size();
    }
    ranks_.resize(static_cast<std::size_t>(topology_.ranks));
    owners_.resize(topology_.workers.size());
    const std::size_t nodes = node_of(ranks_.size() - 1) + 1;
    const double on_node = static_cast<double>(ranks_.size()) / static_cast<double>(nodes);
    const double looks =
        machine.sleeps && run.variant != Variant::threads
            ? on_node * machine.look * machine.slowness / (longest_wait_ + machine.oversleep)
            : 0;
    nodes_.assign(nodes,
                  Processors(machine.node_cores, machine.crowding, looks, machine.background));
    versions_.resize(nodes);
    for (Rank& rank : ranks_) {
        if (sites_) rank.known.resize(sites_->size());
    }
    for (const Topology::Worker& worker : topology_.workers)
        ranks_[static_cast<std::size_t>(worker.rank)].free_threads = run.threads;
    if (run.variant != Variant::threads) make_roles();
}

Simulation::~Simulation() = default;

std::size_t Simulation::node_of(std::size_t rank) const {
    return machine_.node_ranks == 0 ? 0 : rank / static_cast<std::size_t>(machine_.node_ranks);
}

void Simulation::make_roles() {
    RankSettings settings;
    settings.slots = run_.threads;
    settings.ahead = std::max(1, run_.threads / 2);
    settings.block = run_.block;
    settings.stride = run_.stride;
    settings.ambient_batch = static_cast<std::size_t>(run_.ambient_batch);
    settings.makes_values = run_.ambient;
    settings.encode = [](const PixelRectangle&, const std::vector<PixelValue>&) {
        return std::string();
    };
    for (std::size_t i = 0; i < ranks_.size(); ++i)
        ranks_[i].roles.emplace(static_cast<int>(i), topology_, settings);
}

Prediction Simulation::run() {
    if (run_.variant == Variant::threads)
        start_threads();
    else
        submit();
    while (end_ == kNever || !events_.empty()) {
        if (events_.empty()) throw std::logic_error("simulation: the picture is never finished");
        const Event event = events_.top();
        if (event.time >= end_) break;
        events_.pop();
        now_ = event.time;
        act(event);
    }
    prediction_.seconds = end_;
    for (const Processors& node : nodes_) prediction_.tracing_seconds += node.work_done();
    prediction_.master_seconds = ranks_[0].handling;
    for (std::size_t r = 1; r < ranks_.size(); ++r)
        prediction_.busiest_seconds = std::max(prediction_.busiest_seconds, ranks_[r].handling);
    if (owner_windows_ > 0) prediction_.owner_share /= owner_windows_;
    return std::move(prediction_);
}

/// One process: threads pull blocks from a list, first those of the prepass.
void Simulation::start_threads() {
    const auto begin_job = [&](JobId job) {
        const PixelRectangle area =
            is_prepass(job) ? map_.prepass.area() : PixelRectangle{0, 0, run_.width, run_.height};
        const int side = block_side(area.width(), area.height(), run_.threads,
                                    is_prepass(job) ? 8 : run_.alignment);
        for (const Block& block : make_blocks(area, side)) ranks_[0].blocks.push_back({job, block});
    };
    for (JobId job = 0; job <= picture_; ++job) begin_job(job);
    threads_blocks_ = ranks_[0].blocks.size();
    at(0, Kind::trace, 0);
}

/// The ranks ask for their first blocks long before, at no particular time.
void Simulation::submit() {
    std::mt19937_64 random(run_.seed);
    std::uniform_real_distribution<double> early(0, longest_wait_);
    for (std::size_t r = 0; r < ranks_.size(); ++r) {
        Rank& rank = ranks_[r];
        double clock = -kHeadStart - early(random);
        rank.wire_free = clock;
        now_ = clock;
        dispatch(r, Posted{[](RankRoles& roles, Outbox& out) { roles.begin(out); }}, clock);
        rank.idle_from = rank.busy_until = clock;
    }
    if (picture_ > 0) at(0, Kind::request, 0, 0);
    // Rank 0's program makes a renderer of its own first, to know the alignment.
    at(map_.setup_seconds * machine_.slowness, Kind::request, 0, picture_);
}

void Simulation::at(double time, Kind kind, std::size_t rank, std::uint32_t what) {
    events_.push({time, next_event_++, kind, static_cast<std::uint32_t>(rank), what});
}

void Simulation::act(const Event& event) {
    const std::size_t rank = event.rank;
    switch (event.kind) {
        case Kind::arrive: {
            Envelope envelope = std::move(messages_[event.what]);
            free_messages_.push_back(event.what);
            const double look = next_look(ranks_[rank]);
            put_in(rank, std::move(envelope), look);
            return;
        }
        case Kind::wake:
            if (ranks_[rank].looks_at == event.time) handle_messages(rank);
            return;
        case Kind::request: {
            const PixelRectangle whole{0, 0, run_.width, run_.height};
            const bool coarse = is_prepass(event.what);
            PictureJob start;
            start.job = event.what;
            start.area = coarse ? map_.prepass.area() : whole;
            start.alignment = coarse ? 1 : run_.alignment;
            start.keep = !coarse;
            post(0, {[start](RankRoles& roles, Outbox& out) { roles.queue().start(start, out); }});
            return;
        }
        case Kind::trace:
            trace(rank);
            return;
        case Kind::traced:
            if (versions_[rank] != event.what) return;
            if (const auto next = nodes_[rank].next(now_)) end_step(next->second);
    }
}

/// A message from within the rank wakes its loop.
void Simulation::post(std::size_t rank, Posted posted) {
    put_in(rank, std::move(posted),
           std::max(ranks_[rank].busy_until, now_ + machine_.wake * machine_.slowness));
}

void Simulation::put_in(std::size_t number, Input input, double look) {
    Rank& rank = ranks_[number];
    rank.inbox.push_back(std::move(input));
    if (look >= rank.looks_at) return;
    rank.looks_at = look;
    at(look, Kind::wake, number);
}

/// When a sleeping loop sees what arrives now: it sleeps ever longer, see
/// RankLink::handle_messages().
double Simulation::next_look(const Rank& rank) const {
    if (!machine_.sleeps || now_ <= rank.busy_until) return std::max(now_, rank.busy_until);
    double look = rank.idle_from, wait = shortest_wait_;
    while (look < now_) {
        if (wait >= longest_wait_) {
            const double each = longest_wait_ + machine_.oversleep;
            return look + each * std::ceil((now_ - look) / each);
        }
        look += wait + machine_.oversleep;
        wait = std::min(longest_wait_, 2 * wait);
    }
    return look;
}

/// Processor time of the looks of a loop that has been idle until now, beyond those of one that has
/// been idle for long: it looks the more often, the less long ago it found something.
double Simulation::eager_looks(const Rank& rank) const {
    if (!machine_.sleeps || now_ <= rank.idle_from) return 0;
    const double each = longest_wait_ + machine_.oversleep;
    double look = rank.idle_from, wait = shortest_wait_, looks = 0;
    while (wait < longest_wait_ && look < now_) {
        look += wait + machine_.oversleep;
        wait = std::min(longest_wait_, 2 * wait);
        ++looks;
    }
    const double expected = (std::min(look, now_) - rank.idle_from) / each;
    return std::max(0.0, looks - expected) * machine_.look * machine_.slowness;
}

void Simulation::handle_messages(std::size_t number) {
    Rank& rank = ranks_[number];
    rank.looks_at = kNever;
    nodes_[node_of(number)].take_away(now_, eager_looks(rank));
    std::vector<Input> inbox = std::exchange(rank.inbox, {});
    double clock = now_;
    for (Input& input : inbox) {
        if (const auto* envelope = std::get_if<Envelope>(&input))
            clock +=
                machine_.slowness * (machine_.overhead + machine_.byte_work * bytes_of(*envelope));
        dispatch(number, std::move(input), clock);
    }
    rank.idle_from = rank.busy_until = clock;
    if (now_ >= 0) rank.handling += clock - now_;
    nodes_[node_of(number)].take_away(now_, clock - now_);
    look_ahead(node_of(number));
}

/// As RankLink::dispatch(): what is for this rank at once, and what follows from it.
void Simulation::dispatch(std::size_t number, Input input, double& clock) {
    std::vector<Envelope> due;
    if (const auto* posted = std::get_if<Posted>(&input)) {
        clock += machine_.slowness * posted->work;
        take_step(number, posted->step, due, clock);
    } else {
        due.push_back(std::get<Envelope>(std::move(input)));
    }
    for (std::size_t i = 0; i < due.size(); ++i) {
        Envelope envelope = std::move(due[i]);
        if (envelope.to != static_cast<int>(number)) {
            send(std::move(envelope), clock);
            continue;
        }
        take_step(
            number,
            [&](RankRoles& roles, Outbox& out) {
                roles.handle(envelope.from, std::move(envelope.message), out);
            },
            due, clock);
    }
}

void Simulation::take_step(std::size_t number, const Step& step, std::vector<Envelope>& due,
                           double& clock) {
    clock += machine_.slowness * machine_.step;
    Outbox out;
    step(*ranks_[number].roles, out);
    for (TracerNews& news : out.tracers) handle(number, std::move(news), clock);
    for (const AmbientValues& news : out.cache) handle(number, news, clock);
    for (const ProgramNews& news : out.program) handle(news, clock);
    for (const Envelope& envelope : out.messages) {
        if (const PicturePart* part = picture_part(envelope.message))
            clock += machine_.slowness * map_.encode_seconds *
                     static_cast<double>(part->work.block.pixels());
    }
    std::move(out.messages.begin(), out.messages.end(), std::back_inserter(due));
}

void Simulation::handle(std::size_t number, TracerNews news, double& clock) {
    clock += machine_.slowness * machine_.step;
    const auto* grant = std::get_if<WorkGrant>(&news);
    if (grant == nullptr) return;
    Rank& rank = ranks_[number];
    for (const Work& piece : grant->pieces) rank.blocks.push_back(std::get<JobBlock>(piece));
    at(clock, Kind::trace, number);
}

void Simulation::handle(std::size_t number, const AmbientValues& news, double& clock) {
    for (const AmbientRecord& record : news.records) ranks_[number].known[record.normal] = true;
    clock += machine_.slowness *
             (machine_.step + machine_.value_work * static_cast<double>(news.records.size()));
}

void Simulation::handle(const ProgramNews& news, double& clock) {
    clock += machine_.slowness * machine_.step;
    if (!std::holds_alternative<FinishedPicture>(news)) return;
    const double unpacking = machine_.unpacks ? map_.decode_seconds : 0;
    end_ = clock + machine_.slowness * (machine_.wake + unpacking * run_.width * run_.height);
}

/// Bytes on the wire: the real message's, and those of what simulations leave out.
double Simulation::bytes_of(const Envelope& envelope) const {
    const auto bytes = static_cast<double>(message_bytes(envelope.message));
    if (const Pixels* pixels = pixels_in(envelope.message))
        return bytes + kPixelBytes * static_cast<double>(pixels->work.block.pixels());
    if (const PicturePart* part = picture_part(envelope.message))
        return bytes + map_.packed_bytes * static_cast<double>(part->work.block.pixels());
    if (std::holds_alternative<Announcement>(envelope.message)) return bytes + kOrderBytes;
    return bytes;
}

void Simulation::send(Envelope envelope, double& clock) {
    Rank& rank = ranks_[static_cast<std::size_t>(envelope.from)];
    const double bytes = bytes_of(envelope);
    if (now_ >= 0) prediction_.messages.add(envelope.message, static_cast<std::size_t>(bytes));
    if (pixels_in(envelope.message) != nullptr) count_owner(envelope.to);
    clock += machine_.slowness * (machine_.overhead + machine_.byte_work * bytes);
    const double leaves = std::max(clock, rank.wire_free);
    rank.wire_free = leaves + std::max(machine_.gap, machine_.byte_gap * bytes);
    std::uint32_t slot = 0;
    if (free_messages_.empty()) {
        slot = static_cast<std::uint32_t>(messages_.size());
        messages_.emplace_back();
    } else {
        slot = free_messages_.back();
        free_messages_.pop_back();
    }
    const auto to = static_cast<std::size_t>(envelope.to);
    messages_[slot] = std::move(envelope);
    at(leaves + machine_.byte_gap * bytes + machine_.latency, Kind::arrive, to, slot);
}

void Simulation::count_owner(int owner) {
    ++owners_[*topology_.worker_index(owner)];
    if (++owners_counted_ < 2 * owners_.size()) return;
    const std::uint32_t most = *std::max_element(owners_.begin(), owners_.end());
    prediction_.owner_share += static_cast<double>(most) / owners_counted_;
    ++owner_windows_;
    owners_counted_ = 0;
    std::fill(owners_.begin(), owners_.end(), 0U);
}

}  // namespace lightwalk
