#pragma once
// What one point sees of all light sources: an array a number, so that they are looked at side by
// side.
#include <cstdint>
#include <span>
#include <vector>

#include "core/light/partition.h"
#include "core/transport/light_samples.h"

namespace lightwalk {

/// How source boxes lie to a point.
class SourceViews {
  public:
    /// The way to the centre [m]; to distant ones, the direction.
    [[nodiscard]] Vec3 way(std::size_t i) const { return {row(kX)[i], row(kY)[i], row(kZ)[i]}; }
    /// Whether all of it is behind the front.
    [[nodiscard]] bool is_behind(std::size_t i) const { return row(kHeight)[i] < 0; }
    /// Whether it is flat and turns away.
    [[nodiscard]] bool turns_away(std::size_t i) const { return !(row(kFacing)[i] > 0); }
    /// Whether it is so far that it is not divided. May be false though it is.
    [[nodiscard]] bool is_far(std::size_t i) const { return row(kMargin)[i] > 0; }

  private:
    friend class SourceBoxes;
    enum Row { kX, kY, kZ, kHeight, kFacing, kMargin, kRows };
    [[nodiscard]] const double* row(Row r) const { return rows_.data() + r * count_; }
    std::size_t count_ = 0;
    std::vector<double> rows_;
};

/// Samples of sources from one point.
class SourceSamples {
    friend class SourceBoxes;

  public:
    void clear() { count_ = 0; }
    [[nodiscard]] std::size_t size() const { return count_; }
    /// Add one of the `parts` parts that a source has from `point`.
    /// @param index  of the source, for who reads the sample
    void add(const LightSource& source, std::int32_t index, const SourcePart& part, int parts,
             const Vec3& point, double jitter, RandomStream& random);
    /// Sample what was added. Parts that turn away, are out of reach, or are seen from outside
    /// their source's spot go.
    /// @param sources  all, by index
    /// @param point    that of add()
    void sample(std::span<const LightSource> sources, const Vec3& point);
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
    // What is known of a sample, one row of numbers each: first the way to the place that is
    // sampled, then the direction there; how far it is; the part's share of the source; what the
    // solid angle of a flat source depends on.
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
        kRows
    };
    /// The number of the next sample, for which there is room.
    [[nodiscard]] std::size_t next() {
        if (count_ == capacity_) grow();
        return count_++;
    }
    [[nodiscard]] double* row(Row r) { return rows_.data() + r * capacity_; }
    [[nodiscard]] const double* row(Row r) const { return rows_.data() + r * capacity_; }
    void grow();
    void move(std::size_t from, std::size_t to);
    void aim();

    std::size_t count_ = 0, capacity_ = 0;
    std::vector<double> rows_;
    std::vector<std::int32_t> sources_;
};

/// The boxes in which sources are sampled, an array a number: what a point needs to know of each
/// before it is sampled.
class SourceBoxes {
  public:
    SourceBoxes() = default;
    /// Of those of the `sources` that `which` names.
    SourceBoxes(std::span<const LightSource> sources, std::span<const std::int32_t> which);

    /// Find out how they lie to a point.
    /// @param front    only what lies on this side counts; null: on both
    /// @param size_over_distance  as Partition takes it
    void look(const Vec3& point, const Vec3* front, double size_over_distance,
              SourceViews& out) const;
    /// The sources' worth, which is not known when the boxes are made.
    void set_worths(std::span<const LightSource> sources, std::span<const std::int32_t> which);
    /// About what each sends to the point, as `views` shows it: worth times solid angle, times the
    /// cosine at the point if it is one-sided; rather too much where a source is near. 0: nothing.
    /// @param sizes  out: one a source
    void rate(const SourceViews& views, bool one_sided, std::span<float> sizes) const;
    /// Add the whole of box i, of source `index`, as `views` shows it.
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
        kFlat,                 ///< 1: they have to face the point
        kLongest,              ///< half axis that is divided, squared [m²]
        kArea,
        kBehind,
        kReach,
        kRadius,  ///< the longer half axis of local ones [m]
        kWorth,   ///< LightSource::worth
        kRows
    };
    [[nodiscard]] const double* row(int r) const {
        return rows_.data() + static_cast<std::size_t>(r) * count_;
    }
    std::size_t count_ = 0;  ///< a multiple of kSimdWidth
    std::vector<double> rows_;
};

}  // namespace lightwalk
