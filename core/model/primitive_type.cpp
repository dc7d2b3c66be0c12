#include "core/model/primitive_type.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lightwalk {
namespace {

struct Row {
    std::string_view word;
    PrimitiveKind kind;
};

/// The rows of all types, in the order of PrimitiveType.
constexpr std::array kRows = {
#define PRIMITIVE(id, word, kind) Row{word, PrimitiveKind::kind},
#include "core/model/primitive_types.def"
};

const Row& row(PrimitiveType type) {
    return kRows[static_cast<std::size_t>(type)];
}

}  // namespace

std::string_view to_string(PrimitiveType type) {
    return row(type).word;
}

std::optional<PrimitiveType> primitive_type(std::string_view word) {
    const auto found = std::find_if(kRows.begin(), kRows.end(), [word](const Row& candidate) {
        return candidate.word == word;
    });
    if (found == kRows.end()) return std::nullopt;
    return static_cast<PrimitiveType>(found - kRows.begin());
}

PrimitiveKind kind_of(PrimitiveType type) {
    return row(type).kind;
}

std::size_t primitive_type_count() {
    return kRows.size();
}

}  // namespace lightwalk
