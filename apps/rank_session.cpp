#include "apps/rank_session.h"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <thread>

#include "apps/commands.h"
#include "io/files/file_source.h"
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
    settings.ambient_batch = ambient ? static_cast<std::size_t>(wanted.ambient_batch) : 0;
    settings.encode = encode_piece;
    settings.rays = work.rays;
    settings.projectors = work.projectors;
    // Chunks of rays are few, and so are the holes of a walk's frames: one master deals them out.
    const int masters = work.rays || work.projectors > 0 ? 1 : wanted.masters;
    return std::make_unique<RankLink>(*transport,
                                      make_topology(variant, transport->size(), ambient, masters),
                                      settings, work.program, !wanted.timeline.empty());
}

void parse_on_ranks(Transport* transport, const std::string& program,
                    FunctionRef<void(const std::shared_ptr<FileSource>&)> parse) {
    if (transport == nullptr || transport->size() == 1) return parse(real_files());
    // What goes round: an exit status, and where that is 0 what rank 0 has read.
    const auto tell = [&](int status, const std::string& recording) {
        (void)transport->broadcast(std::to_string(status) + recording);
    };
    if (transport->rank() == 0) {
        const auto recorder = std::make_shared<FileRecorder>(real_files(), true);
        try {
            parse(recorder);
        } catch (const UsageError&) {
            tell(kUsageStatus, "");
            throw;
        } catch (const std::exception&) {
            tell(kFailureStatus, "");
            throw;
        }
        return tell(kSuccessStatus, recorder->take());
    }
    const std::string told = transport->broadcast({});
    if (told.front() == '0' + kUsageStatus) throw UsageError("");
    if (told.front() != '0' + kSuccessStatus) throw InputError("");
    try {
        parse(std::make_shared<FileReplay>(std::string_view(told).substr(1)));
    } catch (const std::exception& error) {
        const bool usage = dynamic_cast<const UsageError*>(&error) != nullptr;
        std::fprintf(stderr, "%s: rank %d (%s): %s\n", program.c_str(), transport->rank(),
                     transport->host().c_str(), printable(error.what()).c_str());
        transport->abort(usage ? kUsageStatus : kFailureStatus);
    }
}

namespace {

/// What rank 0 has read, on the other ranks; null when it could not read all.
std::shared_ptr<FileReplay> replay_of_rank_0(RankLink& link) {
    const std::string recording = link.broadcast({});
    if (recording.empty()) return nullptr;
    return std::make_shared<FileReplay>(std::string_view(recording).substr(1));
}

}  // namespace

std::unique_ptr<SceneSession> build_on_ranks(RankLink& link, const CommonOptions& options,
                                             const RenderSettings& settings,
                                             const std::string& history, WarningSink& warnings,
                                             std::shared_ptr<FileSource> base) {
    const bool shared = options.ranks.scene_from == SceneFrom::rank0;
    auto files = std::make_shared<FileRecorder>(std::move(base), shared && link.leads());
    std::shared_ptr<FileReplay> replay;
    std::unique_ptr<SceneSession> session;
    std::string problem;
    int status = kSuccessStatus;
    try {
        if (shared && !link.leads()) {
            replay = replay_of_rank_0(link);
            if (replay) files = std::make_shared<FileRecorder>(replay);
        }
        if (!shared || link.leads() || replay) {
            session = std::make_unique<SceneSession>(options, warnings, files);
            session->build(settings, &link);
        }
    } catch (const UsageError& error) {
        problem = error.what();
        status = kUsageStatus;
    } catch (const std::exception& error) {
        problem = error.what();
        status = kFailureStatus;
    }
    if (shared && link.leads()) (void)link.broadcast(problem.empty() ? '+' + files->take() : "");
    if (replay) replay->clear();
    std::vector<std::string> facts;
    if (session && problem.empty()) {
        facts = {"Lightwalk " LIGHTWALK_VERSION, "options: " + history};
        for (const std::string& file : session->files->digests()) facts.push_back("file " + file);
    }
    link.agree(facts, problem, status,
               shared
                   ? ""
                   : "Every rank reads its own copy of the scene; with --scene-from rank0 rank 0 "
                     "reads it for all.");
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
