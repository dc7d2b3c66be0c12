#pragma once
// How many messages a rank sent, and of how many bytes, by kind.
#include <array>
#include <cstdint>

#include "parallel/work_queue/message.h"

namespace lightwalk {

struct MessageCounts {
    std::array<std::uint64_t, kMessageKinds> messages{}, bytes{};
    void add(const Message& message, std::size_t size) {
        ++messages[message.index()];
        bytes[message.index()] += size;
    }
};

}  // namespace lightwalk
