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

void GroupSums::Part::begin(const Ray* root) {
    root_before_ = sums_->set_root(root);
    before_ = std::exchange(sums_->sums_, std::vector<Rgb>(sums_->size()));
}

void GroupSums::Part::end() {
    (void)sums_->set_root(root_before_);
    sums_->sums_ = std::move(before_);
}

void GroupSums::Part::add_to_before() {
    for (std::size_t i = 0; i < before_.size(); ++i) before_[i] += sums_->sums_[i];
    std::fill(sums_->sums_.begin(), sums_->sums_.end(), Rgb{});
}

}  // namespace lightwalk
