#pragma once
// The direct calculation's buffers: one set per thread, which allocates only while growing.
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/light/light_choice.h"
#include "core/light/shadow_order.h"
#include "core/light/source_samples.h"
#include "core/math/rgb.h"
#include "core/texture/function_binding.h"
#include "core/transport/tracer.h"

namespace lightwalk {

/// What is known of a candidate.
enum class CandidateState : std::uint8_t {
    unknown,  ///< nothing tested, nor how much the source sends
    known,    ///< nothing tested; the contribution is what arrives when nothing is in the way
    seen,     ///< nothing is in the way; how much the source sends is not known yet
    lit,      ///< tested: the contribution arrives
    dark,     ///< tested: blocked, or the source sends nothing this way; the contribution is 0
};

/// A sample of a source that could light a point.
struct LightCandidate {
    std::int32_t source = 0;  ///< into LightSources
    std::uint32_t point = 0;  ///< into DirectScratch::points
    Vec3 direction;           ///< unit, from the point
    double distance = kHuge;  ///< to the source's own surface [m]
    Rgb coefficient;          ///< K = f cosθ ω
    Rgb contribution;         ///< V = K E, as `state` says
    float brightness = 0;     ///< of the contribution, for the order of tests
    CandidateState state = CandidateState::unknown;
    bool needs_shading = false;  ///< a ray has to be followed through what is in the way
};

/// A shaded point whose direct light is being calculated. What every candidate asks of it stands
/// here, together: the rays of a batch are too many for the nearest cache.
struct ShadingPoint {
    explicit ShadingPoint(const DirectRequest& request);

    Vec3 position;
    Vec3 front;              ///< see Tracer::add_direct, where `one_sided`
    double part_size = 0;    ///< of sources, relative to their distance
    bool one_sided = false;  ///< no light from behind `front`
    bool clear_air = false;  ///< the medium takes nothing
    bool clipped = false;    ///< antimatter: every light has to be followed by a ray
    bool chosen = false;     ///< a few samples stand for all: direct_choice.cpp
    bool limited = false;    ///< an aft clipping plane cuts rays that go through the surface
    bool adaptive = false;   ///< tested brightest first, until the others cannot matter
    DirectCoefficient coefficient;
    Ray* ray;
    Tracer::ShadowStart start;  ///< of rays to the sources; its random numbers place the samples
    std::size_t first = 0;      ///< of the ranks of its candidates
    std::size_t count = 0;      ///< of candidates that are left
    std::size_t ahead = 0;      ///< see next_block()
    std::size_t tested = 0, block_end = 0;  ///< ranks
    ShadowTally tally;                      ///< adaptive
};

/// Candidates whose sources' patterns are evaluated side by side: a place each. Nothing is cleared
/// between two groups: most are small.
struct PatternGroup {
    std::array<std::uint32_t, kSideBySide> which{};  ///< candidate
    std::array<RayHit, kSideBySide> hits;            ///< on its source
    std::array<std::optional<float>, kSideBySide> pattern;
    std::array<std::optional<double>, kSideBySide> values;  ///< of one of the patterns
};

/// The buffers of one calculation.
struct DirectScratch {
    SourceViews views;              ///< of all sources, seen from one point
    SourceParts parts;              ///< of one of them
    SourceSamples samples;          ///< of all
    std::vector<Rgb> coefficients;  ///< of these
    std::vector<ShadingPoint> points;
    std::vector<LightCandidate> candidates;     ///< of one point after the other
    std::vector<std::uint32_t> ranks;           ///< candidates of one point after the other, in the
                                                ///< order of tests
    std::vector<float> sizes;                   ///< of sources or candidates, a few to be chosen
    std::vector<LightChoice> chosen;            ///< of these
    std::vector<std::uint32_t> chosen_sources;  ///< among the sampled ones
    std::vector<float> scales;                  ///< of these, by source
    std::vector<std::uint64_t> keys;            ///< of the candidates that are being ranked
    std::vector<float> remaining_sums;          ///< by rank, and one more a point: see next_block()
    std::vector<std::uint32_t> tests;           ///< candidates that are being tested
    std::vector<std::uint32_t> by_source;       ///< of these, those that plain visibility decides
    std::vector<std::uint32_t> source_ends;     ///< in by_source
    std::vector<ShadowQuery> shadow_queries;    ///< of these
    std::vector<Visibility> answers;            ///< to these
    std::vector<std::uint32_t> side_by_side;    ///< candidates whose patterns go side by side
    PatternGroup group;                         ///< some of these
};

struct LightScratch {
    std::deque<DirectScratch> nested;  ///< a shadow ray may meet what wants direct light, too
    std::size_t open = 0;              ///< of these: in use
    std::vector<Blocker> blockers;     ///< what hid each source last
    /// Of late: shows whether points have so many candidates that batches are worth their while.
    std::size_t points = 0, candidates = 0;
};

}  // namespace lightwalk
