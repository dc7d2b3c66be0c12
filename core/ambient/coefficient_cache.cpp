#include "core/ambient/coefficient_cache.h"

namespace lightwalk {

const CoefficientCache::Level* CoefficientCache::level(int number) const {
    const auto n = static_cast<std::size_t>(number);
    return n < levels_.size() ? &levels_[n] : nullptr;
}

std::size_t CoefficientCache::size(int number) const {
    const Level* const own = level(number);
    return own ? own->numbers.size() : 0;
}

void CoefficientCache::find(const AmbientQuery& query, LeakTest leaks,
                            std::vector<RecordShare>& shares) const {
    shares.clear();
    const Level* const own = level(query.level);
    if (!own) return;
    const double weight = own->tree.find(query, leaks, shares);
    if (weight <= kEpsilon) return shares.clear();
    for (RecordShare& share : shares) {
        share.record = own->numbers[share.record];
        share.weight /= weight;
    }
}

bool CoefficientCache::serves(const AmbientQuery& query, LeakTest leaks) const {
    const Level* const own = level(query.level);
    std::vector<RecordShare> shares;
    return own && own->tree.find(query, leaks, shares) > kEpsilon;
}

std::span<const CoefficientTerm> CoefficientCache::columns(std::uint32_t record) const {
    const Record& own = records_[record];
    return std::span(terms_).subspan(own.first, own.columns);
}

std::span<const CoefficientTerm> CoefficientCache::records(std::uint32_t record) const {
    const Record& own = records_[record];
    return std::span(terms_).subspan(own.first + own.columns, own.records);
}

void CoefficientCache::insert(const AmbientRecord& record, const CoefficientTerms& terms) {
    while (levels_.size() <= record.level) levels_.emplace_back(limits_);
    Level& own = levels_[record.level];
    own.tree.insert(record);
    own.numbers.push_back(static_cast<std::uint32_t>(records_.size()));
    records_.push_back({record.value, terms_.size(), terms.columns.size(), terms.records.size()});
    terms_.insert(terms_.end(), terms.columns.begin(), terms.columns.end());
    terms_.insert(terms_.end(), terms.records.begin(), terms.records.end());
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

std::vector<CoefficientTerm> CoefficientSums::take() {
    std::vector<CoefficientTerm> terms;
    terms.reserve(touched_.size());
    for (const std::uint32_t record : touched_) {
        terms.push_back({record, weights_[record]});
        weights_[record] = {};
        is_touched_[record] = 0;
    }
    touched_.clear();
    return terms;
}

void CoefficientSums::take(std::span<double> sums) {
    // Those that the records refer to come behind them, level after level: when a record's turn
    // comes all that refers to it was before.
    for (std::size_t i = 0; i < touched_.size(); ++i) {
        const std::uint32_t record = touched_[i];
        const Rgb weight = weights_[record];
        for (const CoefficientTerm& term : cache_.columns(record)) {
            for (std::size_t k = 0; k < 3; ++k)
                sums[std::size_t{3} * term.number + k] +=
                    static_cast<double>(weight[k] * term.coefficient[k]);
        }
        for (const CoefficientTerm& term : cache_.records(record))
            add(term.number, weight * term.coefficient);
    }
    for (const std::uint32_t record : touched_) {
        weights_[record] = {};
        is_touched_[record] = 0;
    }
    touched_.clear();
}

}  // namespace lightwalk
