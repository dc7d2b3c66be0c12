#include "apps/session/render_backend.h"

#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/transport/ray.h"

namespace lightwalk {
namespace {

/// Three channels and a distance.
constexpr std::size_t kAnswerNumbers = 4;
constexpr std::size_t kAnswerBytes = kAnswerNumbers * sizeof(double);

}  // namespace

RenderBackend::RenderBackend(RendererOptions options)
    : options_(std::move(options)), warnings_(options_.warn) {
    if (options_.record) return;
    options_.record = [](const RayQuery&, const Ray& ray, const Hit& first, std::string& bytes) {
        append_ray_answer(ray, first, bytes);
    };
}

FrameOptions RenderBackend::frame_options(int width, int height) const {
    FrameOptions options;
    options.width = width;
    options.height = height;
    options.pixels = options_.pixels;
    options.seed = options_.light.seed;
    options.use_distances = options_.use_distances;
    if (options_.steered) options.pixels.spacing = 1;
    return options;
}

RenderProgress RenderBackend::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

ProgressListener RenderBackend::listener() {
    const auto tell = [this](const RenderProgress& progress) {
        {
            const std::lock_guard lock(mutex_);
            progress_ = progress;
        }
        if (options_.progress) options_.progress(progress);
    };
    return {tell, options_.progress_interval};
}

CachePrepass RenderBackend::prepass() const {
    if (!session().freezable) return CachePrepass::none;
    if (options_.deterministic) return CachePrepass::deterministic;
    return options_.cache_prepass ? CachePrepass::quick : CachePrepass::none;
}

std::unique_ptr<const Tracer> without_indirect(const SceneSession& session, WarningSink& warnings) {
    RenderOptions options = session.tracer().options();
    if (options.ambient_bounces == 0) return nullptr;
    options.ambient_bounces = 0;
    return std::make_unique<const Tracer>(session.scene(), options, warnings);
}

void append_ray_answer(const Ray& ray, const Hit& first, std::string& bytes) {
    const double numbers[kAnswerNumbers] = {
        static_cast<double>(ray.value.r), static_cast<double>(ray.value.g),
        static_cast<double>(ray.value.b), first.exists() ? first.t : kHuge};
    bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
}

std::vector<RayResult> RayBytes::answers() const {
    if (bytes.size() % kAnswerBytes != 0) throw InputError("these bytes are no answers to rays");
    std::vector<RayResult> answers(bytes.size() / kAnswerBytes);
    for (std::size_t i = 0; i < answers.size(); ++i) {
        double numbers[kAnswerNumbers];
        std::memcpy(numbers, bytes.data() + i * kAnswerBytes, sizeof numbers);
        answers[i] = {{static_cast<float>(numbers[0]), static_cast<float>(numbers[1]),
                       static_cast<float>(numbers[2])},
                      numbers[3]};
    }
    return answers;
}

}  // namespace lightwalk
