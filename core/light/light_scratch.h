#pragma once
// The direct calculation's buffers: one set per thread, used as a stack, so that they allocate only
// while growing.
#include <cstdint>
#include <vector>

#include "core/geometry/geometry.h"
#include "core/light/partition.h"
#include "core/math/rgb.h"

namespace lightwalk {

/// What is known of a candidate.
enum class CandidateState : std::uint8_t {
    unknown,  ///< nothing tested, nor how much the source sends
    known,    ///< nothing tested; the contribution is what arrives when nothing is in the way
    seen,     ///< nothing is in the way; how much the source sends is not known yet
    lit,      ///< tested: the contribution arrives
    dark,     ///< tested: blocked, or the source sends nothing this way; the contribution is 0
};

/// A sample of a source that could light the point.
struct LightCandidate {
    std::int32_t source = 0;  ///< into LightSources
    std::uint32_t order = 0;  ///< in which it was gathered
    Vec3 direction;           ///< unit, from the point
    double distance = kHuge;  ///< to the source's own surface [m]
    Rgb coefficient;          ///< K = f cosθ ω
    Rgb contribution;         ///< V = K E, as `state` says
    float brightness = 0;     ///< of the contribution, for the order of tests
    CandidateState state = CandidateState::unknown;
};

/// Each calculation uses what lies above the sizes that it found, and truncates to them when it
/// ends.
struct LightScratch {
    SourceParts parts;                  ///< of the source being sampled
    std::vector<SourceSample> samples;  ///< of the source being looked at
    std::vector<LightCandidate> candidates;
    std::vector<Blocker> blockers;  ///< what hid each source last; stays
    std::vector<float> tails;       ///< brightness still untested, by candidate
};

}  // namespace lightwalk
