#include "apps/rad_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "apps/commands.h"
#include "core/scene/scene.h"
#include "io/rad/rad_options.h"
#include "io/rad/rad_views.h"

namespace lightwalk {
namespace {

using Files = std::shared_ptr<FileSource>;

// What no command line can say: to be told by the scene.
constexpr int kOpenResolution = std::numeric_limits<int>::min();
constexpr double kOpenStep = -1;

/// The zone, as far as it is known: without the scene a standard view may have none.
RadZone zone_without_scene(const RadPlan& plan) {
    return plan.zone.value_or(RadZone{true, {0, 0, 0}, {1, 1, 1}});
}

/// @param edge  of the scene's cube [m]
void settle_light(const RadPlan& plan, const RadZone& zone, double edge, RenderOptions& light) {
    if (light.ambient_resolution == kOpenResolution)
        light.ambient_resolution = rad_ambient_resolution(plan, zone, edge);
    if (light.scatter_step == kOpenStep) light.scatter_step = rad_scatter_step(plan, zone);
}

/// What -defaults shows: there is no scene, and the cube is taken for as large as the zone.
void settle_without_scene(const RadPlan& plan, CommonOptions& common) {
    if (!common.show_defaults) return;
    const RadZone zone = zone_without_scene(plan);
    settle_light(plan, zone, zone.mean_edge(), common.settings.light);
}

/// Apply options of rpict to a command.
void take_words(const std::vector<std::string>& words, const SourceLocation& where,
                RenderCommand& command, const Files& files) {
    const OptionTable table = option_table(command, files);
    OptionWords options(words, files);
    try {
        while (options.at_option())
            if (!table.take(options)) table.refuse(options);
    } catch (const UsageError& error) {
        throw InputError(where, error.what());
    }
}

void take_values(const std::vector<RadValue>& values, RenderCommand& command, const Files& files) {
    for (const RadValue& value : values) take_words(words_of(value), value.where, command, files);
}

std::string short_text(double x) {
    std::array<char, 32> text{};
    (void)std::snprintf(text.data(), text.size(), "%g", x);
    return text.data();
}

RadZone zone_in(const RadPlan& plan, const Scene& scene) {
    const SceneCube cube = scene.cube();
    return plan.zone.value_or(
        RadZone{true, cube.origin, cube.origin + Vec3{cube.size, cube.size, cube.size}});
}

View view_of(const RadPlan& plan, const RadView& view, const RadZone& zone, const Files& files) {
    RenderCommand reader("render");
    take_words(rad_view_words(plan, view, zone), view.where, reader, files);
    return reader.view;
}

RadView chosen_view(const RadPlan& plan, const std::string& name) {
    return name.empty() ? plan.views.front() : find_rad_view(plan, name);
}

/// The views of a walk's list: the chosen one comes first.
std::vector<NamedView> listed_views(const RadPlan& plan, const std::string& chosen,
                                    const RadZone& zone, const Files& files) {
    std::vector<NamedView> views;
    const auto add = [&](const RadView& view, const std::string& title) {
        if (std::ranges::find(views, title, &NamedView::name) == views.end())
            views.push_back({title, view_of(plan, view, zone, files)});
    };
    if (!chosen.empty()) add(find_rad_view(plan, chosen), chosen);
    for (std::size_t i = 0; i < plan.views.size(); ++i)
        add(plan.views[i], plan.views[i].title(i + 1));
    return views;
}

/// For commands that answer rays.
void finish_rays(const RadPlanPtr& plan, CommonOptions& common) {
    take_rad_scene(*plan, common);
    settle_without_scene(*plan, common);
    common.notices = plan->notices;
    common.request.settle = [plan](const Scene& scene, RendererOptions& options) {
        settle_rad_light(*plan, scene, options.light);
    };
}

/// Words for standard views need the zone: without one they come from the scene.
void settle_views(const RadPlan& plan, const std::string& chosen, const RadZone& zone,
                  RenderCommand& command, const Files& files) {
    if (!command.view_given) command.view = view_of(plan, chosen_view(plan, chosen), zone, files);
    if (!command.serve) return;
    std::vector<NamedView>& views = command.serve->page.views;
    for (NamedView& view : listed_views(plan, chosen, zone, files)) {
        const auto known = std::ranges::find(views, view.name, &NamedView::name);
        if (known == views.end()) views.push_back(std::move(view));
    }
}

}  // namespace

RadPlanPtr named_rad_plan(const CommonOptions& options, FileSource& files) {
    const std::vector<std::string>& names = options.scene_files();
    const auto found = std::ranges::find_if(names, is_rad_file_name);
    if (found == names.end()) return nullptr;
    RadFile file = decode_rad_file(files.read(*found), *found);
    for (const std::string& name : names) {
        if (&name == &*found) continue;
        if (!is_rad_assignment(name))
            throw UsageError(*found + " names the scene's files: " + name +
                             " cannot stand beside it, only variables, as QUALITY=High");
        file.assign(name, {name, 0});
    }
    auto plan = std::make_shared<RadPlan>(rad_plan(file));
    plan->scene_files = rad_scene_files(*plan, files);
    return plan;
}

void take_rad_scene(const RadPlan& plan, CommonOptions& options) {
    std::vector<std::string>& files = options.request.source.files;
    options.request.history += ' ' + history_line(files);
    files = plan.scene_files;
}

void take_rad_light(const RadPlan& plan, RenderSettings& settings, const Files& files) {
    RenderCommand reader("render");
    reader.common.settings = settings;
    take_words(rad_light_words(plan), {plan.name, 0}, reader, files);
    reader.common.settings.light.ambient_resolution = kOpenResolution;
    reader.common.settings.light.scatter_step =
        plan.zone ? rad_scatter_step(plan, *plan.zone) : kOpenStep;
    take_values(plan.render, reader, files);
    settings = reader.common.settings;
}

std::vector<std::string> rad_option_words(const RadPlan& plan, const Scene& scene) {
    const RadZone zone = zone_in(plan, scene);
    std::vector<std::string> words = rad_light_words(plan);
    const auto add = [&](const std::vector<std::string>& more) {
        words.insert(words.end(), more.begin(), more.end());
    };
    add({"-ar", std::to_string(rad_ambient_resolution(plan, zone, scene.cube().size))});
    if (const double step = rad_scatter_step(plan, zone); step > 0) add({"-ms", short_text(step)});
    for (const RadValue& value : plan.render) add(words_of(value));
    add(rad_pixel_words(plan));
    for (const RadValue& value : plan.rpict) add(words_of(value));
    return words;
}

void settle_rad_light(const RadPlan& plan, const Scene& scene, RenderOptions& light) {
    settle_light(plan, zone_in(plan, scene), scene.cube().size, light);
}

void take_rad_plan(const RadPlan& plan, const std::string& view, RenderCommand& command,
                   const Files& files) {
    PixelOptions& pixels = command.common.request.options.pixels;
    RenderCommand reader("render");  // also for a walk: the words are rpict's
    const RadView chosen = chosen_view(plan, view);
    take_words(rad_view_words(plan, chosen, zone_without_scene(plan)), chosen.where, reader, files);
    take_words(rad_size_words(plan), {plan.name, 0}, reader, files);
    take_rad_light(plan, reader.common.settings, files);
    take_words(rad_pixel_words(plan), {plan.name, 0}, reader, files);
    if (!command.serve) take_values(plan.rpict, reader, files);
    command.view = reader.view;
    command.x = reader.x;
    command.y = reader.y;
    command.pixel_aspect = reader.pixel_aspect;
    command.common.settings = reader.common.settings;
    if (!command.serve) pixels = reader.common.request.options.pixels;
    if (!command.walk && pixels.samples == 1) pixels.samples = rad_samples(plan);
    if (!plan.exposure) return;
    command.output.tone.automatic = false;
    command.output.tone.ev = std::log2(*plan.exposure);
}

void take_rad_plan(const RadPlan& plan, const std::string& /*view*/, TraceCommand& command,
                   const Files& files) {
    take_rad_light(plan, command.common.settings, files);
}

void take_rad_plan(const RadPlan& plan, const std::string& /*view*/, ContribCommand& command,
                   const Files& files) {
    take_rad_light(plan, command.common.settings, files);
}

void finish_rad_plan(const RadPlanPtr& plan, const std::string& view, RenderCommand& command,
                     const Files& files) {
    CommonOptions& common = command.common;
    take_rad_scene(*plan, common);
    settle_without_scene(*plan, common);
    common.notices = plan->notices;
    for (const std::string& notice : plan->picture_notices) common.notices.push_back(notice);
    if (command.serve && command.view_given && command.serve->page.views.empty())
        command.serve->page.views.push_back({"start", command.view});
    if (plan->zone) settle_views(*plan, view, *plan->zone, command, files);
    common.request.settle = [plan, view, &command, files](const Scene& scene,
                                                          RendererOptions& options) {
        settle_rad_light(*plan, scene, options.light);
        if (!plan->zone) settle_views(*plan, view, zone_in(*plan, scene), command, files);
    };
}

void finish_rad_plan(const RadPlanPtr& plan, const std::string& /*view*/, TraceCommand& command,
                     const Files& /*files*/) {
    finish_rays(plan, command.common);
}

void finish_rad_plan(const RadPlanPtr& plan, const std::string& /*view*/, ContribCommand& command,
                     const Files& /*files*/) {
    finish_rays(plan, command.common);
}

}  // namespace lightwalk
