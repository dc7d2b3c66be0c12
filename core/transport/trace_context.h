#pragma once
// One thread's working state while it traces rays.
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/function/program.h"
#include "core/model/ids.h"
#include "core/transport/counters.h"

namespace lightwalk {

class ContributionSink;
class Fibers;
class GroupSums;
class LightTransport;
class ShadingBatch;
struct CoefficientScratch;
struct Hit;
struct LightScratch;
struct MissingAmbient;
struct NewAmbientRecords;
struct Ray;
struct RecentThroughPart;

/// Owns an object whose type only higher folders know; who makes it says how it is destroyed.
template <class T>
using Opaque = std::unique_ptr<T, void (*)(T*)>;

/// To be called where the type is known.
template <class T, class... Arguments>
[[nodiscard]] Opaque<T> make_opaque(Arguments&&... arguments) {
    return {std::make_unique<T>(std::forward<Arguments>(arguments)...).release(),
            [](T* object) { std::default_delete<T>()(object); }};
}

/// Modifiers whose surfaces an antimatter has cut away along a path.
struct ClipSet {
    std::vector<ModifierId> modifiers;  ///< sorted
    [[nodiscard]] bool contains(ModifierId m) const;
};

/// Light sources that a mist scatters towards the eye.
struct ScatterList {
    std::vector<std::int32_t> sources;  ///< into LightSources
    [[nodiscard]] bool contains(std::int32_t source) const;
};

/// Watches rays as they are finished, children before their parents. It is not told of rays that
/// only ask a light source for its radiance, nor of shadow rays that an opaque surface stops.
class RayObserver {
  public:
    virtual ~RayObserver() = default;
    /// `first`: the nearest hit before shading turned anything over. `ray.parent` leads to the
    /// primary ray; they live during the call only.
    virtual void finished(const Ray& ray, const Hit& first) = 0;
};

inline constexpr std::size_t kSideBySide =
    64;  ///< points for which one function is evaluated at once

/// Memory of the function language: variables, and what functions can ask of the ray.
struct FunctionScratch {
    EvalState eval;
    ChannelValues channels{};
    std::array<ChannelValues, kSideBySide> lane_channels{};  ///< one a point, evaluated at once
};

/// How deep the code that runs is inside other rays and mixtures.
struct Nesting {
    int rays = 0;      ///< that are being evaluated, bounded by LightTransport::kMaxDepth
    int mixtures = 0;  ///< of which a branch is being evaluated
    friend bool operator==(const Nesting&, const Nesting&) = default;
};

/// The path of rays that is being evaluated.
struct PathState {
    Nesting nesting;
    int ambient_level = 0;  ///< ambient values whose hemispheres are being sampled
    // Sets made by antimatter and mist on the way; the path's rays point to them.
    std::deque<ClipSet> clip_sets;
    std::deque<ScatterList> scatter_lists;

    /// A path starts: the sets of the one before are forgotten. The tracer calls it where a ray is
    /// evaluated while no other is.
    void start() {
        // Most paths have none, and to clear a deque takes time even then.
        if (!clip_sets.empty()) clip_sets.clear();
        if (!scatter_lists.empty()) scatter_lists.clear();
    }
};

using MakeFibers = std::unique_ptr<Fibers> (*)(std::size_t count);  ///< see core/batch/fibers.h

/// Rays that are shaded together, and wait for each other where they need direct light.
struct BatchState {
    MakeFibers make_fibers = nullptr;       ///< null: rays are shaded one by one
    std::vector<Opaque<ShadingBatch>> all;  ///< one inside the other; made when first needed
    std::size_t open = 0;                   ///< how many of these are in use
    ShadingBatch* current = nullptr;        ///< the one whose fiber this code runs on; null: none
};

/// Where ambient values go that do not come from the cache or go to it, while a cache is filled in
/// rounds.
struct AmbientCollection {
    /// Takes the points where a value is missing, in place of computing it; meanwhile there is no
    /// direct light. Null: values are computed.
    MissingAmbient* missing = nullptr;
    /// Takes the values that are computed, in place of the cache. Null: the cache does.
    NewAmbientRecords* new_records = nullptr;
};

/// Everything that tracing a ray changes. Not shared between threads; reusable for any number of
/// rays.
struct TraceContext {
    TraceContext(const LightTransport& for_tracer, WarningSink& to_warnings)
        : tracer(for_tracer), warnings(to_warnings) {}
    TraceContext(const TraceContext&) = delete;
    TraceContext& operator=(const TraceContext&) = delete;

    const LightTransport& tracer;
    WarningSink& warnings;
    TraceCounters counters;
    RayObserver* observer = nullptr;            ///< told of every ray; null: nobody watches
    ContributionSink* contributions = nullptr;  ///< told the terms of radiance; null: nobody asks
    PathState path;
    FunctionScratch functions;
    Opaque<LightScratch> light{nullptr, nullptr};  ///< buffers of direct light; made when needed
    Opaque<RecentThroughPart> through_part{nullptr, nullptr};   ///< of aBSDF; made when needed
    Opaque<CoefficientScratch> coefficients{nullptr, nullptr};  ///< of lookups; made when needed
    BatchState batches;
    AmbientCollection ambient;
    GroupSums* groups = nullptr;  ///< the sink of contributions, where it adds up what groups of
                                  ///< emitters bring; else null

    /// Whether coefficients are asked for, of which radiance must not decide: else what is tested
    /// and sampled is what a picture needs.
    [[nodiscard]] bool asks_coefficients() const {
        return contributions != nullptr && groups == nullptr;
    }
};

}  // namespace lightwalk
