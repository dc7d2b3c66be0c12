#pragma once
// Lets who writes a long text and who reads it work side by side.
#include <exception>
#include <future>
#include <string_view>

#include "io/generators/text_sink.h"

namespace lightwalk {

/// Hands pieces on to another sink, in order, each on a thread of its own while the next one is
/// written: from the first long piece on, as few texts have any.
class ParseQueue final : public TextPipe {
  public:
    explicit ParseQueue(TextSink& next) : next_(next) {}

    /// Waits until the piece before is handed on. Throws what the next sink has thrown for an
    /// earlier piece.
    void push(std::string_view piece) override;
    void finish() override;

  private:
    TextSink& next_;
    std::exception_ptr error_;     ///< of the next sink: it gets nothing more
    std::future<void> under_way_;  ///< the last piece; its end is waited for, also when destroyed
};

}  // namespace lightwalk
