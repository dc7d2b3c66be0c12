#pragma once
// How pictures are sampled.

namespace lightwalk {

/// Options of the sampling of pixels, with names and defaults of rpict.
struct PixelOptions {
    int samples = 1;  ///< --samples: rays a pixel; what more than 1 count is the pixel's filter's
    int spacing = 4;  ///< -ps: distance of the pixels that are traced in any case, 1 ... 16
    double threshold =
        0.05;              ///< -pt: relative difference beyond which pixels in between are traced
    double jitter = 0.67;  ///< -pj: share of the pixel over which its ray is spread
    double aperture = 0;   ///< -pd: diameter of the lens [m]
    double motion = 0;     ///< -pm: share of the time between two frames that the shutter is open
};

}  // namespace lightwalk
