#pragma once
// How commands begin, lead and end on several ranks.
#include <memory>
#include <string>

#include "apps/common_options.h"
#include "apps/rank_link.h"
#include "apps/session/scene_session.h"
#include "core/math/function_ref.h"

namespace lightwalk {

/// What a command shares out.
struct SharedWork {
    bool ambient_values = false;  ///< ranks gain from each other's
    bool rays = false;            ///< chunks of rays, not blocks of pictures
    int projectors = 0;           ///< frames of a walk, drawn from points: see RankSettings
};

/// Understands the command line: rank 0 first, by the files, environment and standard input it has;
/// then the others, by what rank 0 has read of these. `parse` throws UsageError or InputError for
/// what is wrong; when that is so on rank 0, the others throw the same without a text, and when on
/// another, it says so and ends the run.
/// @param communicator  null: this process is alone
void parse_on_ranks(Communicator* communicator, const std::string& program,
                    FunctionRef<void(const std::shared_ptr<FileSource>&)> parse);

/// The link to the other ranks; null where there are none to share with. In variant `ranks` each
/// has one thread, as `options` then say.
[[nodiscard]] std::unique_ptr<RankLink> link_ranks(Communicator* communicator,
                                                   CommonOptions& options, const SharedWork& work);

/// Every rank reads and builds the scene, from its own files or from what rank 0 has read
/// (--scene-from); all go on, or none: throws AgreedProblem.
/// @param history  the options, which must be the same everywhere
/// @param base     where rank 0, or each rank, finds its files
[[nodiscard]] std::unique_ptr<SceneSession> build_on_ranks(
    RankLink& link, const SceneSource& source, SceneFrom from, const LightSettings& light,
    const std::string& history, WarningSink& warnings, std::shared_ptr<FileSource> base);

/// On rank 0: `work`, while another thread runs `trace` where this rank traces. `trace` must end
/// after work's RankLink::finish. An exception of either ends the whole run.
void lead_ranks(RankLink& link, FunctionRef<void()> trace, FunctionRef<void()> work);

}  // namespace lightwalk
