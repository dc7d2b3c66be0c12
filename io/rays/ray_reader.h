#pragma once
// Reads rays in rtrace's input formats: six numbers each, as text or binary.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/math/vec3.h"

namespace lightwalk {

/// The formats of numbers, with their letters. Source: Radiance manual page rtrace(1), -f.
enum class NumberFormat {
    text,    ///< a: text
    real32,  ///< f: the machine's float
    real64,  ///< d: the machine's double
    rgbe,    ///< c: colours of four bytes with a shared exponent, output only
};

struct RayFormats {
    NumberFormat input = NumberFormat::text, output = NumberFormat::text;
};
/// The formats that the letters after -f stand for: input and output, or one letter for both.
/// Nothing for other letters.
[[nodiscard]] std::optional<RayFormats> parse_ray_formats(std::string_view letters);

struct InputRay {
    Vec3 origin, direction;  ///< the direction has any length; 0 asks for a flush
    [[nodiscard]] bool is_flush() const { return direction == Vec3{}; }
};

/// Reads rays from a file descriptor as they arrive: it never blocks for more bytes than the next
/// ray needs.
class RayReader {
  public:
    RayReader(int descriptor, NumberFormat format) : descriptor_(descriptor), format_(format) {}

    /// The next ray. Nothing at the end of the input; an incomplete ray and a word that is no
    /// number count as the end.
    [[nodiscard]] std::optional<InputRay> next();
    /// Whether next() would block, because no byte of another ray has arrived.
    [[nodiscard]] bool drained();

  private:
    bool fill();
    [[nodiscard]] bool number(double& value);
    [[nodiscard]] bool word(std::string& text);
    [[nodiscard]] int byte();  ///< -1 at the end

    int descriptor_;
    NumberFormat format_;
    std::string buffer_;
    std::size_t at_ = 0;
    bool ended_ = false;
};

}  // namespace lightwalk
