// What a message costs between ranks of this machine: the parameters of the scaling model.
//   mpirun -n 2 message_bench > costs.json
// Two ranks and the communicator of the program. L, o, g and G (LogGP) where both ranks look for
// messages all the time; then what sleeping between two looks, as RankLink does, adds.
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "io/files/module.h"
#include "parallel/comm/mpi_module.h"
#include "parallel/work_queue/message.h"

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

std::unique_ptr<Communicator> open_communicator() {
    std::string error;
    const auto open =
        reinterpret_cast<OpenMpi>(load_from_module(kMpiModule, kOpenMpiSymbol, error));
    std::unique_ptr<Communicator> communicator;
    if (open != nullptr) communicator.reset(open(nullptr, nullptr, error = {}));
    if (!communicator) throw std::runtime_error("cannot start MPI: " + error);
    return communicator;
}

std::string wait_for(Communicator& communicator) {
    while (true) {
        if (std::optional<Communicator::Packet> packet = communicator.receive())
            return packet->bytes;
    }
}

/// Half of the time from one end to the other and back, the median of all rounds.
double half_round_trip(Communicator& communicator, std::size_t bytes, int rounds) {
    std::vector<double> times;
    for (int i = 0; i < rounds; ++i) {
        const Clock::time_point begin = Clock::now();
        if (communicator.rank() == 0) {
            communicator.send(1, std::string(bytes, 'x'));
            (void)wait_for(communicator);
        } else {
            communicator.send(0, wait_for(communicator));
        }
        times.push_back(std::chrono::duration<double>(Clock::now() - begin).count() / 2);
    }
    communicator.flush();
    return median(times);
}

/// Processor time a message where many follow each other: the sender's, and the receiver's [s].
std::pair<double, double> message_rate(Communicator& communicator) {
    const WorkRequest request{1, {{FinishedWork::Payload::block, 1, 64, 1e-3}}};
    const double cpu = processor_seconds();
    if (communicator.rank() == 0) {
        for (int i = 0; i < kRounds; ++i) communicator.send(1, encode_message(request));
        const double sending = (processor_seconds() - cpu) / kRounds;
        communicator.flush();
        return {sending, 1e-9 * std::stod(wait_for(communicator))};
    }
    double receiving = 0;  // without the looks that find nothing
    for (int i = 0; i < kRounds;) {
        const double before = processor_seconds();
        const std::optional<Communicator::Packet> packet = communicator.receive();
        if (!packet) continue;
        (void)decode_message(packet->bytes);
        receiving += processor_seconds() - before;
        ++i;
    }
    communicator.send(0, std::to_string(1e9 * receiving / kRounds));
    communicator.flush();
    return {0, 0};
}

/// How much later than asked for a sleeper looks again, and the processor time of a look.
std::pair<double, double> sleeping(Communicator& communicator) {
    constexpr int kLooks = 500;
    constexpr std::chrono::microseconds kWait{200};
    std::vector<double> late;
    const double cpu = processor_seconds();
    for (int i = 0; i < kLooks; ++i) {
        const Clock::time_point begin = Clock::now();
        communicator.wait(kWait);
        late.push_back(std::chrono::duration<double>(Clock::now() - begin - kWait).count());
        (void)communicator.receive();
    }
    return {median(late), (processor_seconds() - cpu) / kLooks};
}

/// From a call of wake() until the waiting thread runs.
double waking(Communicator& communicator) {
    std::vector<double> times;
    for (int i = 0; i < 200; ++i) {
        Clock::time_point begin;
        std::thread waker([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            begin = Clock::now();
            communicator.wake();
        });
        communicator.wait(std::chrono::seconds(1));
        const Clock::time_point end = Clock::now();
        waker.join();
        times.push_back(std::chrono::duration<double>(end - begin).count());
    }
    return median(times);
}

}  // namespace

int main() {
    try {
        const std::unique_ptr<Communicator> communicator = open_communicator();
        if (communicator->size() != 2) throw std::runtime_error("message_bench wants two ranks");
        const double small = half_round_trip(*communicator, 8, kRounds);
        const double large = half_round_trip(*communicator, kLong, kLongRounds);
        const auto [sending, receiving] = message_rate(*communicator);
        const auto [oversleep, look] = sleeping(*communicator);
        const double woken = waking(*communicator);
        if (communicator->rank() != 0) return 0;
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
