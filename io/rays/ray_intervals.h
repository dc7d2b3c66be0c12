#pragma once
// Records of rays that were each answered several times: colours as means, each with the half-width
// of its 95 % confidence interval behind it.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "io/rays/ray_records.h"

namespace lightwalk {

/// Threads append the parts of records; join() makes records of those of all answers.
class RayIntervals {
  public:
    /// @param letters  the letters of -o: at least one colour, v r x, and of others those that do
    ///                 not depend on chance, o d w L p c n N s m M ~
    /// Throws UsageError for others, and for format c, which has no half-widths.
    RayIntervals(std::string_view letters, NumberFormat format, ColorOutput color);

    /// Appends what is kept of one answer to a ray: its colours, of the first answer all fields.
    /// @param answer  0 ... N - 1
    void append(const RayRecord& traced, const Scene& scene, int answer, std::string& bytes) const;
    /// Records from the parts of N >= 2 answers to the same rays, a string an answer, each ray by
    /// ray: in place of each number of a colour field the mean of the answers', and behind the
    /// field's numbers as many half-widths.
    [[nodiscard]] std::string join(std::span<const std::string> answers) const;

    /// See RayRecords.
    [[nodiscard]] std::string header_end(std::size_t bytes_before) const {
        return header_.header_end(bytes_before);
    }

  private:
    /// A colour, in doubles, or fields between colours, as they are written.
    struct Part {
        RayRecords records;
        int numbers;  ///< of a colour; 0: other fields
    };

    NumberFormat format_;
    RayRecords header_;
    std::vector<Part> parts_;
};

}  // namespace lightwalk
