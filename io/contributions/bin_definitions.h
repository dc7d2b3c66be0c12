#pragma once
// Expressions that choose a bin by where a ray meets an emitter, and from where (rcontrib's -b),
// with the definitions that they use (-e, -f).
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/function/environment.h"
#include "core/math/vec3.h"
#include "io/files/library_path.h"

namespace lightwalk {

/// Definitions in the order in which they were given; later ones replace earlier ones.
class BinDefinitions {
  public:
    /// @param text  "name = expression; ...". Throws InputError for wrong syntax.
    void add_expression(const std::string& text);
    /// A function file along the library path. Throws InputError.
    void add_file(const std::string& name, const LibraryPath& library);

    /// An expression of Px Py Pz Dx Dy Dz. Throws InputError for wrong syntax, undefined names and
    /// other variables of a ray.
    /// @param parameters  "name=value, ...": definitions for this expression alone; "" for none
    [[nodiscard]] Program bin(const std::string& expression, const std::string& parameters) const;
    /// The value of a constant expression, rounded to an integer of at least 1. Throws InputError.
    [[nodiscard]] int count(const std::string& expression, const std::string& parameters) const;

  private:
    struct Definitions {
        std::string text;
        SourceLocation where;
    };
    void add(Definitions definitions);
    [[nodiscard]] FunctionEnvironment environment(const std::string& parameters) const;

    std::vector<Definitions> definitions_;
};

/// Whether the bin depends on where the emitter is met.
[[nodiscard]] bool depends_on_position(const Program& bin);

/// Chooses bins. Belongs to one thread.
class BinChooser {
  public:
    /// The number of the bin that `bin` chooses: its value rounded to the nearest integer; nothing
    /// where this is negative. Throws InputError for names that are not defined.
    /// @param direction  unit, of the ray, towards the emitter
    /// @param position   where it is met [m]
    [[nodiscard]] std::optional<std::size_t> choose(const Program& bin, const Vec3& direction,
                                                    const Vec3& position);

  private:
    EvalState state_;
    ChannelValues channels_{};
};

}  // namespace lightwalk
