#pragma once
// Points and values of a round of ambient values on the wire (see wire.h); hashes of points.
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "core/ambient/ambient_point.h"
#include "core/math/random.h"
#include "parallel/comm/core_fields.h"

namespace lightwalk {

/// A value of a round, and those that were computed on the way to it.
struct RoundValue {
    std::vector<NewAmbientRecord> new_records;
    std::optional<AmbientRecord> record;  ///< none where it cannot be stored
    std::vector<Rgb> groups = {};  ///< of its value, what each light group adds; empty: not asked
};

/// What a process tells the others at the end of a step, or no values or no points.
struct RoundShare {
    bool stop = false;      ///< it was requested to stop
    bool left_out = false;  ///< it has left points out
    std::vector<AmbientPoint> points;
    std::vector<RoundValue> values;
};

/// Says with which cache rounds begin: the number of its values, and the sum of AmbientLogMean.
struct RoundsBeginning {
    std::uint64_t values = 0;
    double log_sum = 0;
};
/// What a process tells the others before the first step: how many a checkpoint has.
struct RoundsKnown {
    std::uint64_t steps = 0;
};

template <class Wire>
void visit_fields(Wire& wire, RoundsBeginning& beginning) {
    wire(beginning.values, beginning.log_sum);
}
template <class Wire>
void visit_fields(Wire& wire, RoundsKnown& known) {
    wire(known.steps);
}
template <class Wire>
void visit_fields(Wire& wire, AmbientPoint& p) {
    AmbientQuery& q = p.query;
    Medium& m = p.medium;
    wire(q.position, q.normal, q.shading_normal, q.level, q.weight, m.extinction, m.albedo,
         m.eccentricity, p.distance, p.path_length, p.limit, p.ray_level, p.target, p.history,
         p.far_side);
}
template <class Wire>
void visit_fields(Wire& wire, NewAmbientRecord& found) {
    wire(found.point, found.record, found.groups);
}
template <class Wire>
void visit_fields(Wire& wire, RoundValue& value) {
    wire(value.new_records, value.record, value.groups);
}
template <class Wire>
void visit_fields(Wire& wire, RoundShare& share) {
    wire(share.stop, share.left_out, share.points, share.values);
}

/// Mixes the numbers of a value.
class FieldHasher final : public wire::Wire<FieldHasher> {
  public:
    static constexpr bool kReads = false, kOwnSizeOnly = false;
    void raw(const void* data, std::size_t size) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, data, size);
        hash = mix_bits(hash ^ bits);
    }
    std::uint64_t hash = 0;
};

/// A hash of all members of a point.
[[nodiscard]] inline std::uint64_t hash_of(const AmbientPoint& point) {
    AmbientPoint copy = point;
    FieldHasher hasher;
    hasher(copy);
    return hasher.hash;
}

}  // namespace lightwalk
