#include "apps/session/rank_scene.h"

#include <cstdint>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/files/mapped_file.h"
#include "parallel/comm/wire.h"

namespace lightwalk {

/// What rank 0 tells the others of the scene that it has read for all.
struct ToldScene {
    bool good = false;
    std::string recording;     ///< of FileRecorder
    bool frozen = false;       ///< the first of its files is a frozen scene
    std::uint64_t digest = 0;  ///< of that
};
/// Of a rank, as far as a frozen scene of rank 0 goes.
struct FrozenNeed {
    int machine = 0;  ///< its first rank
    bool lacks = false;
};
template <class Wire>
void visit_fields(Wire& wire, ToldScene& told) {
    wire(told.good, told.recording, told.frozen, told.digest);
}
template <class Wire>
void visit_fields(Wire& wire, FrozenNeed& need) {
    wire(need.machine, need.lacks);
}

namespace {

/// What the first rank of a machine says of the scene, before more about it; nothing: it could not
/// read it.
constexpr char kEachItsOwn = 'e', kShared = 's';

/// Of a file's bytes that stay for a scene that changes.
constexpr std::size_t kLargestKept = std::size_t{1} << 18;

using ScenePtr = std::shared_ptr<CompiledScene>;

std::shared_ptr<FileSource> files_of(const RendererRequest& request) {
    return request.files ? request.files : real_files();
}

/// Not yet compiled.
ScenePtr read_by(const RendererRequest& request, std::shared_ptr<FileRecorder> files,
                 const std::string& shared_by = {}) {
    ScenePtr scene =
        read_compiled_scene(request.source, request.options.warn, std::move(files), shared_by);
    if (request.when_read) request.when_read();
    return scene;
}

/// The first rank of a machine reads for the others.
ScenePtr read_for_machine(RankLink& link, const RendererRequest& request) {
    ScenePtr scene;
    std::string word;
    std::exception_ptr problem;
    try {
        scene = read_by(request, std::make_shared<FileRecorder>(files_of(request)));
        const std::string path = scene->is_frozen() ? std::string() : scene->share();
        word = path.empty() ? std::string(1, kEachItsOwn) : kShared + path;
    } catch (const std::exception&) {
        problem = std::current_exception();
    }
    (void)link.all_gather(Collective::Group::all, word);
    if (problem) std::rethrow_exception(problem);
    scene->compile();  // as the others do at the same time
    return scene;
}

ScenePtr follow_on_machine(RankLink& link, const RendererRequest& request) {
    const std::vector<std::string> words = link.all_gather(Collective::Group::all, {});
    const std::string& word = words[static_cast<std::size_t>(link.first_on_machine())];
    if (word.empty()) return nullptr;
    ScenePtr scene;
    if (word[0] == kShared) {
        try {
            scene = read_by(request, std::make_shared<FileRecorder>(), word.substr(1));
        } catch (const InputError&) {  // the system lets no process look at another's
        }
    }
    if (!scene) return read_own_scene(request);
    scene->compile();
    return scene;
}

/// Whether there is no such frozen scene, or the system lets no process look at another's memory.
bool lacks_frozen(const std::string& path, std::uint64_t digest) {
    try {
        return open_frozen_scene(path, true)->file().digest() != digest;
    } catch (const InputError&) {
        return true;
    }
}

/// Nothing: it cannot be read, which others will say.
std::string bytes_of(const std::string& path) {
    try {
        const MappedFile file(path);
        const auto* const bytes = reinterpret_cast<const char*>(file.bytes().data());
        return {bytes, file.bytes().size()};
    } catch (const InputError&) {
        return {};
    }
}

/// Its path; "": there is no such memory.
std::string keep_in_memory(std::string_view bytes, std::shared_ptr<const MemoryFile>& kept) {
    try {
        kept = std::make_shared<const MemoryFile>(std::span(&bytes, 1));
        return kept->path();
    } catch (const InputError&) {
        return {};
    }
}

/// By all ranks, where rank 0's scene is frozen: the path by which this rank maps it.
std::string find_frozen(RankLink& link, const std::string& own, std::uint64_t digest,
                        std::shared_ptr<const MemoryFile>& kept) {
    const FrozenNeed need{link.first_on_machine(), lacks_frozen(own, digest)};
    std::vector<int> sharers(static_cast<std::size_t>(link.ranks()), -1);  // by machine
    bool all_have = true;
    int rank = 0;
    for (const std::string& bytes : link.all_gather(Collective::Group::all, wire::encode(need))) {
        const auto other = wire::decode<FrozenNeed>(bytes);
        int& sharer = sharers.at(static_cast<std::size_t>(other.machine));
        if (other.lacks && sharer < 0) sharer = rank;
        all_have = all_have && !other.lacks;
        ++rank;
    }
    if (all_have) return own;
    const std::string bytes = link.broadcast(link.leads() ? bytes_of(own) : std::string());
    const int sharer = sharers[static_cast<std::size_t>(need.machine)];
    std::string path;
    if (need.lacks && sharer == link.rank()) path = keep_in_memory(bytes, kept);
    const std::vector<std::string> paths = link.all_gather(Collective::Group::all, path);
    if (!need.lacks) return own;
    path = paths[static_cast<std::size_t>(sharer)];
    if (lacks_frozen(path, digest)) path = keep_in_memory(bytes, kept);
    return path;
}

/// Rank 0 reads for all.
RankScene read_for_all(RankLink& link, const RendererRequest& request) {
    RankScene result;
    ToldScene told;
    std::exception_ptr problem;
    try {
        const auto recorder = std::make_shared<FileRecorder>(files_of(request), true);
        result.scene = read_by(request, recorder);
        result.scene->compile();  // which reads more
        told = {true, recorder->take(), result.scene->frozen() != nullptr, 0};
        if (told.frozen) told.digest = result.scene->frozen()->file().digest();
    } catch (const std::exception&) {
        problem = std::current_exception();
    }
    (void)link.broadcast(wire::encode(told));
    if (problem) std::rethrow_exception(problem);
    if (told.frozen)
        (void)find_frozen(link, request.source.files.front(), told.digest, result.kept);
    return result;
}

RankScene follow_rank0(RankLink& link, const RendererRequest& request) {
    RankScene result;
    const auto told = wire::decode<ToldScene>(link.broadcast({}));
    if (!told.good) return result;
    const auto replay = std::make_shared<FileReplay>(told.recording);
    if (told.frozen) {
        const std::string& own = request.source.files.front();
        replay->move_to(own, find_frozen(link, own, told.digest, result.kept));
    }
    result.scene = read_by(request, std::make_shared<FileRecorder>(replay));
    result.scene->compile();
    // A scene that changes may ask once more for what nobody keeps, as function files.
    replay->clear(request.options.steered ? kLargestKept : 0);
    return result;
}

}  // namespace

ScenePtr read_own_scene(const RendererRequest& request) {
    ScenePtr scene = read_by(request, std::make_shared<FileRecorder>(files_of(request)));
    scene->compile();
    return scene;
}

RankScene read_on_ranks(RankLink& link, const RendererRequest& wanted, SceneFrom from) {
    RendererRequest request = wanted;
    // Whether a frozen scene is older than its sources is for rank 0 to say: others need not see
    // them, and all have the same one.
    if (!link.leads()) request.source.allow_stale = true;
    if (from == SceneFrom::rank0)
        return link.leads() ? read_for_all(link, request) : follow_rank0(link, request);
    if (from == SceneFrom::each || link.ranks() == 1) return {read_own_scene(request), nullptr};
    return {link.first_on_machine() == link.rank() ? read_for_machine(link, request)
                                                   : follow_on_machine(link, request),
            nullptr};
}

}  // namespace lightwalk
