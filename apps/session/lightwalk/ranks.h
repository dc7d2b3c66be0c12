#pragma once
// A renderer's work shared by the processes ("ranks") that mpirun or srun started, on one machine
// or on many. Part of the public interface: no header of another library.
//
//   const auto communicator = lightwalk::open_mpi();
//   lightwalk::Ranks ranks(*communicator, {}, options);
//   ranks.run([&] {  // on every rank
//       lightwalk::Renderer renderer = ranks.open(source, options);
//       renderer.run([&] {  // on rank 0: the others and this one do what is started
//           lightwalk::save_picture("room.hdr", *renderer.finish(renderer.start(task)));
//       });
//   });
#include <functional>
#include <memory>
#include <string>

#include "apps/session/lightwalk/renderer.h"
#include "core/math/function_ref.h"
#include "parallel/comm/communicator.h"
#include "parallel/ranks/topology.h"

namespace lightwalk {

class FileSource;
class RankLink;
class ResidentScene;
class Scene;

/// Who reads a scene's files.
enum class SceneFrom {
    shared,  ///< one rank of each machine, whose memory the others share
    each,    ///< every rank its own copy of them
    rank0,   ///< rank 0 alone, for all
};

/// How the work is shared; the same on all ranks.
struct RankOptions {
    Variant variant = Variant::hybrid;  ///< ranks: each has one thread, whatever else is asked for
    int block = 0;           ///< side of the blocks that are handed out [pixels]; 0: auto
    int stride = 0;          ///< distance of blocks that follow each other, in blocks; 0: auto
    int masters = 0;         ///< that hand out blocks, rank 0 included; 0: auto
    int ambient_batch = 16;  ///< ambient values a message; 0: none are exchanged
    int projectors = 32;     ///< ranks that keep the points of a walk, at most
    SceneFrom scene_from = SceneFrom::shared;
    bool keep_spans = false;            ///< for timeline_json()
    std::string program = "lightwalk";  ///< how messages name it
    /// Told on one rank, before a run ends because a rank cannot go on: which one, and why.
    std::function<void(const std::string& message)> failed;
};

/// A scene to be rendered, and how.
struct RendererRequest {
    SceneSource source;
    RendererOptions options;
    std::string history;  ///< the command line, or whatever else must be the same on all ranks
    std::shared_ptr<FileSource> files;  ///< where the scene's files come from; null: the system
    std::function<void()> when_read;    ///< called before what was read is compiled; none: nobody
    /// Sets options that depend on the compiled scene, in every process alike; none: nobody.
    std::function<void(const Scene& scene, RendererOptions& options)> settle = nullptr;
    /// For this project's own programs: a scene that is there already, which a process that is
    /// alone takes where it is the one that is asked for; null: there is none.
    std::shared_ptr<const ResidentScene> resident = nullptr;
};

/// Whether mpirun or srun started this process.
[[nodiscard]] bool started_by_mpi();
/// The wire to the other ranks, for the thread that calls this; once in a process. Throws
/// InputError when MPI cannot be loaded or started.
[[nodiscard]] std::unique_ptr<Communicator> open_mpi();

/// Whether ranks that do such work gain from each other's ambient values.
[[nodiscard]] bool exchange_values(const RankOptions& options, const RendererOptions& work);

/// This process as one of the ranks.
class Ranks {
  public:
    /// Throws InputError for fewer ranks than it takes.
    /// @param communicator  must outlive this
    /// @param work          what the renderers are asked for
    Ranks(Communicator& communicator, const RankOptions& options, const RendererOptions& work);
    ~Ranks();
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    [[nodiscard]] int size() const;
    [[nodiscard]] bool leads() const;                       ///< whether this is rank 0
    [[nodiscard]] int threads() const { return threads_; }  ///< of this rank

    /// Runs `body` on another thread, while this one, which must be the one that opened the
    /// communicator, serves the messages until all ranks' bodies have returned. Where a body
    /// throws, the whole run ends, on all ranks, as it does when RendererOptions::stop is
    /// requested: the process does not return from here. But for what open() throws.
    void run(FunctionRef<void()> body);

    // Within body, by all ranks:

    /// Read and compile a scene. Where one rank cannot, or has read something else, all throw
    /// InputError; it says why on rank 0, and nothing on the others. One renderer at a time;
    /// Renderer::run() is called on every rank.
    [[nodiscard]] Renderer open(const RendererRequest& request);
    /// What rank 0 tells all, `said` there.
    [[nodiscard]] std::string tell(std::string said = {});

  private:
    RankOptions options_;
    int threads_;
    const StopFlag* stop_;
    std::unique_ptr<RankLink> link_;
};

/// With the threads of this process. Throws InputError.
[[nodiscard]] Renderer open_renderer(const RendererRequest& request);

}  // namespace lightwalk
