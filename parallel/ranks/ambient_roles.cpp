#include <iterator>
#include <utility>

#include "parallel/ranks/roles.h"

namespace lightwalk {

void AmbientMasterRole::handle(Envelope envelope, Outbox& out) {
    auto* given = std::get_if<AmbientValues>(&envelope.message);
    if (given == nullptr) return;
    if (given->scene > scene_) {
        records_.clear();
        sources_.clear();
        told_.clear();
        scene_ = given->scene;
    }
    if (given->scene < scene_) given->records.clear();
    std::size_t& told = told_[envelope.from.rank];
    AmbientValues news{{}, scene_};
    for (std::size_t i = told; i < records_.size(); ++i) {
        if (sources_[i] != envelope.from.rank) news.records.push_back(records_[i]);
    }
    records_.insert(records_.end(), given->records.begin(), given->records.end());
    sources_.insert(sources_.end(), given->records.size(), envelope.from.rank);
    told = records_.size();
    out.push_back({self_, envelope.from, std::move(news)});
}

void AmbientClientRole::handle(Envelope envelope, Outbox& out) {
    auto* values = std::get_if<AmbientValues>(&envelope.message);
    if (values == nullptr) return;
    if (envelope.from.role == Role::ambient_master) {
        asked_ = false;
        if (!values->records.empty() && values->scene == own_.scene)
            out.push_back({self_, {self_.rank, Role::cache}, std::move(*values)});
    } else if (values->scene >= own_.scene) {
        if (values->scene > own_.scene) own_ = {{}, values->scene};
        own_.records.insert(own_.records.end(), values->records.begin(), values->records.end());
        if (values->records.empty()) ask(out);
    }
    if (!asked_ && own_.records.size() >= batch_) ask(out);
}

void AmbientClientRole::ask(Outbox& out) {
    if (asked_) return;
    asked_ = true;
    out.push_back({self_, master_, std::exchange(own_, {{}, own_.scene})});
}

}  // namespace lightwalk
