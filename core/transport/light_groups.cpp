#include "core/transport/light_groups.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lightwalk {

void GroupSums::add(const Rgb& coefficient, std::span<const Rgb> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        const Rgb value = coefficient * values[i];
        if (std::isfinite(value.r + value.g + value.b)) account_->sums[i] += value;
    }
}

GroupAccount* GroupSums::turn_to(GroupAccount* account) {
    account_->root = root();  // may be the same account
    (void)set_root(account->root);
    return std::exchange(account_, account);
}

void GroupSums::Part::begin(const Ray* root) {
    root_before_ = sums_->set_root(root);
    before_ = std::exchange(sums_->account_->sums, std::vector<Rgb>(sums_->size()));
}

void GroupSums::Part::end() {
    (void)sums_->set_root(root_before_);
    sums_->account_->sums = std::move(before_);
}

void GroupSums::Part::add_to_before() {
    std::vector<Rgb>& told = sums_->account_->sums;
    for (std::size_t i = 0; i < before_.size(); ++i) before_[i] += told[i];
    std::fill(told.begin(), told.end(), Rgb{});
}

}  // namespace lightwalk
