#include "parallel/claim_table.h"

#include <algorithm>

namespace lightwalk {
namespace {

constexpr double kServingCosine = 0.985;  ///< cosine of normals whose values serve each other

}  // namespace

const ClaimTable::Entry* ClaimTable::find(const AmbientQuery& query) const {
    for (const Entry& entry : entries_) {
        const AmbientQuery& other = entry.query;
        if (other.level == query.level && other.weight >= query.weight &&
            dot(other.normal, query.normal) > kServingCosine &&
            length_squared(other.position - query.position) < reach_ * reach_)
            return &entry;
    }
    return nullptr;
}

bool ClaimTable::is_open(std::uint64_t number) const {
    return std::any_of(entries_.begin(), entries_.end(),
                       [number](const Entry& entry) { return entry.number == number; });
}

AmbientClaim ClaimTable::claim(const AmbientQuery& query) {
    std::unique_lock lock(mutex_);
    AmbientClaim claim;
    if (const Entry* entry = find(query)) {
        const std::uint64_t number = entry->number;
        claim.waited = true;
        (void)released_.wait_for(lock, usual_ / 2, [&] { return !is_open(number); });
    }
    claim.number = next_++;
    entries_.push_back({claim.number, query, Clock::now()});
    return claim;
}

void ClaimTable::release(const AmbientClaim& claim) {
    {
        const std::lock_guard lock(mutex_);
        const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                        [&](const Entry& e) { return e.number == claim.number; });
        if (entry == entries_.end()) return;
        usual_ += (Clock::now() - entry->start - usual_) / 8;
        *entry = entries_.back();
        entries_.pop_back();
    }
    released_.notify_all();
}

std::size_t ClaimTable::open() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
}

std::size_t ClaimTable::memory_bytes() const {
    const std::lock_guard lock(mutex_);
    return entries_.capacity() * sizeof(Entry);
}

}  // namespace lightwalk
