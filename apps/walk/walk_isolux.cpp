#include "apps/walk/walk_isolux.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/math/corrected_sum.h"
#include "core/trace/light_sampler.h"

namespace lightwalk {
namespace {

constexpr std::uint32_t kOfPlanes = 6;  // random numbers, apart from those of other questions
constexpr int kSamplesOfOne = 64;       // of the darkest point, and of the brightest one
constexpr std::chrono::milliseconds kToldEvery{500};

IsoluxReply isolux_reply(std::uint32_t id, const GridIlluminance& light) {
    IsoluxReply reply;
    reply.id = id;
    reply.done = light.share();
    const int stride = light.stride();
    if (stride == 0) return reply;
    const MeasuringGrid& grid = light.grid();
    reply.columns = (grid.columns + stride - 1) / stride;
    reply.rows = (grid.rows + stride - 1) / stride;
    reply.origin = grid.origin;
    reply.across = stride * grid.across;
    reply.along = stride * grid.along;
    reply.normal = grid.normal;
    reply.values = light.values();
    return reply;
}

}  // namespace

void WalkIsolux::ask(ClientId client, const IsoluxRequest& request, double unit) {
    forget(client);
    questions_.emplace(
        client, Question{request.id, request.normal
                                         ? MeasuringSurvey::on_surface(
                                               *sight_, unit, request.position, *request.normal)
                                         : MeasuringSurvey::above_floor(
                                               *sight_, unit, request.position, request.height)});
}

void WalkIsolux::mix(const LightMixture& mixture) {
    mixture_ = mixture;
    begin_anew();
}

void WalkIsolux::change(const Tracer& tracer, WarningSink& warnings,
                        const std::shared_ptr<const LightGroups>& groups) {
    tracer_ = &tracer;
    sight_.emplace(tracer.scene(), tracer.options().back_faces_visible);
    contexts_ = WorkerContexts(tracer, warnings, executor_.concurrency());
    contexts_.sum_by(groups);
    groups_ = groups;
    begin_anew();
}

void WalkIsolux::begin_anew() {
    for (auto& [client, question] : questions_) {
        if (question.light) question.light->begin_anew();
        question.stride = 0;
    }
}

/// The mean is that of the grid, corrected by samples. The least and the largest value of many are
/// what chance has made of them, too: there it is measured again.
std::optional<IsoluxFigures> WalkIsolux::figures_of(const GridIlluminance& light) const {
    const MeasuringGrid& grid = light.grid();
    std::vector<KnownTerm> terms;
    std::vector<Vec3> places;
    const std::vector<float> values = light.values();
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i])) continue;
        const int at = static_cast<int>(i);
        terms.push_back({1, static_cast<double>(values[i])});
        places.push_back(grid.point(at % grid.columns, at / grid.columns));
    }
    if (terms.empty()) return std::nullopt;
    for (KnownTerm& term : terms) term.weight = 1 / static_cast<double>(terms.size());
    LightSampler sampler(*tracer_, warnings_, groups_);
    sampler.mix(mixture_);
    std::uint32_t count = 0;
    const auto sample = [&](std::size_t term) {
        return sampler.shown(
            sampler.irradiance(places[term], grid.normal, sampler.random(kOfPlanes, count++)));
    };
    const auto again = [&](auto found) {
        std::array<double, kSamplesOfOne> samples{};
        for (double& value : samples)
            value = sample(static_cast<std::size_t>(found - terms.begin()));
        return mean_interval(samples);
    };
    const auto [least, most] = std::minmax_element(
        terms.begin(), terms.end(),
        [](const KnownTerm& a, const KnownTerm& b) { return a.value < b.value; });
    return IsoluxFigures{corrected_sum(terms, sampler.random(kOfPlanes, ~0u), sample), again(least),
                         again(most)};
}

void WalkIsolux::step(double seconds, const StopFlag& stop, ClientInbox& client_inbox) {
    if (questions_.empty()) return;
    auto next = questions_.upper_bound(turn_);
    if (next == questions_.end()) next = questions_.begin();
    turn_ = next->first;
    if (!go_on(next->second, turn_, seconds, stop, client_inbox)) questions_.erase(next);
}

bool WalkIsolux::go_on(Question& question, ClientId client, double seconds, const StopFlag& stop,
                       ClientInbox& client_inbox) {
    if (!question.light) {
        if (!question.survey.step(task_runner_)) return true;
        if (question.survey.grid().columns == 0) {
            client_inbox.tell(client, walk_text(IsoluxReply{question.id, 1}));
            return false;
        }
        question.light.emplace(question.survey.grid());
    }
    const bool more = question.light->step(*tracer_, contexts_, seconds, executor_, stop, mixture_);
    const Clock::time_point now = Clock::now();
    const bool finer = question.light->stride() != question.stride;
    if (!more || finer || now - question.told >= kToldEvery) {
        IsoluxReply reply = isolux_reply(question.id, *question.light);
        if (!more && !stop.requested()) reply.figures = figures_of(*question.light);
        client_inbox.tell(client, walk_text(reply));
        question.told = now;
        question.stride = question.light->stride();
    }
    return more;
}

}  // namespace lightwalk
