#include "parallel/ranks/ambient_exchange.h"

namespace lightwalk {

using Direction = AmbientValues::Direction;

void AmbientMaster::handle(int from, AmbientValues offer, Outbox& out) {
    if (offer.scene > scene_) {
        records_.clear();
        sources_.clear();
        told_.clear();
        scene_ = offer.scene;
    }
    if (offer.scene < scene_) offer.records.clear();
    std::size_t& told = told_[from];
    AmbientValues news{{}, scene_, Direction::news};
    for (std::size_t i = told; i < records_.size(); ++i) {
        if (sources_[i] != from) news.records.push_back(records_[i]);
    }
    records_.insert(records_.end(), offer.records.begin(), offer.records.end());
    sources_.insert(sources_.end(), offer.records.size(), from);
    told = records_.size();
    out.messages.push_back({self_, from, std::move(news)});
}

void AmbientClient::offer(AmbientValues own, Outbox& out) {
    if (own.scene < own_.scene) return;
    if (own.scene > own_.scene) own_ = {{}, own.scene};
    own_.records.insert(own_.records.end(), own.records.begin(), own.records.end());
    if (own.records.empty() || own_.records.size() >= batch_) ask(out);
}

void AmbientClient::handle(AmbientValues news, Outbox& out) {
    asked_ = false;
    if (!news.records.empty() && news.scene == own_.scene) out.cache.push_back(std::move(news));
    if (own_.records.size() >= batch_) ask(out);
}

void AmbientClient::ask(Outbox& out) {
    if (asked_) return;
    asked_ = true;
    out.messages.push_back({self_, master_, std::exchange(own_, {{}, own_.scene})});
}

}  // namespace lightwalk
