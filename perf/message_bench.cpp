// What a message costs between ranks of this machine: the parameters of the scaling model.
//   mpirun -n 2 message_bench > costs.json
// Two ranks and the transport of the program. L, o, g and G (LogGP) where both ranks look for
// messages all the time; then what sleeping between two looks, as RankLoop does, adds.
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "io/files/module.h"
#include "parallel/ranks/message.h"
#include "parallel/ranks/mpi_module.h"

namespace {

using namespace lightwalk;
using Clock = std::chrono::steady_clock;

constexpr int kRounds = 2000, kLongRounds = 40;
constexpr std::size_t kLong = 1 << 20;

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> list) {
    std::sort(list.begin(), list.end());
    return list[list.size() / 2];
}

std::unique_ptr<Transport> open_transport() {
    std::string error;
    const auto open =
        reinterpret_cast<OpenMpi>(load_from_module(kMpiModule, kOpenMpiSymbol, error));
    std::unique_ptr<Transport> transport;
    if (open != nullptr) transport.reset(open(nullptr, nullptr, error = {}));
    if (!transport) throw std::runtime_error("cannot start MPI: " + error);
    return transport;
}

std::string wait_for(Transport& transport) {
    while (true) {
        if (std::optional<Transport::Packet> packet = transport.receive()) return packet->bytes;
    }
}

/// Half of the time from one end to the other and back, the median of all rounds.
double half_round_trip(Transport& transport, std::size_t bytes, int rounds) {
    std::vector<double> times;
    for (int i = 0; i < rounds; ++i) {
        const Clock::time_point begin = Clock::now();
        if (transport.rank() == 0) {
            transport.send(1, std::string(bytes, 'x'));
            (void)wait_for(transport);
        } else {
            transport.send(0, wait_for(transport));
        }
        times.push_back(std::chrono::duration<double>(Clock::now() - begin).count() / 2);
    }
    transport.flush();
    return median(times);
}

/// Processor time a message where many follow each other: the sender's, and the receiver's [s].
std::pair<double, double> message_rate(Transport& transport) {
    const AskBlocks ask{1, {{{1, {0, 0, 8, 8}}, 1e-3}}};
    const Envelope envelope{{transport.rank(), Role::worker}, {1, Role::master}, ask};
    const double cpu = processor_seconds();
    if (transport.rank() == 0) {
        for (int i = 0; i < kRounds; ++i) transport.send(1, encode_message(envelope));
        const double sending = (processor_seconds() - cpu) / kRounds;
        transport.flush();
        return {sending, 1e-9 * std::stod(wait_for(transport))};
    }
    double receiving = 0;  // without the looks that find nothing
    for (int i = 0; i < kRounds;) {
        const double before = processor_seconds();
        const std::optional<Transport::Packet> packet = transport.receive();
        if (!packet) continue;
        (void)decode_message(packet->bytes, 0, 1);
        receiving += processor_seconds() - before;
        ++i;
    }
    transport.send(0, std::to_string(1e9 * receiving / kRounds));
    transport.flush();
    return {0, 0};
}

/// How much later than asked for a sleeper looks again, and the processor time of a look.
std::pair<double, double> sleeping(Transport& transport) {
    constexpr int kLooks = 500;
    constexpr std::chrono::microseconds kWait{200};
    std::vector<double> late;
    const double cpu = processor_seconds();
    for (int i = 0; i < kLooks; ++i) {
        const Clock::time_point begin = Clock::now();
        transport.wait(kWait);
        late.push_back(std::chrono::duration<double>(Clock::now() - begin - kWait).count());
        (void)transport.receive();
    }
    return {median(late), (processor_seconds() - cpu) / kLooks};
}

/// From a call of wake() until the waiting thread runs.
double waking(Transport& transport) {
    std::vector<double> times;
    for (int i = 0; i < 200; ++i) {
        Clock::time_point begin;
        std::thread waker([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            begin = Clock::now();
            transport.wake();
        });
        transport.wait(std::chrono::seconds(1));
        const Clock::time_point end = Clock::now();
        waker.join();
        times.push_back(std::chrono::duration<double>(end - begin).count());
    }
    return median(times);
}

}  // namespace

int main() {
    try {
        const std::unique_ptr<Transport> transport = open_transport();
        if (transport->size() != 2) throw std::runtime_error("message_bench wants two ranks");
        const double small = half_round_trip(*transport, 8, kRounds);
        const double large = half_round_trip(*transport, kLong, kLongRounds);
        const auto [sending, receiving] = message_rate(*transport);
        const auto [oversleep, look] = sleeping(*transport);
        const double woken = waking(*transport);
        if (transport->rank() != 0) return 0;
        const double overhead = (sending + receiving) / 2;
        const double byte = (large - small) / static_cast<double>(kLong);
        // A message of many bytes is copied at either end while it is on the wire: half of its
        // time is processors'.
        const nlohmann::ordered_json json{{"latency", std::max(0.0, small - 2 * overhead)},
                                          {"overhead", overhead},
                                          {"gap", sending},
                                          {"byte_gap", byte / 2},
                                          {"byte_work", byte / 4},
                                          {"oversleep", std::max(0.0, oversleep)},
                                          {"wake", woken},
                                          {"look", look}};
        std::printf("%s\n", json.dump(1).c_str());
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "message_bench: %s\n", error.what());
        return 1;
    }
}
