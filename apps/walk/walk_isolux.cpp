#include "apps/walk/walk_isolux.h"

#include <algorithm>

namespace lightwalk {
namespace {

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
    begin_anew();
}

void WalkIsolux::begin_anew() {
    for (auto& [client, question] : questions_) {
        if (question.light) question.light->begin_anew();
        question.stride = 0;
    }
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
        client_inbox.tell(client, walk_text(isolux_reply(question.id, *question.light)));
        question.told = now;
        question.stride = question.light->stride();
    }
    return more;
}

}  // namespace lightwalk
