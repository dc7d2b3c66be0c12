#pragma once
// How the ranks of a run come to its scene.
#include <memory>

#include "apps/session/compiled_scene.h"
#include "apps/session/lightwalk/ranks.h"
#include "io/files/memory_file.h"
#include "parallel/ranks/rank_link.h"

namespace lightwalk {

/// A rank's scene, after compile().
struct RankScene {
    std::shared_ptr<CompiledScene>
        scene;  ///< null: another rank, which says why, could not read it
    /// What this rank keeps for others of its machine until all have their scenes; null: nothing.
    std::shared_ptr<const MemoryFile> kept;
};

/// By all ranks. Throws InputError.
/// - `each`: every rank reads its own files.
/// - `shared`: of each machine the first rank does, and the others map its memory, where the system
///   lets them; a frozen scene every rank maps itself.
/// - `rank0`: rank 0 reads for all, and the others repeat that from a recording. Ranks that have
/// not
///   the same frozen scene get it from rank 0, once a machine.
[[nodiscard]] RankScene read_on_ranks(RankLink& link, const RendererRequest& request,
                                      SceneFrom from);

/// This process's own files, compiled.
[[nodiscard]] std::shared_ptr<CompiledScene> read_own_scene(const RendererRequest& request);

}  // namespace lightwalk
