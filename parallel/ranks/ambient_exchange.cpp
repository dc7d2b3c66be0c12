#include "parallel/ranks/ambient_exchange.h"

namespace lightwalk {

void AmbientMaster::handle(int from, AmbientValues offer, Outbox& out) {
    std::size_t& told = told_[from];
    AmbientValues news{{}, AmbientValues::Direction::news};
    for (std::size_t i = told; i < records_.size(); ++i) {
        if (sources_[i] != from) news.records.push_back(records_[i]);
    }
    records_.insert(records_.end(), offer.records.begin(), offer.records.end());
    sources_.insert(sources_.end(), offer.records.size(), from);
    told = records_.size();
    out.messages.push_back({self_, from, std::move(news)});
}

void AmbientMaster::clear() {
    records_.clear();
    sources_.clear();
    told_.clear();
}

void AmbientClient::offer(const std::vector<AmbientRecord>& own, Outbox& out) {
    own_.insert(own_.end(), own.begin(), own.end());
    if (!asked_ && own_.size() >= batch_) ask(out);
}

void AmbientClient::handle(AmbientValues news, Outbox& out) {
    asked_ = false;
    if (!news.records.empty()) out.cache.push_back(std::move(news));
    if (std::exchange(again_, false) || own_.size() >= batch_) ask(out);
}

void AmbientClient::ask(Outbox& out) {
    if (asked_) {
        again_ = true;
        return;
    }
    asked_ = true;
    out.messages.push_back({self_, master_, AmbientValues{std::exchange(own_, {})}});
}

void SharedCache::open(PublishedCache& cache) {
    const std::lock_guard lock(mutex_);
    cache_ = &cache;
    cache.add(*this);
}

void SharedCache::close() {
    const std::lock_guard lock(mutex_);
    cache_ = nullptr;
}

bool SharedCache::is_open() const {
    const std::lock_guard lock(mutex_);
    return cache_ != nullptr;
}

void SharedCache::stored(const AmbientRecord& record) {
    std::vector<AmbientRecord> full;
    {
        const std::lock_guard lock(mutex_);
        own_.push_back(record);
        if (own_.size() < batch_) return;
        full.swap(own_);
    }
    send_(std::move(full));
}

std::vector<AmbientRecord> SharedCache::unsent() {
    const std::lock_guard lock(mutex_);
    return std::exchange(own_, {});
}

void SharedCache::merge(const AmbientValues& news) {
    const std::lock_guard lock(mutex_);
    if (cache_ == nullptr) return;
    for (const AmbientRecord& record : news.records) cache_->take_over(record, *this);
}

}  // namespace lightwalk
