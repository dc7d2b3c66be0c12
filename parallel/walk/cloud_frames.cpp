#include "parallel/walk/cloud_frames.h"

namespace lightwalk {

const CloudFrame& CloudFrames::draw(const Camera& camera, PixelCaster& caster, Executor& executor,
                                    const StopFlag& stop) {
    if (lead_.rests(camera.view())) (void)progressive();  // before the last frame is forgotten
    const FrameOrder order = lead_.order(camera.view(), {});
    NoFrameExchange alone;
    if (!loop_.draw(order, camera, caster, alone, executor, stop)) {
        lead_.abandon();
        return loop_.drawn(order).frame();
    }
    CloudRegion& region = loop_.drawn(order);
    std::vector<std::optional<PixelValue>> refined;
    std::span<const Rgb> groups;
    if (order.rests) {
        refined = region.to_trace().values();
        groups = region.to_trace().groups();
    }
    lead_.complete(region.frame(), refined, executor, groups);
    return region.frame();
}

const ProgressivePicture* CloudFrames::mix(const LightMixture& mixture) {
    if (lead_.mix(mixture)) return lead_.progressive();
    lead_.abandon();
    return nullptr;
}

const ProgressivePicture* CloudFrames::progressive() {
    if (lead_.wants_origins()) {
        const CloudFrame& last = loop_.region()->frame();
        lead_.begin_progressive(last, last.origins);
    }
    return lead_.progressive();
}

}  // namespace lightwalk
