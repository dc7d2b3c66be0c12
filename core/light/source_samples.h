#pragma once
// Samples of all light sources from one point. Everything is kept as a structure of arrays, so that
// SIMD instructions treat several sources at a time.
#include <cstdint>
#include <span>
#include <vector>

#include "core/light/partition.h"
#include "core/transport/light_samples.h"

namespace lightwalk {

/// Where the sampling boxes of all sources lie as seen from one point.
class SourceViews {
  public:
    /// The vector from the point to the centre of source i [m]; of a distant source, its direction.
    [[nodiscard]] Vec3 way(std::size_t i) const { return {row(kX)[i], row(kY)[i], row(kZ)[i]}; }
    /// Whether all of source i lies behind the surface of the point.
    [[nodiscard]] bool is_behind(std::size_t i) const { return row(kHeight)[i] < 0; }
    /// Whether source i is flat and turns its back to the point.
    [[nodiscard]] bool turns_away(std::size_t i) const { return !(row(kFacing)[i] > 0); }
    /// Whether source i is so far that Partition does not divide it. Conservative: true implies
    /// that it is not divided.
    [[nodiscard]] bool is_far(std::size_t i) const { return row(kMargin)[i] > 0; }

  private:
    friend class SourceBoxes;
    enum Row { kX, kY, kZ, kHeight, kFacing, kMargin, kRows };
    [[nodiscard]] const double* row(Row r) const { return rows_.data() + r * count_; }
    std::size_t count_ = 0;
    std::vector<double> rows_;
};

/// Samples of light sources from one point: add() all parts, then sample() them together.
class SourceSamples {
    friend class SourceBoxes;

  public:
    void clear() { count_ = known_ = 0; }
    [[nodiscard]] std::size_t size() const { return count_; }
    /// Add one of the `parts` parts that a source has from `point`.
    /// @param index  the source's index into the list of sources, which source() returns
    void add(const LightSource& source, std::int32_t index, const SourcePart& part, int parts,
             const Vec3& point, double jitter, RandomStream& random);
    /// Sample all parts that were added. Parts that turn away, are out of reach, or are seen from
    /// outside their source's spot are dropped.
    /// @param sources  the list of sources
    /// @param point    the point that was given to add()
    /// @param lanes    several at once; changes the speed only
    void sample(std::span<const LightSource> sources, const Vec3& point, bool lanes = true);
    /// Drop the samples of which `keep(i)` is false; the others move up.
    template <class Keep>
    void retain(Keep keep) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            if (!keep(i)) continue;
            if (kept != i) move(i, kept);
            ++kept;
        }
        count_ = kept;
    }

    [[nodiscard]] std::int32_t source(std::size_t i) const { return sources_[i]; }
    [[nodiscard]] LightSamples lights() const {
        return {row(kX), row(kY), row(kZ), row(kSolidAngle), count_};
    }

  private:
    // The rows of numbers that are kept for the samples. kX to kZ are the vector to the sampled
    // position until sample() makes it a direction; kShare is the part's share of its source; the
    // rows from kNormalX on are what the solid angle of a flat source depends on.
    enum Row {
        kX,
        kY,
        kZ,
        kDistance,
        kSolidAngle,
        kShare,
        kNormalX,
        kNormalY,
        kNormalZ,
        kArea,
        kBehind,
        kReach,
        // Of whole distant sources, which look alike from everywhere: the unit direction, and the
        // length of the vector.
        kKnownX,
        kKnownY,
        kKnownZ,
        kKnownDistance,
        kRows
    };
    /// Make room for one more sample, and return its number.
    [[nodiscard]] std::size_t next() {
        if (count_ == capacity_) grow();
        return count_++;
    }
    /// Directions and distances of samples that are all known beforehand.
    void take_known();
    [[nodiscard]] double* row(Row r) { return rows_.data() + r * capacity_; }
    [[nodiscard]] const double* row(Row r) const { return rows_.data() + r * capacity_; }
    void grow();
    void move(std::size_t from, std::size_t to);
    template <bool kLanes>
    void aim();

    std::size_t count_ = 0, capacity_ = 0;
    std::size_t known_ = 0;  ///< samples that have the rows from kKnownX on
    std::vector<double> rows_;
    std::vector<std::int32_t> sources_;
};

/// The boxes in which sources are sampled, as a structure of arrays: what a point needs to know of
/// each before it is sampled.
class SourceBoxes {
  public:
    SourceBoxes() = default;
    /// Boxes of those `sources` that `which` names.
    /// @param lanes  several are looked at at once; changes the speed only
    SourceBoxes(std::span<const LightSource> sources, std::span<const std::int32_t> which,
                bool lanes = true);

    /// Find out where all boxes lie as seen from a point.
    /// @param front  normal of the point's surface when it sees light on that side only; else null
    /// @param size_over_distance  as Partition takes it
    void look(const Vec3& point, const Vec3* front, double size_over_distance,
              SourceViews& out) const;
    /// Copy LightSource::worth of all sources, which is not known when the boxes are made.
    void set_worths(std::span<const LightSource> sources, std::span<const std::int32_t> which);
    /// Estimate what each source sends to the point of `views`: worth times solid angle, times the
    /// cosine at the point if it is one-sided; rather too much where a source is near, 0 where it
    /// sends nothing.
    /// @param sizes  out: one for each source
    void rate(const SourceViews& views, bool one_sided, std::span<float> sizes) const;
    /// Add box i, which is that of source `index`, to the samples of the point of `views`,
    /// undivided and without jitter.
    void add_whole(std::size_t i, std::int32_t index, const SourceViews& views,
                   SourceSamples& samples) const;

  private:
    enum Row {
        kCenter,
        kU = kCenter + 3,
        kV = kU + 3,
        kW = kV + 3,
        kNormal = kW + 3,
        kLocal = kNormal + 3,  ///< 0 at infinity, else 1
        kFlat,                 ///< 1 for sources that have to face the point, else 0
        kLongest,              ///< square of the longer half axis, where it is divided [m²]
        kArea,
        kBehind,
        kReach,
        kRadius,  ///< the longer half axis of local sources [m], 0 at infinity
        kWorth,   ///< LightSource::worth
        kKnown,   ///< of distant sources: the rows of samples from kKnownX on
        kKnownDistance = kKnown + 3,
        kRows
    };
    [[nodiscard]] const double* row(int r) const {
        return rows_.data() + static_cast<std::size_t>(r) * count_;
    }
    template <bool kLanes>
    void look_at_all(const Vec3& point, const Vec3* front, double size_over_distance,
                     SourceViews& out) const;
    template <bool kLanes>
    void rate_all(const SourceViews& views, bool one_sided, std::span<float> sizes) const;

    bool lanes_ = true;
    std::size_t count_ = 0;  ///< a multiple of kSimdWidth
    std::vector<double> rows_;
};

}  // namespace lightwalk
