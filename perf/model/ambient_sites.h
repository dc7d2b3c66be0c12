#pragma once
// Which ambient values a part of a picture needs: the model of a cache that fills.
#include <cstdint>
#include <vector>

#include "perf/model/cost_map.h"

namespace lightwalk {

/// Every value that the measured run made is a site in the picture: somewhere in the cell that made
/// it. Who traces a region needs all sites in it, and those around it that reach into it: whatever
/// is not in its cache it computes. The coarse picture needs only sites that it made itself when it
/// was measured; the picture after it needs all.
class AmbientSites {
  public:
    /// @param reach  how far a site's value reaches, in mean distances between neighbouring sites
    AmbientSites(const CostMap& map, double reach, std::uint64_t seed);

    [[nodiscard]] std::size_t size() const { return sites_.size(); }
    [[nodiscard]] double making(std::uint32_t site) const { return sites_[site].making; }
    /// Needed by a region whose corners are shares of the picture's sides.
    void needed(double x0, double y0, double x1, double y1, bool prepass,
                std::vector<std::uint32_t>& found) const;

  private:
    struct Site {
        double x = 0, y = 0;  ///< shares of the picture's sides
        double making = 0;    ///< [s]
        bool prepass = false;
    };
    void add(const CellCosts& cells, bool prepass, std::uint64_t seed);
    [[nodiscard]] std::size_t bin_of(double x, double y) const;

    static constexpr int kBins = 64;  ///< along each side, to find sites by place
    std::vector<Site> sites_;
    std::vector<std::vector<std::uint32_t>> bins_;
    double reach_x_ = 0, reach_y_ = 0;
};

}  // namespace lightwalk
