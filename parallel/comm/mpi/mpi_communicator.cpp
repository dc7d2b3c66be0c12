// MPI as the wire between ranks: a module of its own, loaded by processes that mpirun started.
#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <list>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "parallel/comm/communicator.h"
#include "parallel/comm/mpi_module.h"

/// What Open MPI's MPI_Abort does once it has said so in eight lines, which would stand below the
/// one that tells what is wrong. Null: it is not there, or not Open MPI.
extern "C" __attribute__((weak)) int ompi_mpi_abort(MPI_Comm communicator, int status);

namespace lightwalk {
namespace {

constexpr int kTag = 1;

/// Errors are returned (MPI_ERRORS_RETURN) and raised here, where they have a text.
void check(int code, const char* what) {
    if (code == MPI_SUCCESS) return;
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    MPI_Error_string(code, text.data(), &length);
    throw std::runtime_error(std::string("message passing: ") + what + ": " + text.data());
}

/// Open MPI sends short messages over TCP at once. Longer ones wait until the receiver has asked
/// for them, which takes a round trip: between hosts that are far from each other more than all
/// else in a walk's frame. By default 64 kB are short, which a frame's parts are not. What the user
/// has set stays; other libraries do not know these names.
void send_frames_at_once() {
    constexpr const char* kShortBytes = "524288";
    constexpr int kKeep = 0;
    for (const char* const name :
         {"OMPI_MCA_btl_tcp_eager_limit", "OMPI_MCA_btl_tcp_rndv_eager_limit",
          "OMPI_MCA_btl_tcp_max_send_size"})
        (void)setenv(name, kShortBytes, kKeep);  // NOLINT(concurrency-mt-unsafe): before any thread
}

class MpiCommunicator final : public Communicator {
  public:
    MpiCommunicator(int* count, char*** words) {
        send_frames_at_once();
        int provided = 0;
        check(MPI_Init_thread(count, words, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
        check(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN),
              "MPI_Comm_set_errhandler");
        check(MPI_Comm_rank(MPI_COMM_WORLD, &rank_), "MPI_Comm_rank");
        check(MPI_Comm_size(MPI_COMM_WORLD, &size_), "MPI_Comm_size");
        MPI_Comm machine = MPI_COMM_NULL;
        check(MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine),
              "MPI_Comm_split_type");
        int here = 0, least = 0;
        check(MPI_Comm_size(machine, &here), "MPI_Comm_size");
        check(MPI_Allreduce(&here, &least, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD), "MPI_Allreduce");
        one_machine_ = least == size_;
        check(MPI_Allreduce(&rank_, &first_here_, 1, MPI_INT, MPI_MIN, machine), "MPI_Allreduce");
        check(MPI_Comm_free(&machine), "MPI_Comm_free");
    }
    ~MpiCommunicator() override { MPI_Finalize(); }

    [[nodiscard]] int rank() const override { return rank_; }
    [[nodiscard]] int size() const override { return size_; }
    [[nodiscard]] std::string host() const override {
        std::array<char, MPI_MAX_PROCESSOR_NAME> name{};
        int length = 0;
        check(MPI_Get_processor_name(name.data(), &length), "MPI_Get_processor_name");
        return {name.data(), static_cast<std::size_t>(length)};
    }

    [[nodiscard]] bool on_one_machine() const override { return one_machine_; }
    [[nodiscard]] int first_on_machine() const override { return first_here_; }

    void send(int to, std::string bytes) override {
        if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
            throw std::runtime_error("message passing: a message of more than 2 GB");
        Sent& sent = sent_.emplace_back();
        sent.bytes = std::move(bytes);
        check(MPI_Isend(sent.bytes.data(), static_cast<int>(sent.bytes.size()), MPI_BYTE, to, kTag,
                        MPI_COMM_WORLD, &sent.request),
              "MPI_Isend");
    }

    [[nodiscard]] std::optional<Packet> receive() override {
        let_go();
        int here = 0;
        MPI_Message message = MPI_MESSAGE_NULL;
        MPI_Status status{};
        // Open MPI first looks among what has been read from the network, and reads on only where
        // it finds nothing: what has come since the last look is found by the second question.
        for (int i = 0; i < 2 && here == 0; ++i) {
            check(MPI_Improbe(MPI_ANY_SOURCE, kTag, MPI_COMM_WORLD, &here, &message, &status),
                  "MPI_Improbe");
        }
        if (here == 0) return std::nullopt;
        int size = 0;
        check(MPI_Get_count(&status, MPI_BYTE, &size), "MPI_Get_count");
        Packet packet{status.MPI_SOURCE, std::string(static_cast<std::size_t>(size), '\0')};
        check(MPI_Mrecv(packet.bytes.data(), size, MPI_BYTE, &message, MPI_STATUS_IGNORE),
              "MPI_Mrecv");
        return packet;
    }

    /// MPI itself waits by asking again and again on a whole core; so it is asked after a sleep.
    void wait(std::chrono::microseconds most) override {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, most, [&] { return woken_; });
        woken_ = false;
    }

    void wake() override {
        {
            const std::lock_guard lock(mutex_);
            woken_ = true;
        }
        changed_.notify_one();
    }

    [[nodiscard]] std::string broadcast(std::string bytes, FunctionRef<void()> meanwhile) override {
        std::uint64_t size = bytes.size();
        spread(&size, sizeof size, meanwhile);
        bytes.resize(size);
        constexpr std::size_t kAtOnce = std::size_t{1} << 30;  // MPI counts with int
        for (std::size_t at = 0; at < bytes.size(); at += kAtOnce)
            spread(bytes.data() + at, std::min(kAtOnce, bytes.size() - at), meanwhile);
        return bytes;
    }

    void flush() override {
        for (Sent& sent : sent_) check(MPI_Wait(&sent.request, MPI_STATUS_IGNORE), "MPI_Wait");
        sent_.clear();
    }

    [[noreturn]] void abort(int status) override {
        if (ompi_mpi_abort != nullptr) ompi_mpi_abort(MPI_COMM_WORLD, status);
        MPI_Abort(MPI_COMM_WORLD, status);
        std::_Exit(status);
    }

  private:
    struct Sent {
        std::string bytes;
        MPI_Request request = MPI_REQUEST_NULL;
    };

    /// Asks now and then whether it has come: waiting inside MPI takes a whole core.
    void spread(void* data, std::size_t size, FunctionRef<void()> meanwhile) {
        constexpr std::chrono::microseconds kPatience{500};
        MPI_Request request = MPI_REQUEST_NULL;
        check(MPI_Ibcast(data, static_cast<int>(size), MPI_BYTE, 0, MPI_COMM_WORLD, &request),
              "MPI_Ibcast");
        for (int done = 0;;) {
            check(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
            if (done != 0) return;
            meanwhile();
            std::this_thread::sleep_for(kPatience);
        }
    }

    /// Forget what has left.
    void let_go() {
        for (auto sent = sent_.begin(); sent != sent_.end();) {
            int done = 0;
            check(MPI_Test(&sent->request, &done, MPI_STATUS_IGNORE), "MPI_Test");
            sent = done != 0 ? sent_.erase(sent) : std::next(sent);
        }
    }

    int rank_ = 0, size_ = 1;
    int first_here_ = 0;
    bool one_machine_ = true;
    std::list<Sent> sent_;  ///< the bytes must stay where they are
    std::mutex mutex_;      ///< guards woken_
    std::condition_variable changed_;
    bool woken_ = false;
};

}  // namespace
}  // namespace lightwalk

extern "C" lightwalk::Communicator* lightwalk_open_mpi(int* count, char*** words,
                                                       std::string& error) {
    try {
        return new lightwalk::MpiCommunicator(count, words);
    } catch (const std::exception& problem) {
        error = problem.what();
        return nullptr;
    }
}
