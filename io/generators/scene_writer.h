#pragma once
// Writes the output of generators: scene text of bounded size that begins with the command line.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/math/vec3.h"
#include "io/generators/text_sink.h"
#include "io/language/command_line.h"
#include "io/language/primitive_text.h"

namespace lightwalk {

/// The largest number of surfaces that a generator makes; more would not fit into its output.
inline constexpr std::size_t kMaxPieces = std::size_t{1} << 22;

/// Collects the output of one generator. Numbers have 12 significant digits.
class SceneWriter {
  public:
    /// Writes the comment "# program words...". `args` must outlive the writer.
    /// @param sink  receives the output in parts of about kPieceBytes; null: all output is kept for
    ///              release()
    explicit SceneWriter(std::span<const std::string> args, TextSink* sink = nullptr);

    /// Append a primitive. Throws InputError for a number that is not finite, and when the output
    /// grows beyond kMaxGeneratedBytes, or kMaxStreamedBytes with a sink.
    void write(std::string_view modifier, std::string_view type, std::string_view name,
               std::span<const double> reals);
    void write(std::string_view modifier, std::string_view type, std::string_view name,
               std::span<const double> reals, std::span<const std::string> strings);
    void polygon(std::string_view modifier, std::string_view name, std::span<const Vec3> vertices);
    /// Append a polygon whose vertices are texts from append_vertex().
    void polygon(std::string_view modifier, std::string_view name,
                 std::span<const std::string_view> vertices);
    void sphere(std::string_view modifier, std::string_view name, const Vec3& center,
                double radius);
    void cylinder(std::string_view modifier, std::string_view name, const Vec3& p, const Vec3& q,
                  double radius);

    /// Append whole items of the scene language as text.
    void text(std::string_view text);
    /// Remove and return the output that has not been passed to the sink.
    [[nodiscard]] std::string release() { return std::move(out_); }

  private:
    void check_size();

    const std::string& program_;
    PrimitiveText primitive_;  ///< reused, so that writing does not allocate
    TextSink* sink_;
    std::string out_;
    std::size_t handed_over_ = 0;  ///< bytes that have been passed to the sink
};

/// Append a vertex in the form that polygons have: on a line of its own.
void append_vertex(const Vec3& vertex, std::string& out);

/// The comment line that repeats a command, "# program words...", with words in quotes where the
/// shell needs them.
[[nodiscard]] std::string command_comment(std::span<const std::string> args);

// `value` as text in the format %.Ng, %.Nf or %.Ne of printf in the C locale.
[[nodiscard]] std::string general(double value, int digits);
[[nodiscard]] std::string fixed(double value, int decimals);
[[nodiscard]] std::string scientific(double value, int decimals);

}  // namespace lightwalk
