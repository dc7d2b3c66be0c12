#pragma once
// Rays as rtrace takes them: six numbers each, as text or binary.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/math/vec3.h"

namespace lightwalk {

/// How numbers are written. Source: Radiance manual page rtrace(1), -f.
enum class NumberFormat {
    text,    ///< a
    real32,  ///< f: the machine's float
    real64,  ///< d: the machine's double
    rgbe,    ///< c: four-byte shared-exponent colour, output only
};

struct RayFormats {
    NumberFormat input = NumberFormat::text, output = NumberFormat::text;
};
/// The letters attached to -f: input and output, or one for both. Nothing when they are not
/// formats.
[[nodiscard]] std::optional<RayFormats> parse_ray_formats(std::string_view letters);

struct InputRay {
    Vec3 origin, direction;  ///< of any length; a zero direction asks for a flush
    [[nodiscard]] bool is_flush() const { return direction == Vec3{}; }
};

/// Reads rays from a file descriptor as they arrive: it never waits for more bytes than the next
/// ray needs.
class RayReader {
  public:
    RayReader(int descriptor, NumberFormat format) : descriptor_(descriptor), format_(format) {}

    /// The next ray. Nothing at the end of the input, which is also an incomplete ray or a word
    /// that is no number.
    [[nodiscard]] std::optional<InputRay> next();
    /// Whether next() would have to wait for the sender, because nothing of another ray has
    /// arrived.
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
