#include "core/texture/arguments.h"

namespace lightwalk {

InputError modifier_error(const Primitive& primitive, const std::string& problem) {
    return InputError(primitive.where, std::string(to_string(primitive.type)) + " \"" +
                                           primitive.name + "\": " + problem);
}

void require_arguments(const Primitive& primitive, std::size_t strings, std::size_t reals) {
    if (primitive.strings.size() < strings) {
        throw modifier_error(primitive, "bad number of string arguments: at least " +
                                            std::to_string(strings) + " expected, " +
                                            std::to_string(primitive.strings.size()) + " given");
    }
    if (primitive.reals.size() < reals) {
        throw modifier_error(primitive, "bad number of real arguments: at least " +
                                            std::to_string(reals) + " expected, " +
                                            std::to_string(primitive.reals.size()) + " given");
    }
}

}  // namespace lightwalk
