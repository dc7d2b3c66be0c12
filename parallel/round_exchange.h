#pragma once
// Communication of processes that fill the same ambient cache in rounds.
#include <string>
#include <utility>
#include <vector>

namespace lightwalk {

/// A group of processes that execute the same rounds: each computes its share of a round, and all
/// get all results.
class RoundExchange {
  public:
    RoundExchange() = default;
    virtual ~RoundExchange() = default;
    RoundExchange(const RoundExchange&) = delete;
    RoundExchange& operator=(const RoundExchange&) = delete;

    [[nodiscard]] virtual int index() const = 0;  ///< index of this process, 0 ... count() - 1
    [[nodiscard]] virtual int count() const = 0;
    /// All-gather: every process contributes bytes and gets those of all, in the order of their
    /// indices. A barrier: waits for the slowest.
    [[nodiscard]] virtual std::vector<std::string> all_gather(std::string mine) = 0;

    /// Whether part i of the work belongs to this process.
    [[nodiscard]] bool does(std::size_t i) const {
        return i % static_cast<std::size_t>(count()) == static_cast<std::size_t>(index());
    }
};

/// A group of one process.
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
