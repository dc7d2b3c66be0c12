#include "tests/simulation/rank_run.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace lightwalk::simulation {
namespace {

/// A run without faults takes less, whatever its delays.
constexpr Time kLongest = seconds(20000);

const char* name_of(Fault::Kind kind) {
    constexpr const char* kNames[] = {"stop", "unplug", "kill", "cut", "fail", "interrupt"};
    return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace

double in_seconds(Time time) {
    return std::chrono::duration<double>(time).count();
}

std::string description_of(const RankPlan& plan, const std::string& what) {
    std::ostringstream text;
    text << plan.ranks << (plan.variant == Variant::ranks ? " ranks" : " hybrid ranks") << ", "
         << plan.masters << " masters, " << plan.slots << "+" << plan.ahead << " slots, " << what
         << ", delays to " << in_seconds(plan.longest_delay) << " s, work to "
         << in_seconds(plan.longest_work) << " s" << (plan.broadcasts ? ", broadcast" : "");
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

RankRun::RankRun(Fibers& fibers, const RankPlan& plan, const Planted& planted, std::uint64_t seed)
    : planted_(planted),
      world_(fibers, plan.ranks, seed),
      network_(world_, plan.longest_delay),
      topology_(make_topology(plan.variant, plan.ranks, false, plan.masters)),
      threads_(std::make_shared<WorldThreads>(world_)),
      plan_(plan),
      stop_(static_cast<std::size_t>(plan.ranks)),
      fails_(static_cast<std::size_t>(plan.ranks)),
      reports_(static_cast<std::size_t>(plan.ranks)) {}

Outcome RankRun::play() {
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

void RankRun::plant_faults() {
    for (const Fault& fault : plan_.faults) {
        const auto act = [this, &fault] { befall(fault); };
        if (fault.message > 0)
            network_.after_messages(fault.message, [this, act] { world_.at(world_.now(), act); });
        else
            world_.at(fault.time, act);
    }
}

void RankRun::befall(const Fault& fault) {
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

void RankRun::play_rank(int rank) {
    try {
        const std::unique_ptr<Communicator> wire = network_.end(rank);
        RankLink link(*wire, topology_, settings(), "simulation",
                      [this](const std::string& text) { outcome_.failures.push_back(text); });
        link.run([&] { program(link); }, stop_of(rank));
        network_.left(rank);
        ++left_;
        if (link.inbox().waiting() > 0) complain("something is left that nobody has taken");
    } catch (const Killed&) {
    } catch (const Aborted&) {
        complain("a rank has returned from a run that was ended");
    } catch (const std::exception& error) {
        complain(std::string("an exception left a rank: ") + error.what());
    }
}

RankSettings RankRun::settings() const {
    RankSettings settings;
    settings.slots = plan_.slots;
    settings.ahead = plan_.ahead;
    settings.ambient_batch = 0;
    settings.threads = threads_;
    if (planted_.never_loses_patience) settings.pulse.silence = std::chrono::hours(24);
    change(settings);
    return settings;
}

// As RankBackend::run.
void RankRun::program(RankLink& link) {
    link.agree({"the same"}, "");
    if (plan_.broadcasts && link.broadcast(link.leads() ? "known" : "") != "known")
        complain("a broadcast brings something else");
    const auto trace_or_wait = [&] {
        if (link.traces())
            trace(link);
        else
            link.inbox().wait_for_end(stop_of(link.rank()));
    };
    if (link.leads()) {
        const auto tracing = [&] {
            try {
                link.guard(trace_or_wait);
            } catch (const Aborted&) {
            }
        };
        threads_->side_by_side(tracing, [&] { link.guard([&] { lead_and_dismiss(link); }); });
    } else {
        trace_or_wait();
        link.post(0, Notice{Report{std::to_string(link.rank())}});
    }
    link.end_work();
}

void RankRun::lead_and_dismiss(RankLink& link) {
    lead(link);
    link.dismiss();
    const auto told = [this] { return std::count(reports_.begin() + 1, reports_.end(), 0) == 0; };
    while (!told() && !stop_of(0).requested()) take_some(link);
}

void RankRun::take_some(RankLink& link) {
    for (ProgramNews& news : link.take_news(true, stop_of(0))) {
        const auto* const told = std::get_if<RankNotice>(&news);
        if (told != nullptr && std::holds_alternative<Report>(told->notice.notice))
            take_report(*told);
        else
            take(std::move(news));
    }
}

void RankRun::take_report(const RankNotice& told) {
    if (std::get<Report>(told.notice.notice).payload != std::to_string(told.from) ||
        ++reports_[static_cast<std::size_t>(told.from)] > 1)
        complain("a report that is not the rank's");
}

void RankRun::work_a_while(int rank) {
    if (plan_.longest_work > Time(0)) world_.sleep(world_.chance().up_to(plan_.longest_work));
    if (!fails_[static_cast<std::size_t>(rank)]) return;
    outcome_.last_fault = std::max(outcome_.last_fault, world_.now());
    throw std::runtime_error("cannot trace");
}

/// Whether the run has ended, or gone on, as promised.
void RankRun::check_end() {
    // A silence that is borne, and the time between two signs of life, each to be delivered.
    constexpr Time kBorne = seconds(12), kNoticed = seconds(60);
    outcome_.finished = left_ == plan_.ranks && all_drawn();
    if (!network_.late().empty()) complain(network_.late() + " after a rank's end");
    if (!outcome_.ended) complain("it does not end");
    const bool may_end = may_end_ || silent_ > kBorne;
    if (!may_end && !outcome_.finished)
        complain("it has not drawn all: " +
                 (outcome_.failures.empty() ? std::string("says nothing") : outcome_.failures[0]));
    const bool lost = !outcome_.finished && may_end;
    if (lost && outcome_.end > outcome_.last_fault + kNoticed)
        complain("a loss is noticed too late");
    if (outcome_.finished && !outcome_.failures.empty())
        complain("it is finished and tells of a failure");
}

}  // namespace lightwalk::simulation
