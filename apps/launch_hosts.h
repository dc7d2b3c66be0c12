#pragma once
// The hosts that `launch` starts ranks on, and those that come back or are added while it runs.
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace lightwalk {

inline constexpr int kMostRanks = 1 << 16;

struct LaunchHost {
    std::string name;
    int slots = 1;
    bool operator==(const LaunchHost&) const = default;
};
using LaunchHosts = std::vector<LaunchHost>;

/// A host a line: NAME, or NAME slots=N. Throws InputError, with the line, for what is no host, and
/// where there is none.
[[nodiscard]] LaunchHosts read_launch_hosts(const std::string& file);

/// Those machines that are there: they take a connection to where ssh listens, or refuse it. All
/// are asked at once, for no longer than `patience`.
[[nodiscard]] LaunchHosts answering(const LaunchHosts& hosts, std::chrono::milliseconds patience);

/// Looks every few seconds, on a thread of its own, whether the file of hosts has changed, and
/// whether those of its hosts answer that are not in use.
class HostWatch {
  public:
    /// @param used  hosts on which ranks run
    HostWatch(std::string file, LaunchHosts used);
    ~HostWatch();
    HostWatch(const HostWatch&) = delete;
    HostWatch& operator=(const HostWatch&) = delete;

    /// The hosts to go on with, where these are other ones than those in use.
    [[nodiscard]] std::optional<LaunchHosts> better() const;
    /// @param pause  in which better() finds none
    void use(const LaunchHosts& hosts, std::chrono::milliseconds pause = {});

  private:
    void run();
    void read_file();
    [[nodiscard]] std::optional<LaunchHosts> look();

    const std::string file_;
    std::string text_;    ///< of the file, when it was last read; of the thread
    LaunchHosts wanted_;  ///< by the file; of the thread
    mutable std::mutex mutex_;
    std::condition_variable news_;
    LaunchHosts used_;
    std::optional<LaunchHosts> better_;
    std::chrono::steady_clock::time_point not_before_{};
    bool over_ = false;
    std::thread thread_;
};

}  // namespace lightwalk
