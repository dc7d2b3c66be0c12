#pragma once
// A picture whose samples go where its error is, until that is small enough or time is up.
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/math/function_ref.h"
#include "core/view/pixel_options.h"
#include "parallel/frame.h"
#include "parallel/tile_mask.h"

namespace lightwalk {

/// One more picture of some tiles, to be traced with random numbers of its own.
struct SamplePass {
    std::uint64_t seed = 0;
    int samples = 0;  ///< rays a pixel, a power of two where the first pass's is one
    TileMask tiles;
};

/// Adds up passes over a picture, estimates its error from them, and says what to trace next.
///
/// Passes come in pairs, which fill two half-buffers of as many samples each (Rousselle, Knaus &
/// Zwicker, "Adaptive rendering with non-local means filtering", ACM Transactions on Graphics
/// 31(6), 2012): their halved difference is distributed as the error of their mean, which is the
/// picture. Its ratio to the pixel's luminance is the pixel's error; pixels darker than a hundredth
/// of the picture's mean are told in relation to that. The mean of these errors over a tile says
/// where samples are worth most: they are shared out in proportion to the standard deviation of
/// one, for the least sum of squared errors. What no sample has met is not in the estimate, nor is
/// the error of indirect light that is interpolated between cached values.
///
/// The passes, and so the picture, depend on what is added and on the goal's error alone; with a
/// limit of time on the times that are said, too. For one thread.
class AdaptivePicture {
  public:
    static constexpr double kShare = 0.95;     ///< of the pixels, that are to be within the error
    static constexpr int kMostSamples = 4096;  ///< of a pixel: with them it gets no more

    /// @param samples  rays a pixel of the first pair; at least 4 are traced
    /// @param seed     of the first pass
    AdaptivePicture(int width, int height, int samples, std::uint64_t seed, const SampleGoal& goal);

    /// The next pass; nothing: the picture is finished. Each is to be added before the next.
    /// @param seconds  since the picture was begun
    [[nodiscard]] std::optional<SamplePass> next(double seconds);
    /// @param frame  of the pass: the whole picture, black where it was not traced
    void add(const SamplePass& pass, const Frame& frame);

    /// The relative error that kShare of the pixels are within, by the estimate; nothing: not known
    /// yet.
    [[nodiscard]] std::optional<double> error() const { return error_; }
    /// Whether the goal's error has been reached; true without one.
    [[nodiscard]] bool reached() const;
    /// Share of the work that is done, 0 ... 1, as far as is known; never falls.
    [[nodiscard]] double done(double seconds);
    struct Samples {
        double mean = 0;
        int least = 0, most = 0;
    };
    [[nodiscard]] Samples samples() const;  ///< a pixel
    /// The picture, with each pixel's error: of squares of 5 x 5 pixels around it, since that of
    /// one pixel is as good as a single throw of dice.
    [[nodiscard]] Frame finish();

  private:
    struct Group {
        int samples = 0;  ///< a pixel, in both passes of the pair
        std::vector<std::size_t> tiles;
    };
    [[nodiscard]] std::size_t pixels_of(std::size_t tile) const;
    [[nodiscard]] SamplePass pass_of(const Group& group);
    void add_to_half(const SamplePass& pass, const Frame& frame);
    void estimate();
    void smooth_tiles();
    [[nodiscard]] int wanted(std::size_t tile, double scale) const;
    [[nodiscard]] double cost(double scale) const;
    [[nodiscard]] double scale_of(double samples) const;
    void add_worst(FunctionRef<void(std::size_t tile, int samples)> add) const;
    void plan(double seconds);
    void fit_into_time(Group& group, double seconds) const;

    int width_, height_;
    std::uint64_t seed_;
    SampleGoal goal_;
    TileMask grid_;
    std::array<std::vector<Rgb>, 2> halves_;  ///< means, from the top
    Frame frame_;                             ///< mean of groups, and the first pass's distances
    std::vector<int> counts_;                 ///< samples a pixel of a tile, in each half
    std::vector<double> tile_errors_;         ///< means of its pixels' errors
    std::vector<double> bad_pixels_;          ///< of a tile: those beyond the goal
    std::vector<float> errors_;               ///< of pixels, from the top
    std::deque<Group> plan_;
    std::optional<Group> half_done_;  ///< whose second pass is to come
    std::uint64_t passes_ = 0;
    double began_ = 0;   ///< the first pass [s]
    double traced_ = 0;  ///< samples
    double done_ = 0;
    std::optional<double> error_;
};

}  // namespace lightwalk
