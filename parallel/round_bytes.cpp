#include "parallel/round_bytes.h"

#include <cstring>

#include "core/math/random.h"
#include "parallel/comm/core_fields.h"

namespace lightwalk {

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
    wire(found.point, found.record);
}
template <class Wire>
void visit_fields(Wire& wire, RoundValue& value) {
    wire(value.new_records, value.record);
}

namespace {

/// Mixes the numbers of a value.
class Hasher final : public wire::Wire<Hasher> {
  public:
    static constexpr bool kReads = false, kOwnSizeOnly = false;
    void raw(const void* data, std::size_t size) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, data, size);
        hash = mix_bits(hash ^ bits);
    }
    std::uint64_t hash = 0;
};

}  // namespace

std::string encode_points(const std::vector<AmbientPoint>& points) {
    return wire::encode(points);
}

void decode_points(const std::string& bytes, std::vector<AmbientPoint>& points) {
    const auto more = wire::decode<std::vector<AmbientPoint>>(bytes);
    points.insert(points.end(), more.begin(), more.end());
}

std::string encode_values(const std::vector<RoundValue>& values) {
    return wire::encode(values);
}

std::vector<RoundValue> decode_values(const std::string& bytes) {
    return wire::decode<std::vector<RoundValue>>(bytes);
}

std::uint64_t hash_of(const AmbientPoint& point) {
    AmbientPoint copy = point;
    Hasher hasher;
    hasher(copy);
    return hasher.hash;
}

}  // namespace lightwalk
