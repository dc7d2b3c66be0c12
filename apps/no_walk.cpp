// In place of walk/ where the program is built without it (LIGHTWALK_WALK=OFF).
#include "apps/commands.h"
#include "io/options/option_words.h"

namespace lightwalk {

int run_walk(const std::vector<std::string>& /*words*/, Communicator* /*ranks*/) {
    throw UsageError("this program was built without the walk (LIGHTWALK_WALK=OFF)");
}

}  // namespace lightwalk
