// Components from matrices.
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/bsdf/bsdf_color.h"
#include "core/bsdf/bsdf_lobes.h"

namespace lightwalk {
namespace {

/// e's patches are rows, l's patches columns.
class MatrixLobes final : public BsdfLobes {
  public:
    MatrixLobes(const BsdfMatrix& table, bool reversed);

    [[nodiscard]] BsdfLookup look_up(const ProjectedDirection& e) const override {
        return {e, row_of(e), {}};
    }
    [[nodiscard]] BsdfLookup look_up_light(const ProjectedDirection& l) const override {
        return {l, column_of(l), {}};
    }
    [[nodiscard]] Value value(const BsdfLookup& e, const BsdfLookup& l) const override {
        return value_at(e.patch, l.patch);
    }
    [[nodiscard]] std::array<Value, kNearDirections> values_near(
        const NearDirections& e, const BsdfLookup& l) const override;
    [[nodiscard]] double total(const BsdfLookup& e) const override { return totals_[e.patch]; }
    [[nodiscard]] Sample sample(const BsdfLookup& e, double choice, double xi1,
                                double xi2) const override;
    [[nodiscard]] std::uint32_t viewer_cell(const BsdfLookup& e) const override {
        return static_cast<std::uint32_t>(e.patch);
    }
    [[nodiscard]] SolidAngleRange resolution(const BsdfLookup& e) const override {
        const double area = rows_.solid_angle(e.patch);
        return {area, area};
    }
    [[nodiscard]] double least_solid_angle() const override {
        return std::min(rows_.least_solid_angle(), columns_.least_solid_angle());
    }
    [[nodiscard]] double largest_total() const override {
        return *std::max_element(totals_.begin(), totals_.end());
    }
    [[nodiscard]] std::size_t own_bytes() const override {
        return values_.size() * sizeof(float) + tints_.size() * sizeof(Rgb) +
               (cumulative_.size() + totals_.size()) * sizeof(double);
    }
    [[nodiscard]] Rgb lambertian() const { return lambertian_; }

  private:
    void split_grey();
    void split_colored(const BsdfMatrix& table);
    void add_up();
    [[nodiscard]] Value value_at(std::size_t row, std::size_t column) const;
    /// e is the incident direction as light travels, or the exitant one.
    [[nodiscard]] std::size_t row_of(const ProjectedDirection& e) const {
        return rows_.index(reversed_ ? e : ProjectedDirection{-e.x, -e.y});
    }
    [[nodiscard]] std::size_t column_of(const ProjectedDirection& l) const {
        return columns_.index(reversed_ ? ProjectedDirection{-l.x, -l.y} : l);
    }
    /// Where the value of a row and column stands in the table.
    [[nodiscard]] std::size_t place_in_table(std::size_t row, std::size_t column) const {
        return reversed_ ? column * rows_.size() + row : row * columns_.size() + column;
    }

    AngleBasis rows_, columns_;
    bool reversed_;
    Rgb lambertian_;
    std::vector<float> values_;
    std::vector<Rgb> tints_;          ///< of brightness 1; empty: grey
    std::vector<double> cumulative_;  ///< sums of value times solid angle along each row
    std::vector<double> totals_;      ///< their last ones
};

MatrixLobes::MatrixLobes(const BsdfMatrix& table, bool reversed)
    : rows_(reversed ? table.exitant : table.incident),
      columns_(reversed ? table.incident : table.exitant),
      reversed_(reversed),
      values_(table.y.size()) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        for (std::size_t k = 0; k < columns_.size(); ++k)
            values_[i * columns_.size() + k] = table.y[place_in_table(i, k)];
    }
    if (table.xz.empty())
        split_grey();
    else
        split_colored(table);
    add_up();
}

void MatrixLobes::split_grey() {
    const float least = *std::min_element(values_.begin(), values_.end());
    if (!is_lambertian_part(static_cast<double>(least))) return;
    lambertian_ = Rgb::grey(static_cast<float>(kPi) * least);
    for (float& value : values_) value -= least;
}

void MatrixLobes::split_colored(const BsdfMatrix& table) {
    const auto xyz_at = [&](std::size_t row, std::size_t column) {
        const std::size_t at = place_in_table(row, column);
        const auto y = static_cast<double>(table.y[at]);
        return Xyz{y * static_cast<double>(table.xz[at][0]), y,
                   y * static_cast<double>(table.xz[at][1])};
    };
    LeastColor least;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        for (std::size_t k = 0; k < columns_.size(); ++k) least.add(xyz_at(i, k));
    }
    const Xyz common = least.xyz();
    Rgb taken;
    if (is_lambertian_part(common[1])) taken = color_from_xyz(common);
    lambertian_ = taken * static_cast<float>(kPi);
    tints_.resize(values_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            const std::size_t at = i * columns_.size() + k;
            const Rgb left = without(color_from_xyz(xyz_at(i, k)), taken);
            values_[at] = brightness(left);
            tints_[at] = tint_of(left);
        }
    }
}

void MatrixLobes::add_up() {
    cumulative_.resize(values_.size());
    totals_.resize(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < columns_.size(); ++k) {
            const std::size_t at = i * columns_.size() + k;
            cumulative_[at] = sum += static_cast<double>(values_[at]) * columns_.solid_angle(k);
        }
        totals_[i] = sum;
    }
}

BsdfLobes::Value MatrixLobes::value_at(std::size_t row, std::size_t column) const {
    const std::size_t at = row * columns_.size() + column;
    const Rgb f = tints_.empty() ? Rgb::grey(values_[at]) : tints_[at] * values_[at];
    return {f, std::min(rows_.solid_angle(row), columns_.solid_angle(column)), column, true};
}

std::array<BsdfLobes::Value, kNearDirections> MatrixLobes::values_near(const NearDirections& e,
                                                                       const BsdfLookup& l) const {
    NearDirections named = e;  // as row_of()
    for (std::size_t i = 0; i < kNearDirections && !reversed_; ++i) {
        named.x[i] = -e.x[i];
        named.y[i] = -e.y[i];
    }
    const PatchNumbers rows = rows_.indices(named);
    std::array<Value, kNearDirections> values;
    for (std::size_t i = 0; i < kNearDirections; ++i) values[i] = value_at(rows[i], l.patch);
    return values;
}

BsdfLobes::Sample MatrixLobes::sample(const BsdfLookup& e, double choice, double xi1,
                                      double xi2) const {
    const std::size_t row = e.patch;
    const auto sums = std::span(cumulative_).subspan(row * columns_.size(), columns_.size());
    const auto found = std::upper_bound(sums.begin(), sums.end(), choice * totals_[row]);
    const std::size_t column =
        std::min(static_cast<std::size_t>(found - sums.begin()), columns_.size() - 1);
    const ProjectedDirection l = columns_.sample(column, xi1, xi2);
    Sample sample{reversed_ ? ProjectedDirection{-l.x, -l.y} : l, {1, 1, 1}};
    if (!tints_.empty()) sample.color = tints_[row * columns_.size() + column];
    return sample;
}

}  // namespace

SplitLobes make_matrix_lobes(const BsdfMatrix& table, bool reversed) {
    auto lobes = std::make_unique<const MatrixLobes>(table, reversed);
    const Rgb lambertian = lobes->lambertian();
    return {std::move(lobes), lambertian};
}

}  // namespace lightwalk
