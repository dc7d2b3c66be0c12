#include "apps/rank_session.h"

#include <algorithm>
#include <thread>

#include "apps/commands.h"
#include "parallel/ranks/piece_codec.h"

namespace lightwalk {
bool caches_ambient_values(const RenderOptions& light) {
    return light.ambient_bounces > 0 && light.ambient_accuracy > kEpsilon;
}

std::unique_ptr<RankLink> link_ranks(Transport* transport, CommonOptions& options,
                                     const SharedWork& work) {
    const RankOptions& wanted = options.ranks;
    check_launch(wanted, transport != nullptr);
    if (transport == nullptr) return nullptr;
    const bool ambient = work.ambient_values && wanted.ambient_batch > 0;
    const Variant variant = settle_variant(wanted, transport->size(), options.workers, ambient);
    if (variant == Variant::threads) return nullptr;
    if (variant == Variant::ranks) options.workers = 1;
    RankSettings settings;
    settings.slots = options.workers;
    settings.ahead = std::max(1, settings.slots / 2);
    settings.block = wanted.block;
    settings.stride = wanted.stride;
    settings.ambient_batch = static_cast<std::size_t>(wanted.ambient_batch);
    settings.encode = encode_piece;
    settings.rays = work.rays;
    // Chunks of rays are few: one master deals them out.
    const int masters = work.rays ? 1 : wanted.masters;
    return std::make_unique<RankLink>(*transport,
                                      make_topology(variant, transport->size(), ambient, masters),
                                      settings, work.program, !wanted.timeline.empty());
}

std::unique_ptr<SceneSession> build_on_ranks(RankLink& link, const CommonOptions& options,
                                             const RenderSettings& settings,
                                             const std::string& history, WarningSink& warnings) {
    std::unique_ptr<SceneSession> session;
    std::string problem;
    int status = kSuccessStatus;
    try {
        session = std::make_unique<SceneSession>(options, warnings);
        session->build(settings, &link);
    } catch (const UsageError& error) {
        problem = error.what();
        status = kUsageStatus;
    } catch (const std::exception& error) {
        problem = error.what();
        status = kFailureStatus;
    }
    std::vector<std::string> facts;
    if (problem.empty()) {
        facts = {"Lightwalk " LIGHTWALK_VERSION, "options: " + history,
                 "scene " + session->digest()};
    }
    link.agree(facts, problem, status);
    return session;
}

void lead_ranks(RankLink& link, FunctionRef<void()> trace, FunctionRef<void()> work) {
    std::thread tracing([&] {
        if (!link.traces()) return;
        try {
            trace();
        } catch (const std::exception& error) {
            link.fail(error.what());
        }
    });
    try {
        work();
    } catch (const std::exception& error) {
        link.fail(error.what());
    }
    tracing.join();
}

}  // namespace lightwalk
