#include "apps/walk/render_loop.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/walk/dimmed_lights.h"
#include "apps/walk/saved_files.h"
#include "core/error.h"
#include "core/math/distance.h"
#include "core/math/overloaded.h"

namespace lightwalk {
namespace {

constexpr double kUsualEyeHeight = 1.6;  // [m]
constexpr double kHighestStep = 0.35;    // as a share of the eye's height
// At rest most of the time goes to better pixels: they are shown the more seldom the longer the
// view rests.
constexpr double kShownShare = 0.25;                 // of the time since it moved
constexpr double kLeastShown = 0.1, kMostShown = 1;  // between pictures that are shown [s]
// Of a place that is new small pictures are drawn until few of their pixels are guessed, then a
// whole one that takes its time: refined from the first one it would be a blur for seconds.
constexpr int kSmallSketches = 4;
constexpr double kFewGuessed = 0.05;
// In other light nothing is known of any pixel's colour: while it goes on to change, all pixels of
// a small picture rather than a few of a larger one, which are no picture.
constexpr double kRelitShare = 0.25;                  // of the width and of the height
constexpr double kAtRest = 0.12, kWholeSketch = 0.5;  // of a step [s]: so long a new view may wait
constexpr std::chrono::milliseconds kStateInterval{250}, kProbeInterval{500};
constexpr std::chrono::seconds kAdaptationTime{2};  // until exposure has settled, about
constexpr std::chrono::milliseconds kHeld{200};     // without a new view: it rests

double eye_height_of(const Scene& scene, const View& view) {
    const std::optional<double> height =
        height_above_ground(scene.geometry(), view.position, view.up);
    constexpr double kTwoStoreys = 8;
    return height && *height < kTwoStoreys ? *height : kUsualEyeHeight;
}

bool same_picture(const ViewRequest& a, const ViewRequest& b) {
    return a.view == b.view && a.walk == b.walk && a.width == b.width && a.height == b.height;
}

/// Whether a view shows hardly anything of what another one shows.
bool is_elsewhere(const View& a, const View& b, double eye_height) {
    constexpr double kAcross = 0.7;  // cosine of an angle
    return length(a.position - b.position) > eye_height ||
           dot(normalize(a.direction), normalize(b.direction)) < kAcross;
}

}  // namespace

RenderLoop::RenderLoop(RenderLoopOptions options, const SceneSession& session, const View& home,
                       LiveFrames& frames, Executor& executor, WarningSink& warnings,
                       ClientInbox& client_inbox, WalkScreen& screen)
    : options_(std::move(options)),
      frames_(frames),
      warnings_(warnings),
      session_(&session),
      read_(session.shared_compiled()),
      model_(read_->model()),
      states_(std::make_unique<SceneStates>(model_, read_->library())),
      scene_state_(options_.start.state),
      client_inbox_(client_inbox),
      screen_(screen),
      threads_(executor.concurrency()),
      has_indirect_(frames.has_indirect()),
      groups_(frames.light_groups()),
      live_(frames, options_.edge_samples),
      answers_(std::in_place, session.tracer(), warnings, groups_),
      glare_(session.tracer(), executor, warnings, groups_),
      isolux_(session.tracer(), executor, warnings, groups_),
      survey_(std::in_place, session.scene(), session.tracer().options().back_faces_visible),
      task_runner_(executor),
      eye_height_(eye_height_of(session.scene(), home)),
      edits_(options_.start.edits) {
    wish_.time = options_.start.time;
    wish_.edits = options_.start.edits_asked;
    if (options_.denoise) clean_view_.emplace(options_.denoise);
}

void RenderLoop::step(const StopFlag& stop, std::chrono::milliseconds longest) {
    answer(client_inbox_.pop(std::min(patience(), longest)));
    if (!wish_.view || stop.requested()) return;
    const Clock::time_point begin = Clock::now();
    draw(stop);
    clean();
    const Clock::time_point now = Clock::now();
    const bool hurries = live_.picture().phase == WalkPhase::moving;
    const bool shows =
        drawn_ && (hurries || dimmed_ || now - shown_at_ >= progressive_interval(now));
    if (shows) show(now);
    screen_.acked(client_inbox_.pop_acks());  // of meanwhile: they tell who may be sent a frame
    screen_.send(client_inbox_, Clock::now());
    if (shows && hurries) note_pace(begin);
    report(now);
    draw_plan();
    if (!hurries) measure_planes(stop);
    keep(now);
    if (!wish_.probes.empty() && !hurries && now - measured_at_ >= kProbeInterval) measure_probes();
}

std::chrono::milliseconds RenderLoop::patience() const {
    if (!wish_.view) return kMoment;
    if (has_work() || !plan_questions_.empty() || isolux_.is_asked())
        return std::chrono::milliseconds(0);
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::min(screen_.next_chance(), Clock::now() + kMoment) - Clock::now());
    return std::max(left, std::chrono::milliseconds(1));
}

WalkWish RenderLoop::seen() const {
    WalkWish wish = wish_;
    if (!wish.view || !view_) return wish;
    wish.view->view = *view_;
    wish.view->walk = false;
    return wish;
}

/// A hand is on a dimmer: what is known is mixed anew, and what is better comes later.
bool RenderLoop::is_dimming() const {
    return Clock::now() - dimmed_at_ < kHeld;
}

bool RenderLoop::has_work() const {
    if (drawn_ && is_dimming() && !glare_.is_asked()) return dimmed_;
    if (!drawn_ || live_.picture().phase != WalkPhase::done || glare_.is_asked()) return true;
    if (live_.has_more_around()) return true;
    const Size size = size_now();
    return live_.picture().width != size.width || live_.picture().height != size.height;
}

/// A hand may hold still without letting go: then the view rests, though it is said to move.
RenderLoop::Size RenderLoop::size_now() const {
    const Size whole{wish_.view->width, wish_.view->height};
    const bool rests = !wish_.view->moving || Clock::now() - moved_ > kHeld;
    if (rests && small_sketches_ == 0) return whole;
    if (relit_ && !wish_.view->moving) {
        const auto of = [](int side) {
            return std::max(static_cast<int>(std::lround(kRelitShare * side)), 1);
        };
        return {of(whole.width), of(whole.height)};
    }
    return {moving_size_.of(whole.width), moving_size_.of(whole.height)};
}

void RenderLoop::answer(const InboxContents& inbox) {
    screen_.update_clients(inbox);
    if (!inbox.joined.empty()) told_.reset();
    if (!inbox.want_depth.empty() || !inbox.want_luminance.empty()) shown_ = false;
    const Clock::time_point now = Clock::now();
    if (inbox.wish.display != wish_.display || inbox.wish.difference != wish_.difference) {
        shown_ = false;
        moved_ = now;
    }
    const bool other_light = inbox.wish.settings != wish_.settings;
    const bool edits = inbox.wish.edits != wish_.edits;
    const bool dims = inbox.wish.lights != wish_.lights;
    const bool timed = inbox.wish.time.time != wish_.time.time;
    const bool moved =
        inbox.wish.view && (!wish_.view || !same_picture(*inbox.wish.view, *wish_.view));
    if (inbox.wish.view && wish_.view && inbox.wish.view->id != wish_.view->id) shown_ = false;
    wish_ = inbox.wish;
    if (moved) {
        if (!view_ || is_elsewhere(*view_, wish_.view->view, eye_height_)) {
            small_sketches_ = kSmallSketches;
            sketches_ = 1;
            relit_ = false;
        }
        glare_.forget(client_inbox_);
        view_ = on_the_ground(*wish_.view);
        moved_ = now;
    }
    if (moved || other_light) drawn_ = false;
    if (edits) edit();
    if (timed) set_time();
    if (timed || !inbox.joined.empty()) tell_time();
    if (dims && groups_) dim();
    clean();
    if (inbox.new_probes) measured_at_ = {};
    if (!view_ || live_.picture().radiance.empty())
        return client_inbox_.refuse(inbox, "there is no picture yet");
    for (const WalkQuestion& question : inbox.questions) reply(question);
    for (const ClientId client : inbox.left) isolux_.forget(client);
    save_files(inbox);
}

/// Pictures and numbers of the dimmers' new state, without a ray where all of it is known.
void RenderLoop::dim() {
    mix_lights();
    dimmed_ = true;
    shown_ = false;
    moved_ = dimmed_at_ = Clock::now();
    const ProbesReply reply = answers_->known();
    if (!reply.probes.empty()) client_inbox_.tell_all(walk_text(reply));
}

void RenderLoop::mix_lights() {
    const LightMixture mixture = mixture_of(wish_.lights, *groups_);
    if (!live_.mix(mixture)) drawn_ = false;
    answers_->mix(mixture);
    glare_.mix(mixture);
    isolux_.mix(mixture);
}

/// Points that cannot show what has changed stay as they are. They are traced anew once the view
/// rests, as all points are, with what has changed in the light around.
void RenderLoop::edit() {
    CheckedEdits checked = check_edits(model_, wish_.edits);
    if (checked.sound != edits_.sound) {
        const std::vector<std::size_t> changed = changed_modifiers(edits_.sound, checked.sound);
        const bool around = lights_others(session_->scene(), changed);
        if (!around)
            frames_.outdate_only(
                ShownMaterials(session_->scene(), modifiers_with(session_->scene(), changed)));
        SceneState state = scene_state_;
        for (const ModifierEdit& edit : edits_.sound)
            state.replaced.erase(static_cast<std::int32_t>(edit.modifier));
        for (const ModifierEdit& edit : checked.sound)
            state.replaced.insert_or_assign(static_cast<std::int32_t>(edit.modifier),
                                            edited_primitive(model_, edit));
        if (change_scene(std::move(state))) {
            if (!around) {
                small_sketches_ = sketches_ = 0;
                relit_ = false;
            }
            edited_ = !around;
            checked.reply.kept = around ? 0 : frames_.kept_points();
            edits_ = checked;
        } else {
            frames_.outdate_only(std::nullopt);
            for (MaterialEdit& edit : checked.reply.materials)
                checked.reply.refused.push_back(
                    {std::move(edit.name), edit.definition, change_problem_});
            checked.reply.materials = edits_.reply.materials;
        }
    }
    client_inbox_.announce_edits(walk_text(checked.reply));
}

bool RenderLoop::change_scene(SceneState state) {
    change_problem_.clear();
    try {
        if (!options_.change) throw InputError("the scene cannot be changed here");
        take_session(options_.change(states_->change_of(state)));
    } catch (const InputError& error) {
        change_problem_ = error.what();
        return false;
    }
    scene_state_ = std::move(state);
    return true;
}

void RenderLoop::set_time() {
    SceneState state = scene_state_;
    state.time = wish_.time.time;
    (void)change_scene(std::move(state));
}

std::optional<TimePlace> RenderLoop::time_place() const {
    std::optional<TimePlace> place = ::lightwalk::time_place(states_->skies());
    if (place && !options_.change) place->refused = "the scene cannot be changed here";
    return place;
}

void RenderLoop::tell_time() {
    if (states_->skies().empty() && change_problem_.empty()) return;
    client_inbox_.tell_all(
        walk_text(time_reply(states_->skies(), scene_state_.time, change_problem_)));
}

/// Whatever asks rays asks them of the new session.
void RenderLoop::take_session(const SceneSession& session) {
    session_ = &session;
    has_indirect_ = frames_.has_indirect();
    groups_ = frames_.light_groups();
    const Tracer& tracer = session.tracer();
    answers_.emplace(tracer, warnings_, groups_);
    glare_.change(tracer, warnings_, groups_);
    isolux_.change(tracer, warnings_, groups_);
    survey_.emplace(session.scene(), tracer.options().back_faces_visible);
    live_.begin_anew();
    if (groups_) mix_lights();
    drawn_ = shown_ = false;
    small_sketches_ = kSmallSketches;
    sketches_ = 1;
    relit_ = true;
    moved_ = Clock::now();
    measured_at_ = {};
}

View RenderLoop::on_the_ground(const ViewRequest& request) const {
    View view = request.view;
    if (!request.walk) return view;
    const std::optional<double> height =
        height_above_ground(session_->scene().geometry(), view.position, view.up);
    if (height && std::abs(eye_height_ - *height) <= kHighestStep * eye_height_)
        view.position += (eye_height_ - *height) * normalize(view.up);
    return view;
}

RenderLoop::Clock::duration RenderLoop::progressive_interval(Clock::time_point now) const {
    const double rested = std::chrono::duration<double>(now - moved_).count();
    return std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(std::clamp(kShownShare * rested, kLeastShown, kMostShown)));
}

/// Of a moving frame's time at least a third is for its steps. At rest they are long, since each
/// takes a while beside it.
double RenderLoop::budget() const {
    constexpr double kShortest = 0.001, kLeastShare = 1.0 / 3, kEdited = 0.06;
    if (edited_) return share_ * kEdited;  // most of the picture is there
    const bool whole_sketch = sketches_ > 0 && small_sketches_ == 0;
    if (!wish_.view->moving && !is_dimming())
        return share_ * (whole_sketch ? kWholeSketch : kAtRest);
    const double seconds =
        share_ * moving_size_.periods(wish_.view->width, wish_.view->height) / options_.rate;
    return std::max({seconds - aside_seconds_, kLeastShare * seconds, kShortest});
}

void RenderLoop::draw(const StopFlag& stop) {
    // Pages that draw the camera of the moment are in no hurry: right frames serve them better than
    // new ones.
    moving_size_.set_patient(screen_.all_want_depth());
    moving_size_.limit(wish_.view->width, wish_.view->height, screen_.most_moving_pixels());
    const double budget = this->budget();
    if (glare_.is_asked() && drawn_) return glare_.step(budget, stop, client_inbox_);
    if (!has_work() || (drawn_ && is_dimming())) return;
    const WalkAmbient ambient = has_indirect_ ? wish_.settings.ambient : WalkAmbient::off;
    recall(ambient, stop);
    const Size size = size_now();
    if (small_sketches_ > 0 || sketches_ > 0) live_.look_anew();
    live_.look_around(!wish_.view->moving);
    if (!live_.next(*view_, size.width, size.height, ambient, budget, stop)) return;
    drawn_ = true;
    edited_ = false;
    shown_ = shown_ && !live_.picture().is_new;
    note_size(size, budget);
    pace_.rays += live_.picture().rays;
    if (live_.picture().phase == WalkPhase::moving) {
        const CloudReport& report = live_.picture().report;
        pace_.reused += static_cast<double>(report.reused);
        pace_.inferred += static_cast<double>(report.inferred);
        pace_.guessed += static_cast<double>(report.filled - report.inferred);
        pace_.pixels += static_cast<double>(report.pixels);
    }
}

/// What a picture of this size tells of the next one's.
void RenderLoop::note_size(Size size, double budget) {
    const LivePicture& picture = live_.picture();
    const auto pixels = static_cast<double>(picture.radiance.size());
    const auto guessed = static_cast<double>(picture.report.filled - picture.report.inferred);
    int& left = small_sketches_ > 0 ? small_sketches_ : sketches_;
    left = guessed < kFewGuessed * pixels ? 0 : std::max(left - 1, 0);
    relit_ = relit_ && small_sketches_ > 0;
    if (picture.phase == WalkPhase::moving && wish_.view->moving &&
        size.width == moving_size_.of(wish_.view->width))
        moving_size_.record(picture.report, budget);
}

/// After each picture, and before one of another view takes its time.
void RenderLoop::clean() {
    if (!clean_view_) return;
    const bool rests = drawn_ && !dimmed_ && !is_dimming();
    if (clean_view_->follow(live_.picture(), wish_.display, rests)) {
        shown_ = false;
        shown_at_ = {};
    }
    const std::string why = clean_view_->take_problem();
    if (why.empty()) return;
    warnings_.warn(why);
    client_inbox_.tell_all(walk_text(RefusedReply{why, std::nullopt}));
}

/// Not where nothing is new: neither pixels nor their colours.
void RenderLoop::show(Clock::time_point now) {
    if (shown_ && now - moved_ > kAdaptationTime && !screen_.is_outdated()) return;
    const ShownView view{
        wish_.view->id, view_->position, live_.picture().phase != WalkPhase::moving,
        live_.picture().phase == WalkPhase::done && !(clean_view_ && clean_view_->is_coming())};
    screen_.measure_depth(live_.picture(), *view_, eye_height_);
    screen_.show(live_.picture(), wish_.display, view, now,
                 clean_view_ ? clean_view_->radiance() : std::span<const Rgb>());
    const ViewReply told{*view_, wish_.view->seen};
    if (told_ != told) client_inbox_.tell_watchers(walk_text(told));
    told_ = told;
    shown_ = true;
    dimmed_ = false;
    shown_at_ = now;
    ++pace_.frames;
}

/// What a frame takes beside the steps that a budget is for is not left for these.
void RenderLoop::note_pace(Clock::time_point begin) {
    constexpr double kShare = 0.2;
    const CloudReport& report = live_.picture().report;
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count() -
                           report.project_seconds - report.check_seconds - report.trace_seconds -
                           report.infer_seconds - report.keep_seconds;
    aside_seconds_ += kShare * (seconds - aside_seconds_);
}

void RenderLoop::report(Clock::time_point now) {
    if (now - pace_.since < kStateInterval) return;
    const double seconds = std::chrono::duration<double>(now - pace_.since).count();
    StateReply state;
    state.fps = pace_.frames / seconds;
    state.inferred = pace_.pixels > 0 ? pace_.inferred / pace_.pixels : live_.picture().inferred;
    state.reuse = pace_.pixels > 0 ? pace_.reused / pace_.pixels : 1 - state.inferred;
    state.guessed = pace_.pixels > 0 ? pace_.guessed / pace_.pixels : 0;
    state.rays_per_second = static_cast<double>(pace_.rays) / seconds;
    state.phase = live_.picture().phase;
    state.share = live_.picture().share;
    state.ranks = options_.ranks;
    state.threads = threads_;
    state.points = live_.picture().report.points;
    client_inbox_.tell_all(walk_text(state));
    pace_ = {};
    pace_.since = now;
}

void RenderLoop::reply(const WalkQuestion& question) {
    const LivePicture& shown = live_.picture();
    const auto tell = [&](const auto& answer) {
        client_inbox_.tell(question.client, walk_text(answer));
    };
    std::visit(
        Overloaded{[&](const PickRequest& pick) {
                       const Camera camera(pick.view.value_or(*view_));
                       tell(answers_->pick(pick, camera, {1.0 / shown.width, 1.0 / shown.height}));
                   },
                   [&](const MaterialRequest& material) { tell(describe(material)); },
                   [&](const MeanRequest& mean) {
                       tell(answers_->mean(mean, shown, *view_, frames_.options()));
                   },
                   [&](const GlareRequest& glare) { glare_.ask(question.client, glare, *view_); },
                   [&](const PlanRequest& plan) {
                       plan_questions_.insert_or_assign(question.client, plan.id);
                   },
                   [&](const IsoluxRequest& isolux) {
                       isolux_.ask(question.client, isolux, eye_height_);
                   }},
        question.ask);
}

MaterialReply RenderLoop::describe(const MaterialRequest& request) const {
    const Scene& scene = session_->scene();
    const auto ray = Camera(request.view.value_or(*view_)).ray(request.x, request.y);
    const Hit hit =
        ray ? scene.geometry().intersect({ray->origin, ray->direction, farthest_hit(ray->limit)})
            : Hit{};
    return describe_material(scene, model_, hit, request.id);
}

/// A part of it beside each frame, so that none waits for all of it.
void RenderLoop::draw_plan() {
    if (plan_questions_.empty()) return;
    survey_->aim(view_->position, eye_height_);
    if (!survey_->step(task_runner_)) return;
    PlanReply reply = plan_reply(survey_->plan());
    for (const auto& [client, id] : std::exchange(plan_questions_, {})) {
        reply.id = id;
        client_inbox_.tell(client, walk_text(reply));
    }
}

/// Beside pictures that become better; while the eye moves all time is for its frames.
void RenderLoop::measure_planes(const StopFlag& stop) {
    constexpr double kBesidePictures = 0.04;  // [s]
    isolux_.step(has_work() ? kBesidePictures : kAtRest, stop, client_inbox_);
}

void RenderLoop::save_files(const InboxContents& inbox) const {
    const auto answer = [](const std::vector<WebReply>& replies, const auto& make) {
        for (const WebReply& reply : replies) reply(make());
    };
    answer(inbox.saves, [&] {
        return saved_picture(live_.picture(), *view_, session_->compiled().model(),
                             options_.history);
    });
    answer(inbox.light_saves, [&] {
        return saved_lights(session_->scene().own_modifiers(), groups_.get(), wish_.lights);
    });
    answer(inbox.material_saves, [&] { return saved_materials(model_, edits_.sound); });
    answer(inbox.sky_saves, [&] { return saved_sky(states_->skies(), scene_state_.time); });
}

void RenderLoop::measure_probes() {
    // A new view waits so long, too [s].
    constexpr double kBesidePictures = 0.02, kDone = 0.05;
    const double seconds = has_work() ? kBesidePictures : kDone;
    client_inbox_.tell_all(walk_text(answers_->measure(wish_.probes, view_->position, seconds)));
    measured_at_ = Clock::now();
}

}  // namespace lightwalk
