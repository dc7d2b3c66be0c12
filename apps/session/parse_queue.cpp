#include "apps/session/parse_queue.h"

#include <string>

namespace lightwalk {
namespace {

constexpr std::size_t kShort = kPieceBytes / 2, kLong = 2 * kPieceBytes;

}  // namespace

void ParseQueue::push(std::string_view piece) {
    const bool has_begun = under_way_.valid() || error_;
    if (!has_begun && (piece.size() < kShort || piece.size() > kLong)) return next_.push(piece);
    finish();
    under_way_ =
        std::async(std::launch::async, [this, text = std::string(piece)] { next_.push(text); });
}

void ParseQueue::finish() {
    try {
        if (under_way_.valid()) under_way_.get();
    } catch (...) {
        error_ = std::current_exception();
    }
    if (error_) std::rethrow_exception(error_);
}

}  // namespace lightwalk
