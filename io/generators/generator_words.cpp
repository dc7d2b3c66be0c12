#include "io/generators/generator_words.h"

#include <cmath>

#include "core/model/transform_args.h"

namespace lightwalk {

const std::string& GeneratorWords::text(std::string_view what) {
    if (at_end()) fail("missing " + std::string(what));
    return args_[at_++];
}

double GeneratorWords::real(std::string_view what) {
    const std::string& word = text(what);
    double value = 0;
    if (!parse_real(word, value) || !std::isfinite(value)) {
        fail("bad " + std::string(what) + " \"" + word + "\", expected a number");
    }
    return value;
}

double GeneratorWords::positive(std::string_view what) {
    const double value = real(what);
    if (value <= 0) {
        fail("bad " + std::string(what) + " \"" + args_[at_ - 1] + "\", expected more than 0");
    }
    return value;
}

long GeneratorWords::integer(std::string_view what, long least, long most) {
    const std::string& word = text(what);
    long value = 0;
    if (!parse_integer(word, value) || value < least || value > most) {
        fail("bad " + std::string(what) + " \"" + word + "\", expected a whole number from " +
             std::to_string(least) + " to " + std::to_string(most));
    }
    return value;
}

bool GeneratorWords::accept(std::string_view word) {
    if (at_end() || args_[at_] != word) return false;
    ++at_;
    return true;
}

void GeneratorWords::fail(const std::string& what) const {
    throw InputError(args_[0] + ": " + what + "; usage: " + args_[0] + " " + std::string(usage_));
}

void GeneratorWords::unknown_option() const {
    fail("unknown option \"" + args_[at_] + "\"");
}

}  // namespace lightwalk
