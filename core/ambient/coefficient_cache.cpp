#include "core/ambient/coefficient_cache.h"

namespace lightwalk {
namespace {

/// Of what -ar allows: obstacles limit records of coefficients more than those of values.
constexpr double kLeastReach = 0.125;

double least_reach_of(const AmbientLimits& limits) {
    return kLeastReach * limits.accuracy * limits.least_radius;
}

}  // namespace

CoefficientCache::CoefficientCache(const AmbientLimits& limits, double effort)
    : limits_(limits),
      effort_(effort),
      grid_(limits.origin, least_reach_of(limits), largest_angle(limits.accuracy, 1, true)) {}

double CoefficientCache::least_reach() const {
    return least_reach_of(limits_);
}

void CoefficientCache::find(const AmbientQuery& query, std::vector<RecordShare>& shares) const {
    shares.clear();
    const double weight = grid_.find(query.position, query.normal, shares);
    for (RecordShare& share : shares) share.weight /= weight;
}

std::span<const CoefficientTerm> CoefficientCache::terms(std::uint32_t record) const {
    const Record& own = records_[record];
    return std::span(terms_).subspan(own.first, own.count);
}

void CoefficientCache::insert(const CoefficientRecord& record,
                              std::span<const CoefficientTerm> terms) {
    grid_.insert(record);
    records_.push_back({record.value, terms_.size(), terms.size()});
    terms_.insert(terms_.end(), terms.begin(), terms.end());
}

void CoefficientSums::add(std::uint32_t record, const Rgb& coefficient) {
    if (record >= weights_.size()) {
        weights_.resize(cache_.size());
        is_touched_.resize(cache_.size());
    }
    weights_[record] += coefficient;
    if (is_touched_[record] != 0) return;
    is_touched_[record] = 1;
    touched_.push_back(record);
}

void CoefficientSums::take(std::span<double> sums) {
    for (const std::uint32_t record : touched_) {
        const Rgb weight = weights_[record];
        for (const CoefficientTerm& term : cache_.terms(record)) {
            for (std::size_t k = 0; k < 3; ++k)
                sums[std::size_t{3} * term.column + k] +=
                    static_cast<double>(weight[k] * term.coefficient[k]);
        }
        weights_[record] = {};
        is_touched_[record] = 0;
    }
    touched_.clear();
}

}  // namespace lightwalk
