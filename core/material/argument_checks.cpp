#include "core/material/argument_checks.h"

#include <cmath>
#include <string>

namespace lightwalk {
namespace {

InputError wrong_count(const Primitive& primitive, const char* what, const char* bound,
                       std::size_t expected, std::size_t given) {
    return InputError(primitive.where, std::string("bad number of ") + what + "arguments for " +
                                           std::string(to_string(primitive.type)) + " \"" +
                                           primitive.name + "\": " + bound +
                                           std::to_string(expected) + " expected, " +
                                           std::to_string(given) + " given");
}

}  // namespace

void require_exact_reals(const Primitive& primitive, std::size_t count) {
    if (primitive.reals.size() != count)
        throw wrong_count(primitive, "", "", count, primitive.reals.size());
}

void require_least_reals(const Primitive& primitive, std::size_t count) {
    if (primitive.reals.size() < count) {
        throw wrong_count(primitive, "", "at least ", count, primitive.reals.size());
    }
}

void require_least_strings(const Primitive& primitive, std::size_t count) {
    if (primitive.strings.size() < count) {
        throw wrong_count(primitive, "string ", "at least ", count, primitive.strings.size());
    }
}

void require_most_strings(const Primitive& primitive, std::size_t count) {
    if (primitive.strings.size() > count) {
        throw wrong_count(primitive, "string ", "at most ", count, primitive.strings.size());
    }
}

void require_index(const Primitive& primitive, double index) {
    if (index > 0 && std::isfinite(index)) return;
    throw InputError(primitive.where, std::string(to_string(primitive.type)) + " \"" +
                                          primitive.name +
                                          "\": illegal index of refraction: it must be positive");
}

ModifierId alternate_of(const ModifierBuild& build) {
    const Primitive& primitive = build.primitive;
    if (primitive.strings.empty()) return kVoid;
    if (!build.undefined(0)) return build.reference(0);
    build.warnings.warn(to_prefix(primitive.where) + std::string(to_string(primitive.type)) +
                        " \"" + primitive.name + "\": undefined modifier \"" +
                        primitive.strings[0] + "\"");
    return kVoid;
}

}  // namespace lightwalk
