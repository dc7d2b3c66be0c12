#include "apps/rank_session.h"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <thread>

#include "apps/commands.h"
#include "io/files/file_source.h"
#include "parallel/ranks/piece_codec.h"

namespace lightwalk {

std::unique_ptr<RankLink> link_ranks(Communicator* communicator, CommonOptions& options,
                                     const SharedWork& work) {
    const RankOptions& wanted = options.ranks;
    check_launch(wanted, communicator != nullptr);
    if (communicator == nullptr) return nullptr;
    const bool ambient = work.ambient_values && wanted.ambient_batch > 0;
    const Variant variant =
        resolve_variant(wanted, communicator->size(), options.request.options.threads, ambient);
    if (variant == Variant::threads) return nullptr;
    if (variant == Variant::ranks) options.set_threads(1);
    RankSettings settings;
    settings.slots = options.request.options.threads;
    settings.ahead = std::max(1, settings.slots / 2);
    settings.block = wanted.block;
    settings.stride = wanted.stride;
    settings.ambient_batch = ambient ? static_cast<std::size_t>(wanted.ambient_batch) : 0;
    settings.encode = encode_piece;
    settings.rays = work.rays;
    settings.projectors = work.projectors;
    // Chunks of rays are few, and so are the uncached pixels of a walk's frames: one master deals
    // them out.
    const int masters = work.rays || work.projectors > 0 ? 1 : wanted.masters;
    return std::make_unique<RankLink>(
        *communicator, make_topology(variant, communicator->size(), ambient, masters), settings,
        options.program(), !wanted.timeline.empty());
}

void parse_on_ranks(Communicator* communicator, const std::string& program,
                    FunctionRef<void(const std::shared_ptr<FileSource>&)> parse) {
    if (communicator == nullptr || communicator->size() == 1) return parse(real_files());
    // What goes round: an exit status, and where that is 0 what rank 0 has read.
    const auto tell = [&](int status, const std::string& recording) {
        (void)communicator->broadcast(std::to_string(status) + recording);
    };
    if (communicator->rank() == 0) {
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
    const std::string told = communicator->broadcast({});
    if (told.front() == '0' + kUsageStatus) throw UsageError("");
    if (told.front() != '0' + kSuccessStatus) throw InputError("");
    try {
        parse(std::make_shared<FileReplay>(std::string_view(told).substr(1)));
    } catch (const std::exception& error) {
        const bool usage = dynamic_cast<const UsageError*>(&error) != nullptr;
        std::fprintf(stderr, "%s: rank %d (%s): %s\n", program.c_str(), communicator->rank(),
                     communicator->host().c_str(), printable(error.what()).c_str());
        communicator->abort(usage ? kUsageStatus : kFailureStatus);
    }
}

namespace {

/// What rank 0 has read, on the other ranks; null when it could not read all.
std::shared_ptr<FileReplay> replay_of_rank_0(RankLink& link) {
    const std::string recording = link.broadcast({});
    if (recording.empty()) return nullptr;
    return std::make_shared<FileReplay>(std::string_view(recording).substr(1));
}

/// The other ranks, as those who have the same cache.
class RankSharing final : public CacheSharing {
  public:
    explicit RankSharing(RankLink& link) : link_(link) {}
    [[nodiscard]] bool has_file() const override { return link_.leads(); }
    void exchange(PublishedCache& cache, const std::vector<AmbientRecord>& known) override {
        link_.exchange(cache, known);
    }

  private:
    RankLink& link_;
};

/// The steps by which all ranks come to have the scene; it stays null on those that have nothing to
/// build, as rank 0 could not read it.
struct SceneOfRank {
    RankLink& link;
    const SceneSource& source;
    WarningSink& warnings;
    std::shared_ptr<FileSource> base;
    std::shared_ptr<CompiledScene> scene;
    std::shared_ptr<FileReplay> replay;

    void read() { make(std::make_shared<FileRecorder>(base)); }

    /// Rank 0's memory, where it says where that is; else each rank reads, or maps, its own.
    void share() {
        if (link.leads()) return lead_sharing();
        const std::string path = link.broadcast({});
        if (path == kUnreadable) return;
        if (path == kEachItsOwn) return read();
        try {
            scene = std::make_shared<CompiledScene>(source, warnings,
                                                    std::make_shared<FileRecorder>(), path);
        } catch (const InputError&) {
            read();  // the system lets no process look at another's
        }
    }

    void take_from_rank_0(const std::shared_ptr<FileRecorder>& recorder) {
        if (link.leads()) return make(recorder);
        replay = replay_of_rank_0(link);
        if (replay) make(std::make_shared<FileRecorder>(replay));
    }

  private:
    static constexpr const char *kUnreadable = "", *kEachItsOwn = "-";

    void make(const std::shared_ptr<FileRecorder>& files) {
        scene = std::make_shared<CompiledScene>(source, warnings, files);
    }

    void lead_sharing() {
        std::string path = kUnreadable;
        try {
            read();
            if (scene->frozen() == nullptr) path = scene->share();
            if (path.empty()) path = kEachItsOwn;
        } catch (...) {
            (void)link.broadcast(kUnreadable);
            throw;
        }
        (void)link.broadcast(path);
    }
};

}  // namespace

std::unique_ptr<SceneSession> build_on_ranks(RankLink& link, const SceneSource& source,
                                             SceneFrom from, const LightSettings& light,
                                             const std::string& history, WarningSink& warnings,
                                             std::shared_ptr<FileSource> base) {
    const bool by_rank_0 = from == SceneFrom::rank0;
    const bool shared = from == SceneFrom::shared && link.ranks() > 1 && link.on_one_machine();
    std::shared_ptr<FileRecorder> recorder;  // of what all shall have
    if (by_rank_0 && link.leads()) recorder = std::make_shared<FileRecorder>(base, true);
    SceneOfRank ours{link, source, warnings, std::move(base), {}, {}};
    std::unique_ptr<SceneSession> session;
    std::string problem;
    int status = kSuccessStatus;
    try {
        if (by_rank_0)
            ours.take_from_rank_0(recorder);
        else if (shared)
            ours.share();
        else
            ours.read();
        if (ours.scene) {
            ours.scene->compile();
            RankSharing sharing(link);
            session = std::make_unique<SceneSession>(ours.scene, light, warnings, &sharing);
        }
    } catch (const UsageError& error) {
        problem = error.what();
        status = kUsageStatus;
    } catch (const std::exception& error) {
        problem = error.what();
        status = kFailureStatus;
    }
    if (recorder) (void)link.broadcast(problem.empty() ? '+' + recorder->take() : "");
    if (ours.replay) ours.replay->clear();
    std::vector<std::string> facts;
    if (session && problem.empty()) {
        facts = {"Lightwalk " LIGHTWALK_VERSION, "options: " + history};
        if (!shared)  // there is one copy
            for (const std::string& file : ours.scene->files().digests())
                facts.push_back("file " + file);
    }
    link.agree(facts, problem, status,
               by_rank_0
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
