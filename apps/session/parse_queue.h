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
class ParseQueue final : public TextPipe {
  public:
    explicit ParseQueue(TextSink& next) : next_(next) {}
    /// What was not handed on yet is lost, if finish() was not called.
    ~ParseQueue() override;
    ParseQueue(const ParseQueue&) = delete;
    ParseQueue& operator=(const ParseQueue&) = delete;

    /// Throws what the next sink has thrown for an earlier piece.
    void push(std::string_view piece) override;
    void finish() override;

  private:
    void hand_on();
    void close();
    void throw_error();

    TextSink& next_;
    std::thread thread_;
    std::mutex mutex_;
    std::condition_variable changed_;
    // Under the mutex:
    std::deque<std::string> waiting_;
    bool closed_ = false, stopped_ = false;
    std::exception_ptr error_;  ///< of the next sink: it gets nothing more
};

}  // namespace lightwalk
