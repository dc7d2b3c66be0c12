#include "core/model/surface_keys.h"

#include <algorithm>

namespace lightwalk {

std::uint32_t SurfaceKeys::find(std::int32_t id) const {
    const auto next = std::ranges::upper_bound(pieces_, id, {}, &Piece::first);
    const Piece& piece = *(next - 1);  // the first one begins at 0
    return piece.key + static_cast<std::uint32_t>(id - piece.first);
}

void SurfaceKeys::add(Piece piece) {
    if (!pieces_.empty() && pieces_.back().first == piece.first) pieces_.pop_back();
    pieces_.push_back(piece);
}

SurfaceKeys SurfaceKeys::replaced(std::size_t first, std::size_t gone, std::size_t come) const {
    const auto begin = static_cast<std::int32_t>(first);
    const auto end = static_cast<std::int32_t>(first + gone);
    const auto shift = static_cast<std::int32_t>(come) - static_cast<std::int32_t>(gone);
    SurfaceKeys after;
    after.next_ = next_ + static_cast<std::uint32_t>(come);
    if (pieces_.empty()) after.add({0, 0});
    for (const Piece& piece : pieces_)
        if (piece.first < begin) after.add(piece);
    if (come > 0) after.add({begin, next_});
    after.add({end + shift, (*this)(end)});
    for (const Piece& piece : pieces_)
        if (piece.first > end) after.add({piece.first + shift, piece.key});
    return after;
}

}  // namespace lightwalk
