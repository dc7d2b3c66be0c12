#pragma once
// Counter-based random numbers: every number is a pure function of (seed, pixel, sample, path,
// dimension).
#include <cstdint>

#include "core/math/sequence_2d.h"

namespace lightwalk {

/// Bijective 64-bit mixing. Source: Steele, Lea & Flood, "Fast splittable pseudorandom number
/// generators", OOPSLA 2014 (SplitMix64), with D. Stafford's variant 13 constants.
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
}

/// The stream of one ray. Copying copies the position; `child` starts an independent stream for a
/// spawned ray.
///
/// The streams of several samples of a picture may be stratified together (of_samples): what one of
/// them draws is uniform and independent as ever, but the samples of a pixel, and those of pixels
/// close to each other, share out the unit square of each pair of numbers among themselves.
class RandomStream {
  public:
    RandomStream() = default;
    explicit constexpr RandomStream(std::uint64_t key) : key_(key) {}
    /// The stream of sample `sample` of pixel (x, y).
    static constexpr RandomStream of_pixel(std::uint64_t seed, std::uint32_t x, std::uint32_t y,
                                           std::uint32_t sample) {
        const std::uint64_t pixel = (std::uint64_t{y} << 32) | x;
        return RandomStream(mix_bits(mix_bits(mix_bits(seed + kStep) ^ pixel) +
                                     kStep * (std::uint64_t{sample} + 1)));
    }
    /// The stream of sample `sample`, of `count`, of pixel (x, y), stratified together with those
    /// of the whole picture: pixels lie along Morton's curve, samples of a pixel and of squares of
    /// pixels follow each other in the sequences from which numbers are drawn. So the error of
    /// neighbouring pixels is opposite rather than alike, and what is left of their mean is small.
    /// Source: Ahmed & Wonka, "Screen-space blue-noise diffusion of Monte Carlo sampling error via
    /// hierarchical ordering of pixels", ACM Transactions on Graphics 39(6), 2020.
    static constexpr RandomStream of_samples(std::uint64_t seed, std::uint32_t x, std::uint32_t y,
                                             std::uint32_t sample, std::uint32_t count) {
        const std::uint64_t index = std::uint64_t{morton_index(x, y)} * count + sample;
        const std::uint64_t part =
            (index >> 32) | (std::uint64_t{y >> 16} << 48) | (std::uint64_t{x >> 16} << 32);
        RandomStream stream(mix_bits(mix_bits(seed + 3 * kStep) ^ part));
        stream.stratified_ = true;
        stream.reversed_index_ = reverse_bits(static_cast<std::uint32_t>(index));
        return stream;
    }
    /// Uniform in [0, 1), 53 bits; of a stratified stream 32.
    constexpr double next() {
        if (stratified_) return next_stratified();
        return static_cast<double>(mix_bits(key_ + kStep * ++drawn_) >> 11) * 0x1p-53;
    }
    /// Two numbers that belong together, as a place in a square: of stratified streams they are
    /// stratified in both dimensions at once; of others those of two calls of next().
    constexpr SequencePoint next_pair() {
        if (!stratified_) {
            const double first = next();
            return {first, next()};
        }
        const std::uint32_t pair = (drawn_ + 1) / 2;
        drawn_ = 2 * pair + 2;
        return sequence_point(reversed_index_, seeds_of(pair));
    }
    /// Stream of the next spawned ray; distinct for each call on this stream.
    constexpr RandomStream child() {
        RandomStream stream = *this;
        stream.key_ = mix_bits(mix_bits(key_ ^ 0x5851f42d4c957f2dULL) + kStep * ++spawned_);
        stream.drawn_ = stream.spawned_ = 0;
        return stream;
    }

  private:
    static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ULL;

    [[nodiscard]] constexpr SequenceSeeds seeds_of(std::uint32_t pair) const {
        const std::uint64_t key = mix_bits(key_ + kStep * (std::uint64_t{pair} + 1));
        return {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32),
                static_cast<std::uint32_t>((key * kStep) >> 32)};
    }
    /// Apart, so that next() stays small where it is called.
    [[gnu::noinline]] constexpr double next_stratified() {
        const SequencePoint point = sequence_point(reversed_index_, seeds_of(drawn_ / 2));
        return (drawn_++ & 1U) != 0 ? point.second : point.first;
    }

    std::uint64_t key_ = 0;
    std::uint32_t drawn_ = 0;
    std::uint32_t spawned_ = 0;
    std::uint32_t reversed_index_ = 0;  ///< of stratified streams
    bool stratified_ = false;
};

}  // namespace lightwalk
