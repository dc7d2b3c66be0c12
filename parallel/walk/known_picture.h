#pragma once
// A picture that is known from elsewhere, for the points that it leaves.
#include <vector>

#include "core/view/pixels.h"
#include "core/view/view.h"
#include "parallel/comm/core_fields.h"

namespace lightwalk {

struct KnownPicture {
    View view;
    int width = 0, height = 0;            ///< [pixels]
    bool indirect = false;                ///< of what light frames are, see LiveFrames::begin
    std::vector<PixelValue> values = {};  ///< row by row from the bottom; distance 0: not known [m]
};
template <class Wire>
void visit_fields(Wire& wire, KnownPicture& known) {
    wire(known.view, known.width, known.height, known.indirect, known.values);
}

}  // namespace lightwalk
