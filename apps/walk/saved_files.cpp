#include "apps/walk/saved_files.h"

#include <utility>

#include "apps/session/run_header.h"
#include "apps/walk/dimmed_lights.h"
#include "io/options/view_text.h"
#include "io/picture/picture.h"

namespace lightwalk {
namespace {

constexpr const char* kText = "text/plain; charset=utf-8";

WebAnswer scene_file(std::string text, std::string name) {
    return {200, kText, std::move(text), std::move(name)};
}

WebAnswer missing(std::string why) {
    return {404, kText, std::move(why), {}};
}

}  // namespace

WebAnswer saved_picture(const LivePicture& shown, const View& view, const Model& model,
                        const std::string& history) {
    PictureHeader header{history_header(model.header, history)};
    header.lines.push_back("VIEW= " + view_text(view));
    for (const std::string& line : date_lines()) header.lines.push_back(line);
    return {200, "image/vnd.radiance",
            encode_hdr({shown.width, shown.height, shown.radiance}, header), "picture.hdr"};
}

WebAnswer saved_lights(const std::vector<Primitive>& modifiers, const LightGroups* groups,
                       const LightsRequest& lights) {
    if (groups == nullptr) return missing("no lights may be dimmed here\n");
    return scene_file(scaled_lights(modifiers, *groups, mixture_of(lights, *groups)), "lights.rad");
}

WebAnswer saved_materials(const Model& built, const std::vector<ModifierEdit>& edits) {
    return scene_file(edited_materials(built, edits), "materials.rad");
}

WebAnswer saved_sky(const SkyCalls& skies, const std::optional<SkyTime>& time) {
    if (skies.empty() || !skies.refusal().empty())
        return missing("no generator writes the sky here\n");
    return scene_file(
        "# The sky of a walk's time: it stands in place of the commands that made the scene's.\n" +
            skies.text(time.value_or(skies.first().time())),
        "sky.rad");
}

}  // namespace lightwalk
