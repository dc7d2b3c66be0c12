#pragma once
// Tables of lamps: their colours, and how much light they lose with age.
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/rgb.h"

namespace lightwalk {

struct Lamp {
    double x = 1.0 / 3, y = 1.0 / 3;  ///< CIE 1931 chromaticity
    double depreciation = 1;          ///< mean by initial lumens
    /// Of luminance 1 times depreciation. Colours beyond the primaries lose saturation.
    [[nodiscard]] Rgb color() const;
};

/// The patterns of a table in their order. A line is a regular expression between two equal
/// characters, upper and lower case alike, and the lamp: x, y and depreciation, or another lamp's
/// name in brackets. `#` begins a comment. Source: Radiance's manual page ies2rad(1), lamp.tab.
class LampTable {
  public:
    /// Throws InputError "NAME:LINE: ...".
    LampTable(std::string_view text, const std::string& name);
    ~LampTable();
    LampTable(LampTable&&) noexcept;
    LampTable& operator=(LampTable&&) noexcept;
    LampTable(const LampTable&) = delete;
    LampTable& operator=(const LampTable&) = delete;

    /// The lamp of the first pattern that is found in `text`; nothing when none is.
    [[nodiscard]] std::optional<Lamp> find(std::string_view text) const;

  private:
    struct Row;
    std::vector<Row> rows_;
};

}  // namespace lightwalk
