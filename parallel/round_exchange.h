#pragma once
// What processes that fill the same ambient cache in rounds have to say to each other.
#include <string>
#include <utility>
#include <vector>

namespace lightwalk {

/// Processes that do the same rounds: each does its share of the work of a round, and all get what
/// all have found.
class RoundExchange {
  public:
    RoundExchange() = default;
    virtual ~RoundExchange() = default;
    RoundExchange(const RoundExchange&) = delete;
    RoundExchange& operator=(const RoundExchange&) = delete;

    [[nodiscard]] virtual int index() const = 0;  ///< of this process, 0 ... count() - 1
    [[nodiscard]] virtual int count() const = 0;
    /// Every process gives bytes and gets everyone's, in the order of their indices; waits for the
    /// slowest.
    [[nodiscard]] virtual std::vector<std::string> all_gather(std::string mine) = 0;

    /// Whether this process does the i-th part of the work.
    [[nodiscard]] bool does(std::size_t i) const {
        return i % static_cast<std::size_t>(count()) == static_cast<std::size_t>(index());
    }
};

/// One process by itself.
class NoExchange final : public RoundExchange {
  public:
    [[nodiscard]] int index() const override { return 0; }
    [[nodiscard]] int count() const override { return 1; }
    [[nodiscard]] std::vector<std::string> all_gather(std::string mine) override {
        std::vector<std::string> all;
        all.push_back(std::move(mine));
        return all;
    }
};

}  // namespace lightwalk
