// Components from tensor trees.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/bsdf/bsdf_color.h"
#include "core/bsdf/bsdf_lobes.h"
#include "core/bsdf/tree_slices.h"

namespace lightwalk {
namespace {

constexpr auto kTiny = static_cast<float>(kEpsilon);
constexpr double kNormalIncidence = 0.5 - 1e-6;  ///< of the incident coordinate of rank 3
constexpr double kMostLambertian = 1.5 / kPi;    ///< a larger least value is no Lambertian part

/// What a tree has in common over all directions that it is looked up for.
struct CommonPart {
    float luminance = 0;  ///< [1/sr]
    Rgb color;
};

/// Both directions where they stand in the tree.
struct TreePoint {
    IncidentPath incident;
    std::array<HalvingPath, 2> exitant;
};

class TreeLobes final : public BsdfLobes {
  public:
    TreeLobes(const BsdfTree& table, bool reversed);

    [[nodiscard]] BsdfLookup look_up(const ProjectedDirection& e) const override {
        return {e, 0, incident_path(e)};
    }
    [[nodiscard]] BsdfLookup look_up_light(const ProjectedDirection& l) const override;
    [[nodiscard]] Value value(const BsdfLookup& e, const BsdfLookup& l) const override;
    [[nodiscard]] double total(const BsdfLookup& e) const override {
        if (!incident_.has_sums()) return 0;
        return static_cast<double>(incident_.sums(incident_.find(e.path)).total);
    }
    [[nodiscard]] Sample sample(const BsdfLookup& e, double choice, double xi1,
                                double xi2) const override;
    [[nodiscard]] std::uint32_t viewer_cell(const BsdfLookup& e) const override {
        return static_cast<std::uint32_t>(incident_.find(e.path));
    }
    [[nodiscard]] SolidAngleRange resolution(const BsdfLookup& e) const override;
    [[nodiscard]] double least_solid_angle() const override {
        return SliceCell{0, 0, incident_.finest(), 0}.solid_angle();
    }
    [[nodiscard]] double largest_total() const override { return incident_.largest_total(); }
    [[nodiscard]] std::size_t own_bytes() const override { return incident_.own_bytes(); }
    [[nodiscard]] Rgb lambertian() const { return common_.color * static_cast<float>(kPi); }

  private:
    [[nodiscard]] bool is_isotropic() const { return table_.y.rank() == 3; }
    [[nodiscard]] IncidentPath incident_path(const ProjectedDirection& e) const;
    [[nodiscard]] TreePoint place(const BsdfLookup& e, const BsdfLookup& l) const;
    [[nodiscard]] float left_of(float value) const {
        return std::max(0.0f, value - common_.luminance);
    }
    [[nodiscard]] Rgb color_at(const TreePoint& point, float value) const;
    [[nodiscard]] SliceCell choose(const IncidentPath& incident, std::size_t cell,
                                   double choice) const;

    const BsdfTree& table_;
    bool reversed_;
    SliceDimensions dimensions_;
    CommonPart common_;       ///< the Lambertian part
    IncidentCells incident_;  ///< without sums where totals are not known
};

SliceDimensions dimensions_of(const TensorTree& tree, bool reversed) {
    if (tree.rank() == 3) return {0, 1, 1};
    return reversed ? SliceDimensions{2, 2, 0} : SliceDimensions{0, 2, 2};
}

/// Calls visit(y, u, v) for the values of three trees of one rank in all cells that they have in
/// common.
template <class Visit>
void visit_together(const std::array<const TensorTree*, 3>& trees,
                    const std::array<TensorTree::Entry, 3>& entries, std::size_t children,
                    const Visit& visit) {
    if (std::ranges::all_of(entries, TensorTree::is_leaf)) {
        visit(TensorTree::value(entries[0]), TensorTree::value(entries[1]),
              TensorTree::value(entries[2]));
        return;
    }
    for (std::size_t c = 0; c < children; ++c) {
        std::array<TensorTree::Entry, 3> below = entries;
        for (std::size_t i = 0; i < 3; ++i) {
            if (!TensorTree::is_leaf(entries[i])) below[i] = trees[i]->child(entries[i], c);
        }
        visit_together(trees, below, children, visit);
    }
}

float least_leaf(const TensorTree& tree, TensorTree::Entry entry) {
    if (TensorTree::is_leaf(entry)) return TensorTree::value(entry);
    float least = INFINITY;
    for (std::size_t c = 0; c < tree.children(); ++c)
        least = std::min(least, least_leaf(tree, tree.child(entry, c)));
    return least;
}

/// The least value of a tree; of rank 3, of the half that directions reach.
float least_leaf(const TensorTree& tree) {
    if (tree.rank() != 3 || TensorTree::is_leaf(tree.root())) return least_leaf(tree, tree.root());
    float least = INFINITY;
    for (std::size_t c = 0; c < tree.children(); c += 2)
        least = std::min(least, least_leaf(tree, tree.child(tree.root(), c)));
    return least;
}

/// Where that is too little or too much to be a Lambertian part: nothing.
CommonPart common_part(const BsdfTree& table) {
    const auto counts = [](double m) { return is_lambertian_part(m) && m < kMostLambertian; };
    if (!table.u) {
        const float least = least_leaf(table.y);
        if (!counts(static_cast<double>(least))) return {};
        return {least, Rgb::grey(least)};
    }
    LeastColor least;
    visit_together({&table.y, &*table.u, &*table.v},
                   {table.y.root(), table.u->root(), table.v->root()}, table.y.children(),
                   [&](float y, float u, float v) {
                       const Xyz unit = xyz_of_uv(static_cast<double>(u), static_cast<double>(v));
                       const auto luminance = static_cast<double>(y);
                       least.add({luminance * unit[0], luminance, luminance * unit[2]});
                   });
    const Xyz common = least.xyz();
    if (!counts(common[1])) return {};
    return {static_cast<float>(common[1]), color_from_xyz(common)};
}

TreeLobes::TreeLobes(const BsdfTree& table, bool reversed)
    : table_(table),
      reversed_(reversed),
      dimensions_(dimensions_of(table.y, reversed)),
      common_(common_part(table)),
      incident_(table.y, dimensions_, common_.luminance) {
    if (is_isotropic() && reversed_) incident_.forget_sums();
}

/// Where light of e lies among the incident ones: as it travels, or, reversed, as it leaves.
IncidentPath TreeLobes::incident_path(const ProjectedDirection& e) const {
    if (is_isotropic()) {
        const double sine = std::min(1.0, std::sqrt(e.x * e.x + e.y * e.y));
        return {HalvingPath(kNormalIncidence - 0.5 * sine), {}};
    }
    const UnitSquarePoint at = disk_to_square(reversed_ ? e : ProjectedDirection{-e.x, -e.y});
    return {HalvingPath(at.x), HalvingPath(at.y)};
}

/// A rotation that takes the way of incident light onto +x.
struct Turn {
    double cosine = 1, sine = 0;
    explicit Turn(const ProjectedDirection& incident) {
        const double size = std::sqrt(incident.x * incident.x + incident.y * incident.y);
        cosine = size > 0 ? -incident.x / size : std::copysign(1.0, -incident.x);
        sine = size > 0 ? -incident.y / size : 0.0;
    }
    [[nodiscard]] ProjectedDirection apply(const ProjectedDirection& p) const {
        return {cosine * p.x + sine * p.y, cosine * p.y - sine * p.x};
    }
    [[nodiscard]] ProjectedDirection undo(const ProjectedDirection& p) const {
        return {cosine * p.x - sine * p.y, cosine * p.y + sine * p.x};
    }
};

/// Where light of l lies among the exitant ones; of rank 3 that depends on e, and l is kept as an
/// incident one, for data in reverse.
BsdfLookup TreeLobes::look_up_light(const ProjectedDirection& l) const {
    if (is_isotropic()) return {l, 0, reversed_ ? incident_path(l) : IncidentPath{}};
    const UnitSquarePoint at = disk_to_square(reversed_ ? ProjectedDirection{-l.x, -l.y} : l);
    return {l, 0, {HalvingPath(at.x), HalvingPath(at.y)}};
}

TreePoint TreeLobes::place(const BsdfLookup& e, const BsdfLookup& l) const {
    if (!is_isotropic()) return {e.path, l.path};
    const BsdfLookup &from = reversed_ ? l : e, &to = reversed_ ? e : l;
    const UnitSquarePoint exitant = disk_to_square(Turn(from.direction).apply(to.direction));
    return {from.path, {HalvingPath(exitant.x), HalvingPath(exitant.y)}};
}

/// The colour there of a BSDF whose luminance is `value`, without the Lambertian part.
Rgb TreeLobes::color_at(const TreePoint& point, float value) const {
    if (!table_.u) return Rgb::grey(left_of(value));
    std::array<HalvingPath, 4> path;
    const auto incident_first = static_cast<std::size_t>(dimensions_.incident_first),
               exitant_first = static_cast<std::size_t>(dimensions_.exitant_first);
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimensions_.incident_count); ++d)
        path[incident_first + d] = point.incident[d];
    for (std::size_t d = 0; d < 2; ++d) path[exitant_first + d] = point.exitant[d];
    const auto used = std::span(path).first(static_cast<std::size_t>(table_.y.rank()));
    const Xyz unit = xyz_of_uv(static_cast<double>(find_leaf(*table_.u, used).value),
                               static_cast<double>(find_leaf(*table_.v, used).value));
    return without(color_from_xyz(unit) * value, common_.color);
}

BsdfLobes::Value TreeLobes::value(const BsdfLookup& e, const BsdfLookup& l) const {
    const TreePoint point = place(e, l);
    TensorTree::Entry entry = table_.y.root();
    int level = 0;
    for (; !TensorTree::is_leaf(entry); ++level) {
        std::size_t incident = point.incident[0].half(level);
        if (dimensions_.incident_count == 2) incident |= point.incident[1].half(level) << 1;
        const std::size_t exitant = point.exitant[0].half(level) | point.exitant[1].half(level)
                                                                       << 1;
        entry = table_.y.child(entry, dimensions_.child(incident, exitant));
    }
    const SliceCell leaf{point.exitant[0].cell(level), point.exitant[1].cell(level), level, 0};
    const std::uint64_t cell =
        std::uint64_t{leaf.x} << 40 | std::uint64_t{leaf.y} << 16 | static_cast<unsigned>(level);
    const float value = TensorTree::value(entry);
    return {color_at(point, value), leaf.solid_angle(), cell, left_of(value) > kTiny};
}

SolidAngleRange TreeLobes::resolution(const BsdfLookup& e) const {
    if (!incident_.has_sums()) return {least_solid_angle(), least_solid_angle()};
    const SliceSums& sums = incident_.sums(incident_.find(e.path));
    return {SliceCell{0, 0, sums.finest, 0}.solid_angle(),
            SliceCell{0, 0, sums.coarsest, 0}.solid_angle()};
}

/// The leaf of a slice at a share of its total.
SliceCell TreeLobes::choose(const IncidentPath& incident, std::size_t cell, double choice) const {
    const float* sums = incident_.blocks(cell);
    const double wanted = choice * static_cast<double>(incident_.sums(cell).total);
    const auto block =
        std::min(kBlocks - 1,
                 static_cast<std::size_t>(
                     std::upper_bound(sums, sums + kBlocks, static_cast<float>(wanted)) - sums));
    double left = wanted - (block > 0 ? static_cast<double>(sums[block - 1]) : 0.0);
    const auto x = static_cast<std::uint32_t>(block % (1U << kBlockLevel)),
               y = static_cast<std::uint32_t>(block >> kBlockLevel);
    TensorTree::Entry entry = table_.y.root();
    SliceCell at;
    for (; at.level < kBlockLevel && !TensorTree::is_leaf(entry); ++at.level) {
        std::size_t half = incident[0].half(at.level);
        if (dimensions_.incident_count == 2) half |= incident[1].half(at.level) << 1;
        const int shift = kBlockLevel - 1 - at.level;
        const std::size_t quarter = (x >> shift & 1U) | (y >> shift & 1U) << 1;
        entry = table_.y.child(entry, dimensions_.child(half, quarter));
    }
    const int above = kBlockLevel - at.level;
    if (above > 0) return {x, y, kBlockLevel, TensorTree::value(entry)};
    SliceCell chosen{x, y, kBlockLevel, 0};
    visit_slice(
        table_.y, dimensions_, incident, entry, {x, y, kBlockLevel, 0}, [&](const SliceCell& leaf) {
            const double part = static_cast<double>(left_of(leaf.value)) * leaf.solid_angle();
            if (part > 0) chosen = leaf;
            return part <= 0 || (left -= part) >= 0;
        });
    return chosen;
}

BsdfLobes::Sample TreeLobes::sample(const BsdfLookup& e, double choice, double xi1,
                                    double xi2) const {
    const IncidentPath& incident = e.path;
    const SliceCell leaf = choose(incident, incident_.find(incident), choice);
    const UnitSquarePoint at{(leaf.x + xi1) * leaf.width(), (leaf.y + xi2) * leaf.width()};
    ProjectedDirection l = square_to_disk(at);
    Sample sample;
    if (table_.u) {
        const TreePoint point{incident, {HalvingPath(at.x), HalvingPath(at.y)}};
        sample.color = tint_of(color_at(point, leaf.value));
    }
    if (is_isotropic())
        l = Turn(e.direction).undo(l);
    else if (reversed_)
        l = {-l.x, -l.y};
    sample.l = l;
    return sample;
}

}  // namespace

SplitLobes make_tree_lobes(const BsdfTree& table, bool reversed) {
    auto lobes = std::make_unique<const TreeLobes>(table, reversed);
    const Rgb lambertian = lobes->lambertian();
    return {std::move(lobes), lambertian};
}

}  // namespace lightwalk
