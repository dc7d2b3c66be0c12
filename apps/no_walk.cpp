// In place of walk/ where the program is built without it (LIGHTWALK_WALK=OFF).
#include "apps/commands.h"
#include "apps/head/walk_head.h"
#include "io/options/option_words.h"

namespace lightwalk {

namespace {

[[noreturn]] void refuse() {
    throw UsageError("this program was built without the walk (LIGHTWALK_WALK=OFF)");
}

}  // namespace

int run_walk(const std::vector<std::string>& /*words*/, Communicator* /*ranks*/) {
    refuse();
}

class WalkHead::Core {};

WalkHead::WalkHead(const WebServerOptions& /*options*/, const std::string& /*why*/) {
    refuse();
}

WalkHead::~WalkHead() = default;

std::string WalkHead::url() const {
    return {};
}

void WalkHead::begin_run(const std::string& /*host*/, std::uint16_t /*port*/,
                         const std::string& /*token*/) {}

void WalkHead::end_run(const std::string& /*why*/) {}

std::chrono::duration<double> WalkHead::quiet() const {
    return {};
}

bool WalkHead::failed() const {
    return false;
}

}  // namespace lightwalk
