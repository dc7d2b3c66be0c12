#pragma once
// How pictures are sampled.

namespace lightwalk {

/// How a pixel weighs the samples that it shares with its neighbours, see pixel_filter().
enum class PixelFilter {
    gaussian,  ///< of .6 pixels: no negative weights
    mitchell,  ///< sharper, with negative ones
};

/// Options of the sampling of pixels, with names and defaults of rpict.
struct PixelOptions {
    int samples = 1;  ///< --samples: rays a pixel; what more than 1 count is the pixel's filter's
    bool share_samples = true;  ///< where pixels have several of them, with their neighbours
    PixelFilter filter = PixelFilter::gaussian;  ///< of these; pixels' own have the Gaussian
    int spacing = 4;  ///< -ps: distance of the pixels that are traced in any case, 1 ... 16
    double threshold =
        0.05;              ///< -pt: relative difference beyond which pixels in between are traced
    double jitter = 0.67;  ///< -pj: share of the pixel over which its ray is spread
    double aperture = 0;   ///< -pd: diameter of the lens [m]
    double motion = 0;     ///< -pm: share of the time between two frames that the shutter is open
};

/// How long samples are added to a picture, see parallel/adaptive_picture.h.
struct SampleGoal {
    double error = 0;    ///< relative, of luminance, that 95 % of the pixels are within; 0: any
    double seconds = 0;  ///< that the picture may take; 0: no limit
    [[nodiscard]] bool given() const { return error > 0 || seconds > 0; }
};

}  // namespace lightwalk
