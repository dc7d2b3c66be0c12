#pragma once
// Buffers of the direct calculation: one set a thread, which allocates only while it grows.
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
#include "core/transport/light_transport.h"

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
    Vec3 direction;           ///< wi: unit, from the point
    double distance = kHuge;  ///< to the source's own surface [m]
    Rgb coefficient;          ///< K = f cosθ ω
    Rgb contribution;         ///< V = K Le, as `state` says
    float brightness = 0;     ///< the contribution's, for the order of tests
    CandidateState state = CandidateState::unknown;
    bool needs_shading = false;  ///< a ray has to be followed through what is in the way
};

/// A shaded point whose direct light is being calculated. What every candidate asks of it stands
/// here, together: the rays of a batch are too many for the nearest cache.
struct ShadingPoint {
    explicit ShadingPoint(const DirectRequest& request);

    Vec3 position;
    Vec3 front;              ///< see LightTransport::add_direct, where `one_sided`
    double part_size = 0;    ///< largest size of a source's parts, relative to their distance
    bool one_sided = false;  ///< no light from behind `front`
    bool clear_air = false;  ///< the medium takes nothing
    bool clipped = false;    ///< antimatter: every light has to be followed by a ray
    bool chosen = false;     ///< a few samples stand for all: direct_choice.cpp
    bool sampled = false;    ///< chosen, and one of a pixel's samples: all candidates are tested
    bool limited = false;    ///< an aft clipping plane cuts rays that go through the surface
    bool adaptive = false;   ///< tested brightest first, until the others cannot matter
    DirectCoefficient coefficient;
    Ray* ray;
    GroupAccount* account;  ///< see DirectRequest
    ShadowStart start;      ///< of shadow rays; its random numbers place the samples on sources
    std::size_t first = 0;  ///< its candidates' ranks begin here in DirectScratch::ranks
    std::size_t count = 0;  ///< candidates that are left
    std::size_t ahead = 0;  ///< see next_block()
    std::size_t tested = 0, block_end = 0;  ///< ranks, from `first` on
    ShadowTally tally;                      ///< only of adaptive points
};

/// For finding the samples that a point sees.
struct GatherScratch {
    SourceViews views;              ///< how all sources lie to the point
    SourceParts parts;              ///< how one source is divided
    SourceSamples samples;          ///< on all sources
    std::vector<Rgb> coefficients;  ///< K of each sample
};

/// For choosing a few sources or candidates that stand for all.
struct ChoiceScratch {
    std::vector<float> sizes;            ///< about what each source or candidate brings
    std::vector<LightChoice> chosen;     ///< numbers of those that were chosen
    std::vector<std::uint32_t> sources;  ///< chosen ones, among the sampled ones
    std::vector<float> scales;           ///< weight of each source that was chosen, by source
};

/// For testing the visibility of candidates, ordered by source.
struct ShadowScratch {
    std::vector<std::uint32_t>
        candidates;                    ///< decided by plain visibility, one source after another
    std::vector<std::uint32_t> ends;   ///< where the candidates of each source end
    std::vector<ShadowQuery> queries;  ///< one a candidate
    std::vector<Visibility> answers;   ///< one a query
};

/// For evaluating the patterns of candidates' sources, several at once. Nothing is cleared between
/// two groups: most are small.
struct PatternScratch {
    std::vector<std::uint32_t> candidates;  ///< that can be evaluated so
    // A group of these, one place each:
    std::array<std::uint32_t, kSideBySide> which{};         ///< candidate
    std::array<RayHit, kSideBySide> hits;                   ///< on the candidate's source
    std::array<std::optional<float>, kSideBySide> pattern;  ///< product of the values so far
    std::array<std::optional<double>, kSideBySide> values;  ///< what one of the patterns gives
};

/// The buffers of one calculation.
struct DirectScratch {
    std::vector<ShadingPoint> points;
    std::vector<LightCandidate> candidates;  ///< those of each point follow each other
    std::vector<std::uint32_t> ranks;   ///< candidates in the order of tests, point after point
    std::vector<std::uint64_t> keys;    ///< for sorting the candidates of one point
    std::vector<float> remaining_sums;  ///< by rank, and one more a point: see next_block()
    std::vector<std::uint32_t> tests;   ///< candidates that are being tested
    GatherScratch gather;
    ChoiceScratch choice;
    ShadowScratch shadows;
    PatternScratch patterns;
};

/// One thread's buffers.
struct LightScratch {
    std::deque<DirectScratch> nested;  ///< a shadow ray may meet what wants direct light, too
    std::size_t open = 0;              ///< how many of these are in use
    std::vector<Blocker> blockers;     ///< what hid each source last
    /// Counted of late: whether points have so many candidates that batches are worth their while.
    std::size_t points = 0, candidates = 0;
};

}  // namespace lightwalk
