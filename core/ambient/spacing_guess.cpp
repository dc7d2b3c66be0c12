#include "core/ambient/spacing_guess.h"

#include <algorithm>

#include "core/math/direction_code.h"
#include "core/math/random.h"

namespace lightwalk {
namespace {

constexpr double kSameNormal = 0.95;  ///< cosine of normals whose values serve each other

std::uint64_t cell_key(std::uint64_t seed, const Vec3& position, double edge) {
    for (std::size_t k = 0; k < 3; ++k) {
        const auto step = static_cast<std::int64_t>(std::floor(position[k] / edge));
        seed = mix_bits(seed ^ static_cast<std::uint64_t>(step));
    }
    return seed;
}

/// Which side of a cube a normal points to.
std::uint64_t side_of(const Vec3& normal) {
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) {
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    }
    return 2 * axis + (normal[axis] < 0 ? 1 : 0);
}

}  // namespace

SpacingGuess::SpacingGuess(const AmbientLimits& limits)
    : accuracy_(limits.accuracy),
      least_(limits.accuracy * limits.least_radius),
      greatest_(limits.accuracy * limits.most_radius),
      scales_(1 + static_cast<std::size_t>(std::ceil(std::log2(greatest_ / least_)))) {}

std::uint64_t SpacingGuess::key(std::size_t scale, int level, const Vec3& position,
                                const Vec3& normal) const {
    const double edge = 2 * least_ * static_cast<double>(std::uint64_t{1} << scale);
    const std::uint64_t seed =
        (static_cast<std::uint64_t>(level) * 64 + scale) * 8 + side_of(normal);
    return cell_key(mix_bits(seed), position, edge);
}

void SpacingGuess::add(const AmbientRecord& record) {
    const Vec3 position{record.position[0], record.position[1], record.position[2]};
    add(position, decode_direction(record.normal), record.level,
        accuracy_ * std::sqrt(static_cast<double>(record.radius[0]) *
                              static_cast<double>(record.radius[1])));
}

void SpacingGuess::add(const Vec3& position, const Vec3& normal, int level, double reach) {
    for (std::size_t scale = 0; scale < scales_; ++scale) {
        Mean& mean = cells_[key(scale, level, position, normal)];
        mean.log_sum += std::log(reach);
        ++mean.count;
    }
}

double SpacingGuess::operator()(const AmbientQuery& query) const {
    for (std::size_t scale = 0; scale < scales_; ++scale) {
        const auto at = cells_.find(key(scale, query.level, query.position, query.normal));
        if (at != cells_.end()) return std::exp(at->second.log_sum / at->second.count);
    }
    return greatest_;
}

ApartSet::ApartSet(double least, double greatest)
    : least_(least), scales_(2 + static_cast<std::size_t>(std::log2(greatest / least))) {}

/// Cells of a scale are at least twice as wide as the reach of its members.
std::size_t ApartSet::scale_of(double reach) const {
    std::size_t scale = 0;
    while (scale + 1 < scales_.size() && edge(scale) < 2 * reach) ++scale;
    return scale;
}

bool ApartSet::reached(const AmbientQuery& query) const {
    for (std::size_t scale = 0; scale < scales_.size(); ++scale) {
        if (scales_[scale].empty()) continue;
        const auto at = scales_[scale].find(cell_key(0, query.position, edge(scale)));
        if (at == scales_[scale].end()) continue;
        for (const Member& member : at->second) {
            if (length_squared(member.position - query.position) < member.reach2 &&
                dot(member.normal, query.normal) > kSameNormal)
                return true;
        }
    }
    return false;
}

/// Registers the point in every cell that its reach touches: at most eight.
void ApartSet::add(const AmbientQuery& query, double reach) {
    const std::size_t scale = scale_of(reach);
    const double wide = edge(scale);
    const Member member{query.position, query.normal, reach * reach};
    std::array<std::array<double, 2>, 3> steps{};
    for (std::size_t k = 0; k < 3; ++k) {
        steps[k] = {std::floor((query.position[k] - reach) / wide),
                    std::floor((query.position[k] + reach) / wide)};
    }
    for (unsigned corner = 0; corner < 8; ++corner) {
        Vec3 inside;
        bool twice = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const unsigned side = corner >> k & 1U;
            twice = twice || (side == 1 && steps[k][0] == steps[k][1]);
            inside[k] = (steps[k][side] + 0.5) * wide;
        }
        if (!twice) scales_[scale][cell_key(0, inside, wide)].push_back(member);
    }
}

}  // namespace lightwalk
