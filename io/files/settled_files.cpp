#include "io/files/settled_files.h"

namespace lightwalk {

bool SettledFiles::are_to_be_read(const FileStates& now, Clock::time_point time) {
    if (now == read_) {
        changing_ = false;
        last_ = now;
        return false;
    }
    if (!changing_) begun_ = time;
    if (!changing_ || now != last_) changed_ = time;
    changing_ = true;
    last_ = now;
    return time - changed_ >= kQuiet || time - begun_ >= kLongest;
}

}  // namespace lightwalk
