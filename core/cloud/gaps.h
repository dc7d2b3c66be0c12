#pragma once
// Filling of pixels that were not traced in time, from the pixels around them.
#include <cstdint>
#include <span>

#include "core/math/rgb.h"
#include "core/math/task_runner.h"

namespace lightwalk {

/// Fill the unknown pixels of a picture: means of ever larger neighbourhoods are taken until one
/// holds a known pixel, and spread back by bilinear interpolation. Smooth, and linear in the number
/// of pixels however large the gaps are. Known pixels stay as they are; a picture without any is
/// left alone.
/// @param radiance  width x height pixels, row by row
/// @param known     for each pixel: not 0 where it is known
/// Source: Gortler et al., "The Lumigraph", SIGGRAPH 1996, section 3.4 (pull-push).
void fill_gaps(int width, int height, std::span<Rgb> radiance, std::span<const std::uint8_t> known,
               const TaskRunner& task_runner = SerialTaskRunner());

}  // namespace lightwalk
