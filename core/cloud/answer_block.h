#pragma once
// The pixels of a frame, answered from points: square by square, many of them side by side.
#include "core/cloud/cloud_frame.h"
#include "core/cloud/primary_visibility.h"
#include "core/cloud/region_points.h"
#include "core/cloud/trace_list.h"
#include "core/math/function_ref.h"

namespace lightwalk {

/// What the answers of a region's pixels depend on, and what they are written to.
struct RegionAnswers {
    const CloudOptions& options;
    const CloudRules& rules;
    PixelCaster& caster;  ///< its `probe` is called
    /// With CloudCheck::rotating: from then on no more rays check what points say.
    FunctionRef<bool()> is_late;
    int finest;  ///< see TraceList::finest_grid
    RegionPoints& points;
    CloudFrame& frame;
};

/// Find points for all pixels of a block of the region, and note in `found` which are to be traced.
/// Blocks of a region may be answered at the same time, each worker with its own number.
void answer_block(const RegionAnswers& region, const PixelRectangle& block, int worker,
                  BlockUncachedPixels& found);

}  // namespace lightwalk
