#pragma once
// What the numbers of a material are called, and which of them make sense. See "The Radiance 6.x
// Scene Description Language" (Radiance's ray.pdf).
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/model/primitive.h"

namespace lightwalk {

/// One real argument.
struct ArgumentName {
    std::string_view quantity;  ///< "reflectance": of three channels in a row; else its own name
    std::string_view channel;   ///< "red", "green", "blue", "x", "y", "z", or none
    double low = 0, high = 1;   ///< what makes sense, both included
    std::string_view unit;      ///< "" where it has none
};

/// The real arguments of a material by name, as many as it has. Nothing for types whose numbers
/// mean what their strings say (functions, data), for those without numbers, and where there are
/// more or fewer than the type takes.
[[nodiscard]] std::vector<ArgumentName> argument_names(const Primitive& primitive);

/// Why a material cannot have these numbers in place of its own, in words for a reader; nothing:
/// it can. Numbers that are its own already are never the reason.
[[nodiscard]] std::optional<std::string> argument_problem(const Primitive& primitive,
                                                          std::span<const double> reals);

}  // namespace lightwalk
