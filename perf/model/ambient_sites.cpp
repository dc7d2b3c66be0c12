#include "perf/model/ambient_sites.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace lightwalk {

AmbientSites::AmbientSites(const CostMap& map, double reach, std::uint64_t seed)
    : bins_(static_cast<std::size_t>(kBins) * kBins) {
    if (map.prepass.width > 0) add(map.prepass, true, seed);
    add(map.picture, false, seed + 1);
    for (std::size_t i = 0; i < sites_.size(); ++i)
        bins_[bin_of(sites_[i].x, sites_[i].y)].push_back(static_cast<std::uint32_t>(i));
    if (sites_.empty()) return;
    const double pixels = static_cast<double>(map.picture.width) * map.picture.height;
    const double apart = std::sqrt(pixels / static_cast<double>(sites_.size()));
    reach_x_ = reach * apart / map.picture.width;
    reach_y_ = reach * apart / map.picture.height;
}

void AmbientSites::add(const CellCosts& cells, bool prepass, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(0, 1);
    for (std::size_t i = 0; i < cells.values.size(); ++i) {
        const auto columns = static_cast<std::size_t>(cells.columns());
        for (int k = 0; k < cells.values[i]; ++k) {
            const double x = (static_cast<double>(i % columns) + place(random)) * cells.cell;
            const double y = (static_cast<double>(i / columns) + place(random)) * cells.cell;
            sites_.push_back({std::min(x / cells.width, 1.0), std::min(y / cells.height, 1.0),
                              cells.making[i] / cells.values[i], prepass});
        }
    }
}

std::size_t AmbientSites::bin_of(double x, double y) const {
    const auto bin = [](double place) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>(place * kBins), 0, kBins - 1));
    };
    return bin(y) * kBins + bin(x);
}

void AmbientSites::needed(double x0, double y0, double x1, double y1, bool prepass,
                          std::vector<std::uint32_t>& found) const {
    found.clear();
    x0 -= reach_x_, x1 += reach_x_, y0 -= reach_y_, y1 += reach_y_;
    const std::size_t first = bin_of(x0, y0), last = bin_of(x1, y1);
    for (std::size_t row = first / kBins; row <= last / kBins; ++row) {
        for (std::size_t column = first % kBins; column <= last % kBins; ++column) {
            for (const std::uint32_t i : bins_[row * kBins + column]) {
                const Site& site = sites_[i];
                if (site.x >= x0 && site.x <= x1 && site.y >= y0 && site.y <= y1 &&
                    (site.prepass || !prepass))
                    found.push_back(i);
            }
        }
    }
}

}  // namespace lightwalk
