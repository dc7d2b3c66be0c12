#include "core/bsdf/bsdf.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lightwalk {
namespace {

constexpr double kFaintest = 0.001;   ///< lobes whose largest total is less are none
constexpr double kConserving = 1.01;  ///< largest total that is not warned of

constexpr std::array<const char*, kBsdfParts> kPartNames = {
    "front transmission", "back transmission", "front reflection", "back reflection"};

SplitLobes make_lobes(const BsdfTable& table, bool reversed) {
    if (const auto* matrix = std::get_if<BsdfMatrix>(&table))
        return make_matrix_lobes(*matrix, reversed);
    return make_tree_lobes(std::get<BsdfTree>(table), reversed);
}

std::size_t table_bytes(const TensorTree& tree) {
    return tree.nodes().capacity() * sizeof(TensorTree::Entry);
}

std::size_t table_bytes(const BsdfTable& table) {
    if (const auto* matrix = std::get_if<BsdfMatrix>(&table)) {
        return matrix->y.capacity() * sizeof(float) +
               matrix->xz.capacity() * sizeof(std::array<float, 2>);
    }
    const auto& tree = std::get<BsdfTree>(table);
    return table_bytes(tree.y) + (tree.u ? table_bytes(*tree.u) : 0) +
           (tree.v ? table_bytes(*tree.v) : 0);
}

}  // namespace

Rgb BsdfComponent::value(const ProjectedDirection& e, const ProjectedDirection& l) const {
    const Rgb constant = lambertian * static_cast<float>(1 / kPi);
    return lobes ? lobes->value_for(lobes->look_up(e), l).f + constant : constant;
}

Bsdf::Bsdf(std::shared_ptr<const BsdfData> data) : data_(std::move(data)) {
    using enum BsdfPart;
    for (const auto& [part, other] : {std::pair(front_transmission, back_transmission),
                                      std::pair(back_transmission, front_transmission)}) {
        const bool reversed = !data_->part(part);
        load(part, reversed ? other : part, reversed);
    }
    load(front_reflection, front_reflection, false);
    load(back_reflection, back_reflection, false);
}

void Bsdf::load(BsdfPart part, BsdfPart table, bool reversed) {
    const std::optional<BsdfTable>& from = data_->part(table);
    if (!from) return;
    SplitLobes split = make_lobes(*from, reversed);
    BsdfComponent& component = parts_[static_cast<std::size_t>(part)];
    component.lambertian = split.lambertian;
    // Of trees of rank 3 no totals are known in reverse; they still scatter the light of sources.
    const auto* tree = std::get_if<BsdfTree>(&*from);
    const bool no_totals = reversed && tree && tree->y.rank() == 3;
    if (no_totals || split.lobes->largest_total() > kFaintest)
        component.lobes = std::move(split.lobes);
}

bool Bsdf::transmits() const {
    return std::ranges::any_of(std::array{true, false}, [&](bool front) {
        const BsdfComponent& part = transmission(front);
        return part.lobes || max_component(part.lambertian) > 0;
    });
}

double Bsdf::largest_total(BsdfPart part) const {
    const BsdfComponent& component = parts_[static_cast<std::size_t>(part)];
    return static_cast<double>(brightness(component.lambertian)) +
           (component.lobes ? component.lobes->largest_total() : 0);
}

std::vector<std::string> Bsdf::warnings() const {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < kBsdfParts; ++i) {
        const double total = largest_total(static_cast<BsdfPart>(i));
        if (!(total > kConserving)) continue;
        std::array<char, 32> percent{};
        std::snprintf(percent.data(), percent.size(), "%.1f", 100 * total);
        all.push_back("BSDF \"" + data_->name + "\" has " + percent.data() + "% " + kPartNames[i]);
    }
    return all;
}

std::size_t Bsdf::own_bytes() const {
    std::size_t bytes = 0;
    for (const std::optional<BsdfTable>& table : data_->parts)
        bytes += table ? table_bytes(*table) : 0;
    for (const BsdfComponent& part : parts_) bytes += part.lobes ? part.lobes->own_bytes() : 0;
    return bytes;
}

}  // namespace lightwalk
