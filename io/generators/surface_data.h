#pragma once
// Tables of numbers that take the place of gensurf's functions.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lightwalk {

/// Values at the vertices or the centres of an m x n grid, interpolated linearly and extrapolated
/// so too.
class SurfaceData {
  public:
    /// `text` holds numbers separated by white space, `channels` for each point, s fastest. Throws
    /// InputError naming `where`: for what is not a number, and when there are neither (m+1)(n+1)
    /// points nor m n.
    SurfaceData(std::string_view text, const std::string& where, std::size_t m, std::size_t n,
                std::size_t channels);

    [[nodiscard]] double value(std::size_t channel, double s, double t) const;

  private:
    std::vector<double> values_;
    std::size_t channels_, columns_ = 0, rows_ = 0;
    double scale_s_, scale_t_, offset_ = 0;
};

/// All numbers of a text, separated by white space. Throws InputError "WHERE:LINE: ...", also when
/// there are more than `most`.
[[nodiscard]] std::vector<double> parse_numbers(std::string_view text, const std::string& where,
                                                std::size_t most);

}  // namespace lightwalk
