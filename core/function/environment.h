#pragma once
// The definitions of all function files of a scene, by context, and the compiler from them to
// Programs.
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/function/program.h"

namespace lightwalk {

class FunctionEnvironment {
  public:
    /// With the built-in initialisation library (the definitions of Radiance's rayinit.cal).
    /// Without: only the core library plus PI, hermite, bezier, bspline, as the generators
    /// (gensurf, genrev, genworm) have it.
    /// It is read when it is first asked for, as most scenes have no functions: an environment is
    /// for one thread.
    enum class Library { renderer, generator };
    explicit FunctionEnvironment(Library library = Library::renderer);
    ~FunctionEnvironment();
    FunctionEnvironment(FunctionEnvironment&&) noexcept;
    FunctionEnvironment& operator=(FunctionEnvironment&&) noexcept;

    /// Whether the context of file `name` ("." counts as loaded) exists already.
    [[nodiscard]] bool loaded(std::string_view name) const;

    /// Parse function file `name` with contents `text` into its context. Throws InputError
    /// "name:line: ...".
    void load(const std::string& name, std::string_view text);

    /// Evaluate definitions in the global context (`-e expr` of generators). Throws
    /// InputError.
    void define(std::string_view text, const SourceLocation& where);

    /// Compile `requests` in the context of `file` for a primitive with these real arguments.
    /// `material_channels`: which of NxP.. DzA the primitive sets; a reference to another one is an
    /// undefined variable. Throws InputError at `where` for syntax errors and bad constants.
    [[nodiscard]] Program compile(std::string_view file,
                                  std::span<const ExpressionRequest> requests,
                                  std::span<const double> reals, ChannelMask material_channels,
                                  const SourceLocation& where) const;

    /// As compile(), but primitives with the same requests and arguments (generators write
    /// thousands of such) share one program. Programs that can throw at run time are not shared, as
    /// their errors carry `where`.
    [[nodiscard]] Program shared_program(std::string_view file,
                                         std::span<const ExpressionRequest> requests,
                                         std::span<const double> reals,
                                         ChannelMask material_channels,
                                         const SourceLocation& where);

    /// The intermediate results of compile() as text; README.md in core/function explains an
    /// example.
    struct Listing {
        std::string graph, code;
    };
    [[nodiscard]] Listing listing(std::string_view file,
                                  std::span<const ExpressionRequest> requests,
                                  std::span<const double> reals, ChannelMask material_channels,
                                  const SourceLocation& where) const;

    /// Number of parameters of the function that `name` refers to in the context of `file`; 0 when
    /// there is none. Library functions: their argument count (1 for min, max, select).
    [[nodiscard]] int parameters(std::string_view file, std::string_view name) const;
    /// Whether `name` refers to a function (user or library) in the context of `file`.
    [[nodiscard]] bool is_function(std::string_view file, std::string_view name) const;

  private:
    struct Impl;
    /// With the initial definitions, which are read now unless they have been.
    Impl& started() const;

    Library library_;
    mutable std::unique_ptr<Impl> impl_;  ///< null: nothing has been asked for
};

}  // namespace lightwalk
