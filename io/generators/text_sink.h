#pragma once
// A stream of text in parts, for text that is too long to be held as a whole.
#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

namespace lightwalk {

/// The approximate length of parts: short enough for the processor's cache, long enough that their
/// number does not matter.
inline constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

/// Receives a text in parts, in order. Each part ends where a line and an item of the scene
/// language end.
class TextSink {
  public:
    virtual ~TextSink() = default;
    /// Receive a part, which is valid during the call only. Exceptions pass through the caller
    /// unchanged.
    virtual void push(std::string_view piece) = 0;
};

/// A sink that forwards parts to another sink, possibly later and on another thread.
class TextPipe : public TextSink {
  public:
    /// Wait until all parts have been forwarded. finish() and push() rethrow an exception of the
    /// other sink, which receives nothing after it.
    virtual void finish() = 0;
};

/// Makes a pipe to a sink, which must outlive it.
using MakeTextPipe = std::function<std::unique_ptr<TextPipe>(TextSink& next)>;

}  // namespace lightwalk
