#pragma once
// Indirect light kept as what each of many emitters, or parts of the sky, adds to it.
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/ambient/record_tree.h"

namespace lightwalk {

/// Part of a sum: a coefficient for a column, or for a record.
struct CoefficientTerm {
    std::uint32_t number = 0;
    Rgb coefficient;
};

/// What a value is the sum of: bins of emitters, which are columns, and records that hold more of
/// both. Other than a coefficient for every column it takes no more room, nor time, for a finer
/// sky.
struct CoefficientTerms {
    std::vector<CoefficientTerm> columns, records;
};

/// Buffers of one thread's lookups.
struct CoefficientScratch {
    std::vector<RecordShare> shares;
};

/// Ambient records that hold, beside the irradiance by which they are placed, the terms that it is
/// the sum of. All terms of a record are extrapolated alike, by the gradients of its irradiance.
/// Other than ambient values, the records of a level serve that level alone: they hold as many
/// bounces as were asked for, and refer to records of the level below. Lookups may be made by many
/// threads, not while records are inserted.
class CoefficientCache {
  public:
    /// @param effort  share of the samples that an ambient value would take (-ad): what a ray
    /// brings
    ///                is the mean over many records, whose errors are independent
    CoefficientCache(const AmbientLimits& limits, double effort)
        : limits_(limits), effort_(effort) {}

    [[nodiscard]] const AmbientLimits& limits() const { return limits_; }
    [[nodiscard]] double effort() const { return effort_; }
    [[nodiscard]] std::size_t size() const { return records_.size(); }
    /// Records of a level.
    [[nodiscard]] std::size_t size(int number) const;
    /// Whether there is no room left in the memory that records may take.
    [[nodiscard]] bool full() const { return terms_.size() * sizeof(terms_[0]) >= kMostBytes; }

    /// Records whose sum stands for a point, each times its weight and its factor; the weights add
    /// up to 1. None where there is no record.
    void find(const AmbientQuery& query, LeakTest leaks, std::vector<RecordShare>& shares) const;
    [[nodiscard]] bool serves(const AmbientQuery& query, LeakTest leaks) const;

    /// Irradiance / pi, by which a record was placed [W/(m² sr)].
    [[nodiscard]] const Rgb& value(std::uint32_t record) const { return records_[record].value; }
    [[nodiscard]] std::span<const CoefficientTerm> columns(std::uint32_t record) const;
    [[nodiscard]] std::span<const CoefficientTerm> records(std::uint32_t record) const;

    /// @param terms  of the record's value
    void insert(const AmbientRecord& record, const CoefficientTerms& terms);

  private:
    static constexpr std::size_t kMostBytes = std::size_t{1} << 30;
    struct Level {
        explicit Level(const AmbientLimits& limits) : tree(limits) {}
        RecordTree tree;
        std::vector<std::uint32_t> numbers;  ///< of its records
    };
    struct Record {
        Rgb value;
        std::size_t first = 0, columns = 0, records = 0;  ///< its terms: begin, and how many
    };
    [[nodiscard]] const Level* level(int number) const;

    AmbientLimits limits_;
    double effort_;
    std::deque<Level> levels_;
    std::vector<Record> records_;
    std::vector<CoefficientTerm> terms_;
};

/// Adds up records times coefficients. Belongs to one thread.
class CoefficientSums {
  public:
    /// @param cache  must outlive this
    explicit CoefficientSums(const CoefficientCache& cache) : cache_(cache) {}
    /// Records that are added between two calls of take() are of one level.
    void add(std::uint32_t record, const Rgb& coefficient);
    /// Removes the sums, each of one record.
    [[nodiscard]] std::vector<CoefficientTerm> take();
    /// Removes the sums, and adds what they stand for to `sums`: three numbers a column.
    void take(std::span<double> sums);

  private:
    const CoefficientCache& cache_;
    std::vector<Rgb> weights_;            ///< by record
    std::vector<char> is_touched_;        ///< by record
    std::vector<std::uint32_t> touched_;  ///< in the order of their first coefficients
};

}  // namespace lightwalk
