#pragma once
// What tracked modifiers bring to single rays, in bins.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ambient/coefficient_cache.h"
#include "core/trace/ray_tally.h"
#include "core/trace/tracer.h"
#include "io/contributions/bin_definitions.h"

namespace lightwalk {

/// Whose contributions are asked for.
struct TrackedModifier {
    std::string name;
    Program bin;
    std::size_t bins = 1;
};

/// The columns of all tracked modifiers together: one a bin.
[[nodiscard]] std::size_t column_count(const std::vector<TrackedModifier>& tracked);

/// The names of those that the scene does not have.
[[nodiscard]] std::vector<std::string> missing_modifiers(
    const Scene& scene, const std::vector<TrackedModifier>& tracked);

/// Sums up, for each ray, what surfaces of the tracked modifiers bring: their own modifier counts,
/// not those in its chain. Light sources bring what they emit. Other materials bring all that a ray
/// sees of them, whatever made it; but shadow rays count only for the surface that they are sent
/// to: a light source, or a mirror that relays one.
/// Where the tracer has a cache of coefficients its records, which hold the same columns, count as
/// what they stand for.
class ContributionTally final : public RayTally, RayObserver {
  public:
    /// Throws InputError for other materials than light sources where there is such a cache: it
    /// does not keep what a ray sees of them.
    /// @param tracked  must outlive this
    /// @param values   radiance; else coefficients
    /// @param warnings  is told of bins beyond the last one; must outlive this
    ContributionTally(const Tracer& tracer, const std::vector<TrackedModifier>& tracked,
                      bool values, WarningSink& warnings);

    [[nodiscard]] RayObserver* observer() override { return watches_ ? this : nullptr; }
    void add(const Contribution& term) override;
    void add_record(std::uint32_t record, const Rgb& coefficient) override;
    /// Three numbers of double precision a column.
    void take(std::string& bytes) override;
    [[nodiscard]] std::vector<CoefficientTerm> take_terms() override;

  private:
    /// What a modifier's surfaces count as.
    struct Place {
        const TrackedModifier* tracked = nullptr;  ///< null: not tracked
        std::size_t first = 0;                     ///< its columns begin here
        bool emits = false;                        ///< it is a light source: what it emits counts
        bool watched = false;  ///< what leaves it counts, whatever made it; of an illum both
    };
    void finished(const Ray& ray, const Hit& first) override;
    void count(const Place& place, const Vec3& direction, const Vec3& position, const Rgb& amount);
    [[nodiscard]] bool meets_target(const Ray& ray) const;
    [[nodiscard]] const Place* place_of(ModifierId modifier) const;

    const Tracer& tracer_;
    std::vector<Place> places_;  ///< by modifier
    std::vector<double> sums_;
    std::vector<std::uint64_t> counted_;      ///< a bit a column: whether count() has added to it
    std::optional<CoefficientSums> records_;  ///< nothing: there is no cache
    BinChooser chooser_;
    WarningSink& warnings_;
    bool values_, watches_ = false, warned_ = false;
};

}  // namespace lightwalk
