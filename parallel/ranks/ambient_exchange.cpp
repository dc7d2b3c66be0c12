#include "parallel/ranks/ambient_exchange.h"

namespace lightwalk {
namespace {

AmbientValues none_of(std::uint64_t scene) {
    AmbientValues none;
    none.scene = scene;
    return none;
}

}  // namespace

void AmbientMaster::handle(int from, const AmbientValues& offer, Outbox& out) {
    AmbientValues news{{}, AmbientValues::Direction::news, {}, offer.scene};
    if (offer.scene > known_.scene) {
        clear();
        known_.scene = offer.scene;
    } else if (offer.scene < known_.scene) {  // the rank has not heard of the change yet
        out.messages.push_back({self_, from, std::move(news)});
        return;
    }
    std::size_t& told = told_[from];
    for (std::size_t i = told; i < size(); ++i) {
        if (sources_[i] != from) news.add(known_.records[i], known_.groups_of(i));
    }
    known_.add(offer);
    sources_.insert(sources_.end(), offer.records.size(), from);
    told = size();
    out.messages.push_back({self_, from, std::move(news)});
}

void AmbientMaster::clear() {
    known_ = {};
    sources_.clear();
    told_.clear();
}

void AmbientClient::offer(const AmbientValues& own, Outbox& out) {
    if (own.scene < own_.scene) return;
    if (own.scene > own_.scene) own_ = none_of(own.scene);
    own_.add(own);
    if (!asked_ && own_.records.size() >= batch_) ask(out);
}

void AmbientClient::handle(AmbientValues news, Outbox& out) {
    asked_ = false;
    if (!news.records.empty()) out.cache.push_back(std::move(news));
    if (std::exchange(again_, false) || own_.records.size() >= batch_) ask(out);
}

void AmbientClient::ask(Outbox& out) {
    if (asked_) {
        again_ = true;
        return;
    }
    asked_ = true;
    out.messages.push_back({self_, master_, std::exchange(own_, none_of(own_.scene))});
}

void SharedCache::open(PublishedCache& cache, std::uint64_t scene) {
    const std::lock_guard lock(mutex_);
    cache_ = &cache;
    own_ = none_of(scene);
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

void SharedCache::stored(const AmbientRecord& record, std::span<const Rgb> groups) {
    AmbientValues full;
    {
        const std::lock_guard lock(mutex_);
        own_.add(record, groups);
        if (own_.records.size() < batch_) return;
        full = std::exchange(own_, none_of(own_.scene));
    }
    send_(std::move(full));
}

AmbientValues SharedCache::unsent() {
    const std::lock_guard lock(mutex_);
    return std::exchange(own_, none_of(own_.scene));
}

void SharedCache::merge(const AmbientValues& news) {
    const std::lock_guard lock(mutex_);
    if (cache_ == nullptr || news.scene != own_.scene) return;
    for (std::size_t i = 0; i < news.records.size(); ++i)
        cache_->take_over(news.records[i], news.groups_of(i), *this);
}

}  // namespace lightwalk
