#include "parallel/shared_blocks.h"

#include <algorithm>
#include <cassert>

namespace lightwalk {

SharedBlocks::SharedBlocks(std::span<const Block> blocks, int side, int workers)
    : own_(static_cast<std::size_t>(workers)) {
    for (const Block& block : blocks) add(block, side);
}

void SharedBlocks::add(const Block& block, int side) {
    const std::size_t first = places_.size();
    for (int y0 = block.y0; y0 < block.y1; y0 += side) {
        for (int x0 = block.x0; x0 < block.x1; x0 += side) {
            for (int y = std::min(y0 + side, block.y1); y-- > y0;) {  // from the top
                for (int x = x0; x < std::min(x0 + side, block.x1); ++x) places_.push_back({x, y});
            }
        }
    }
    parts_.push_back({first, places_.size()});
}

PixelPlace SharedBlocks::next(int worker) {
    const std::lock_guard lock(mutex_);
    Part*& own = own_[static_cast<std::size_t>(worker)];
    if ((!own || own->left() == 0) && begun_ < parts_.size()) own = &parts_[begun_++];
    if (own && own->left() > 0) return places_[own->first++];
    Part& most = *std::max_element(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
        return a.left() < b.left();
    });
    assert(most.left() > 0);
    return places_[--most.last];
}

}  // namespace lightwalk
