#pragma once
// Where text goes that is too long to be held whole.
#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

namespace lightwalk {

/// About how long the pieces are: short enough for the processor's cache, long enough that their
/// number does not matter.
inline constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

/// Takes a text by pieces, in order. Each ends where a line and an item of the scene language end.
class TextSink {
  public:
    virtual ~TextSink() = default;
    /// `piece` is the caller's again afterwards. What this throws goes through the caller
    /// unchanged.
    virtual void push(std::string_view piece) = 0;
};

/// Hands pieces on to another sink, perhaps later.
class TextPipe : public TextSink {
  public:
    /// Returns when all pieces are handed on. Throws what the other sink has thrown, as push()
    /// does for an earlier piece; it gets nothing more then.
    virtual void finish() = 0;
};

/// Makes a pipe to a sink, which must outlive it.
using MakeTextPipe = std::function<std::unique_ptr<TextPipe>(TextSink& next)>;

}  // namespace lightwalk
