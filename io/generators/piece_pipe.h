#pragma once
// Lets who writes a long text and who reads it work side by side.
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "io/generators/text_sink.h"

namespace lightwalk {

/// Hands pieces on to another sink, in order, on a thread of its own: begun with the first long
/// piece, as few texts have any. At most four pieces wait.
class PiecePipe final : public TextSink {
  public:
    /// @param side_by_side  false: each piece is handed on at once, by who brings it
    PiecePipe(TextSink& next, bool side_by_side) : next_(next), side_by_side_(side_by_side) {}
    /// What was not handed on yet is lost, if finish() was not called.
    ~PiecePipe() override;
    PiecePipe(const PiecePipe&) = delete;
    PiecePipe& operator=(const PiecePipe&) = delete;

    /// Throws what the next sink has thrown for an earlier piece.
    void take(std::string_view piece) override;
    /// Returns when all pieces are handed on; throws as take().
    void finish();

  private:
    void hand_on();
    void close();
    void throw_error();

    TextSink& next_;
    bool side_by_side_;
    std::thread thread_;
    std::mutex mutex_;
    std::condition_variable changed_;
    // Under the mutex:
    std::deque<std::string> waiting_;
    bool closed_ = false, stopped_ = false;
    std::exception_ptr error_;  ///< of the next sink: it gets nothing more
};

}  // namespace lightwalk
