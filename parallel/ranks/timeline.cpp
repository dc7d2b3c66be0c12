#include "parallel/ranks/timeline.h"

namespace lightwalk {

const char* activity_name(Activity activity) {
    static constexpr std::array<const char*, kActivities> kNames{
        "trace",    "wait for blocks",         "send results",
        "compress", "exchange ambient values", "serve messages"};
    return kNames[static_cast<std::size_t>(activity)];
}

}  // namespace lightwalk
