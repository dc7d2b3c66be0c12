// The part of RenderLoop that puts a scene in place of another one whose files were edited.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/walk/outdated_points.h"
#include "apps/walk/render_loop.h"
#include "core/error.h"

namespace lightwalk {
namespace {

FollowedReply followed_reply(const SceneNews& news) {
    FollowedReply reply;
    for (const std::string& file : news.files)
        reply.files.push_back(std::filesystem::path(file).filename().string());
    const ModelDifference& difference = news.difference;
    reply.materials = difference.modifiers.size();
    reply.sources = difference.sources;
    reply.surfaces = std::max(difference.gone.size(), difference.come.size());
    return reply;
}

constexpr double kMostKept = 0.5;  // of the points: the next picture takes little time

bool is_as_read(const SceneState& state) {
    return !state.time && state.replaced.empty();
}

}  // namespace

/// The time and the edits of now in a scene that has just been read.
SceneState RenderLoop::state_in(const SceneStates& states, const Model& model,
                                const CheckedEdits& edits) const {
    SceneState state;
    if (!states.skies().empty() && states.skies().refusal().empty()) state.time = scene_state_.time;
    for (const ModifierEdit& edit : edits.sound)
        state.replaced.insert_or_assign(static_cast<std::int32_t>(edit.modifier),
                                        edited_primitive(model, edit));
    return state;
}

FollowedReply RenderLoop::follow(const SceneNews& news) {
    FollowedReply reply = followed_reply(news);
    try {
        if (!options_.replace) throw InputError("the scene cannot be changed here");
        const Model& model = news.scene->model();
        auto states = std::make_unique<SceneStates>(model, news.scene->library());
        CheckedEdits edits = check_edits(model, wish_.edits);
        SceneState state = state_in(*states, model, edits);
        std::shared_ptr<const CompiledScene> shown = news.scene;
        if (!is_as_read(state))
            shown = std::make_shared<const CompiledScene>(news.scene, states->change_of(state),
                                                          news.scene->warnings());
        std::optional<ShownMaterials> outdated;
        if (edits.sound == edits_.sound && state.time == scene_state_.time)
            outdated = outdated_points(session_->tracer(), model_, shown->scene(), news,
                                       view_ ? view_->position : Vec3{});
        frames_.outdate_only(outdated);
        take_session(options_.replace(shown));
        read_ = news.scene;
        model_ = model;
        states_ = std::move(states);
        scene_state_ = std::move(state);
        edits_ = std::move(edits);
        if (outdated) {
            small_sketches_ = sketches_ = 0;
            relit_ = false;
            reply.kept = frames_.kept_points();
            edited_ = reply.kept > kMostKept;
        }
    } catch (const InputError& error) {
        frames_.outdate_only(std::nullopt);
        reply.problems = {error.what()};
        return reply;
    }
    change_problem_.clear();
    reply.time = time_place();
    if (groups_) reply.lights = groups_->names;
    client_inbox_.announce_edits(walk_text(edits_.reply));
    tell_time();
    return reply;
}

}  // namespace lightwalk
