#include "core/transport/light_groups.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lightwalk {

void GroupSums::add(const Rgb& coefficient, std::span<const Rgb> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Rgb value = coefficient * values[i];
        if (std::isfinite(value.r + value.g + value.b)) sums_[i] += value;
    }
}

GroupSums::Part::Part(GroupSums* sums, const Ray* root) : sums_(sums), root_before_(nullptr) {
    if (sums == nullptr) return;
    root_before_ = sums->set_root(root);
    before_ = std::exchange(sums->sums_, std::vector<Rgb>(sums->size()));
}

GroupSums::Part::~Part() {
    if (sums_ == nullptr) return;
    (void)sums_->set_root(root_before_);
    sums_->sums_ = std::move(before_);
}

void GroupSums::Part::keep() {
    if (sums_ == nullptr) return;
    for (std::size_t i = 0; i < before_.size(); ++i) before_[i] += sums_->sums_[i];
    sums_->clear();
}

}  // namespace lightwalk
