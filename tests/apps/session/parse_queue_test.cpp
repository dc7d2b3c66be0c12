// Writing and reading side by side: the same pieces in the same order, and the first error counts.
#include "apps/session/parse_queue.h"

#include <doctest/doctest.h>

#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace lightwalk;

namespace {

/// Keeps what it gets; throws at the piece that says so.
class Collector final : public TextSink {
  public:
    explicit Collector(bool slow = false) : slow_(slow) {}
    void push(std::string_view piece) override {
        if (slow_) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        if (piece.starts_with("bad")) throw std::runtime_error(std::string(piece.substr(0, 4)));
        text += piece;
        threads.push_back(std::this_thread::get_id());
    }
    std::string text;
    std::vector<std::thread::id> threads;

  private:
    bool slow_;
};

std::string long_piece(const std::string& beginning) {
    std::string piece = beginning;
    piece.resize(kPieceBytes, '.');
    return piece;
}

}  // namespace

TEST_CASE("a pipe hands its pieces on in order, long ones on another thread") {
    for (const bool slow : {false, true}) {
        Collector checkpoint(slow);
        std::string expected;
        ParseQueue pipe(checkpoint);
        for (int i = 0; i < 20; ++i) {
            const std::string piece = i == 19 ? "end" : long_piece(std::to_string(i));
            pipe.push(piece);
            expected += piece;
        }
        pipe.finish();
        CHECK(checkpoint.text == expected);
        for (const std::thread::id id : checkpoint.threads) CHECK(id != std::this_thread::get_id());
    }
}

TEST_CASE("short texts, and those that are whole, go straight through") {
    Collector checkpoint;
    for (const std::string& text :
         {std::string("a few words"), std::string(3 * kPieceBytes, 'x')}) {
        ParseQueue pipe(checkpoint);
        pipe.push(text);
        pipe.finish();
    }
    REQUIRE(checkpoint.threads.size() == 2);
    for (const std::thread::id id : checkpoint.threads) CHECK(id == std::this_thread::get_id());
}

TEST_CASE("what the reader throws ends the writer, and is told once all is quiet") {
    Collector checkpoint(true);
    ParseQueue pipe(checkpoint);
    const auto write = [&] {
        pipe.push(long_piece("good"));
        pipe.push(long_piece("bad1"));
        for (int i = 0; i < 1000; ++i) pipe.push(long_piece("bad2"));
    };
    CHECK_THROWS_WITH_AS(write(), "bad1", std::runtime_error);
    CHECK_THROWS_WITH_AS(pipe.finish(), "bad1", std::runtime_error);
    CHECK(checkpoint.text.substr(0, 4) == "good");
    CHECK(checkpoint.threads.size() == 1);
}

TEST_CASE("a pipe that nobody finishes ends by itself") {
    Collector checkpoint(true);
    {
        ParseQueue pipe(checkpoint);
        for (int i = 0; i < 3; ++i) pipe.push(long_piece("x"));
    }
    CHECK(checkpoint.threads.size() <= 3);
}
