#pragma once
// What generators write: scene text that begins with the command line, bounded in size.
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

/// The largest number of pieces that a generator makes: more would not fit into its output.
inline constexpr std::size_t kMaxPieces = std::size_t{1} << 22;

/// Collects the output of one generator. Numbers have 12 significant digits.
class SceneWriter {
  public:
    /// Begins with the comment "# program words...". `args` must outlive the writer.
    /// @param sink  takes what is written as soon as it is long enough for a piece; null: all of it
    ///              is kept for release()
    explicit SceneWriter(std::span<const std::string> args, TextSink* sink = nullptr);

    /// Append a primitive. Throws InputError for a number that is not finite, and when the output
    /// grows beyond kMaxGeneratedBytes, or kMaxStreamedBytes with a sink.
    void write(std::string_view modifier, std::string_view type, std::string_view name,
               std::span<const double> reals);
    void write(std::string_view modifier, std::string_view type, std::string_view name,
               std::span<const double> reals, std::span<const std::string> strings);
    void polygon(std::string_view modifier, std::string_view name, std::span<const Vec3> vertices);
    /// The same with vertices from append_vertex, which are finite.
    void polygon(std::string_view modifier, std::string_view name,
                 std::span<const std::string_view> vertices);
    void sphere(std::string_view modifier, std::string_view name, const Vec3& center,
                double radius);
    void cylinder(std::string_view modifier, std::string_view name, const Vec3& p, const Vec3& q,
                  double radius);

    /// Append text as it is: whole items of the language.
    void text(std::string_view text);
    /// What no sink has taken.
    [[nodiscard]] std::string release() { return std::move(out_); }

  private:
    void check_size();

    const std::string& program_;
    PrimitiveText primitive_;  ///< reused, so that writing does not allocate
    TextSink* sink_;
    std::string out_;
    std::size_t handed_over_ = 0;  ///< bytes that the sink has taken
};

/// Append a vertex as polygons list them: on a line of its own.
void append_vertex(const Vec3& vertex, std::string& out);

/// The comment line that echoes a command: "# program words...", words quoted as the shell needs
/// them.
[[nodiscard]] std::string command_comment(std::span<const std::string> args);

/// `value` as printf's %.Ng, %.Nf and %.Ne write it in the C locale.
[[nodiscard]] std::string general(double value, int digits);
[[nodiscard]] std::string fixed(double value, int decimals);
[[nodiscard]] std::string scientific(double value, int decimals);

}  // namespace lightwalk
