#pragma once
// Tables of numbers as arguments of gensurf, in place of functions.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lightwalk {

/// Values at the vertices or the cell centres of an m x n grid, with linear interpolation and
/// extrapolation.
class SurfaceData {
  public:
    /// `text` is a list of numbers separated by white space, `channels` for each point, s fastest.
    /// Throws InputError with `where` for a word that is no number, and when there are neither
    /// (m+1)(n+1) nor m n points.
    SurfaceData(std::string_view text, const std::string& where, std::size_t m, std::size_t n,
                std::size_t channels);

    [[nodiscard]] double value(std::size_t channel, double s, double t) const;

  private:
    std::vector<double> values_;
    std::size_t channels_, columns_ = 0, rows_ = 0;
    double scale_s_, scale_t_, offset_ = 0;
};

/// The numbers of a text, which are separated by white space. Throws InputError "WHERE:LINE: ..."
/// for other words, and for more than `most` numbers.
[[nodiscard]] std::vector<double> parse_numbers(std::string_view text, const std::string& where,
                                                std::size_t most);

}  // namespace lightwalk
