#pragma once
// Indirect light kept as what each of many emitters, or parts of the sky, adds to it.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ambient/ambient_record.h"
#include "core/ambient/record_grid.h"

namespace lightwalk {

/// Part of a sum: a coefficient for a column, which is a bin of emitters. Other than a coefficient
/// for every column a list of these takes no more room, nor time, for a finer sky.
struct CoefficientTerm {
    std::uint32_t column = 0;
    Rgb coefficient;
};

/// Buffers of one thread's lookups.
struct CoefficientScratch {
    std::vector<RecordShare> shares;
};

/// Records that hold the terms which their irradiance is the sum of. They serve the points that the
/// rays of a primary ray's hemisphere meet; a record's own rays go on one by one. Lookups may be
/// made by many threads, not while records are inserted.
class CoefficientCache {
  public:
    static constexpr int kLevel = 1;  ///< ambient evaluations that are open around a record

    /// @param effort  share of the samples that an ambient value would take (-ad): a ray brings the
    ///                mean of many records, whose errors are independent
    CoefficientCache(const AmbientLimits& limits, double effort);

    [[nodiscard]] const AmbientLimits& limits() const { return limits_; }
    [[nodiscard]] double effort() const { return effort_; }
    /// Smallest reach that a record may have [m].
    [[nodiscard]] double least_reach() const;
    [[nodiscard]] std::size_t size() const { return records_.size(); }
    /// Whether there is no room left in the memory that records may take.
    [[nodiscard]] bool full() const { return terms_.size() * sizeof(terms_[0]) >= kMostBytes; }

    /// Records whose sum stands for a point; their weights add up to 1. None where there is no
    /// record.
    void find(const AmbientQuery& query, std::vector<RecordShare>& shares) const;
    /// Irradiance / pi [W/(m² sr)].
    [[nodiscard]] const Rgb& value(std::uint32_t record) const { return records_[record].value; }
    [[nodiscard]] std::span<const CoefficientTerm> terms(std::uint32_t record) const;

    /// @param terms  of the record's value
    void insert(const CoefficientRecord& record, std::span<const CoefficientTerm> terms);

  private:
    static constexpr std::size_t kMostBytes = std::size_t{1} << 30;
    struct Record {
        Rgb value;
        std::size_t first = 0, count = 0;  ///< its terms
    };

    AmbientLimits limits_;
    double effort_;
    RecordGrid grid_;
    std::vector<Record> records_;
    std::vector<CoefficientTerm> terms_;
};

/// Adds up records times coefficients. Belongs to one thread.
class CoefficientSums {
  public:
    /// @param cache  must outlive this
    explicit CoefficientSums(const CoefficientCache& cache) : cache_(cache) {}
    void add(std::uint32_t record, const Rgb& coefficient);
    /// Removes the sums, and adds what they stand for to `sums`: three numbers a column.
    void take(std::span<double> sums);

  private:
    const CoefficientCache& cache_;
    std::vector<Rgb> weights_;            ///< by record
    std::vector<char> is_touched_;        ///< by record
    std::vector<std::uint32_t> touched_;  ///< in the order of their first coefficients
};

}  // namespace lightwalk
