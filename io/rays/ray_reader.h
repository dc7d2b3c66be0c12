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

    /// The next ray. Nothing at the end of the input, and where something is wrong with it: see
    /// problem().
    [[nodiscard]] std::optional<InputRay> next();
    /// Whether next() would block, because no byte of another ray has arrived.
    [[nodiscard]] bool drained();

    /// Why the input could not be read to its end: a word that is no number, an incomplete ray, a
    /// number that is not finite, an error of the system; with the line, or for binary input the
    /// ray, where it stands. "": nothing is wrong so far.
    [[nodiscard]] const std::string& problem() const { return problem_; }
    /// The first line of text within which a ray begins that ends in another line, as where lines
    /// have seven columns: legal, but hardly meant. 0: none so far.
    [[nodiscard]] std::size_t misaligned_line() const { return misaligned_line_; }

  private:
    enum class Found { number, end, fault };
    bool fill();
    [[nodiscard]] Found number(double& value);
    [[nodiscard]] Found number_of_text(double& value);
    [[nodiscard]] Found number_of_bytes(double& value);
    [[nodiscard]] Found word(std::string& text);
    [[nodiscard]] int byte();  ///< -1 at the end
    void note_lines(std::size_t first_line);
    Found fail(const std::string& what);

    int descriptor_;
    NumberFormat format_;
    std::string buffer_, problem_;
    std::size_t at_ = 0;
    std::size_t rays_ = 0;       ///< read so far
    std::size_t line_ = 1;       ///< of the next byte of text
    std::size_t word_line_ = 1;  ///< of the word that was read last
    std::size_t last_line_ = 0;  ///< in which the ray before ended
    std::size_t misaligned_line_ = 0;
    bool ended_ = false;
};

}  // namespace lightwalk
