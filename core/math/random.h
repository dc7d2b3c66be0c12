#pragma once
// Counter-based random numbers: every number is a pure function of (seed, pixel, sample, path,
// dimension).
#include <cstdint>

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
    /// Uniform in [0, 1), 53 bits.
    constexpr double next() {
        return static_cast<double>(mix_bits(key_ + kStep * ++drawn_) >> 11) * 0x1p-53;
    }
    /// Stream of the next spawned ray; distinct for each call on this stream.
    constexpr RandomStream child() {
        return RandomStream(mix_bits(mix_bits(key_ ^ 0x5851f42d4c957f2dULL) + kStep * ++spawned_));
    }

  private:
    static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ULL;
    std::uint64_t key_ = 0;
    std::uint32_t drawn_ = 0;
    std::uint32_t spawned_ = 0;
};

}  // namespace lightwalk
