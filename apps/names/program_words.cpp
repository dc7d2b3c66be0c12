#include "apps/names/program_words.h"

#include <span>

#include "core/model/transform_args.h"
#include "io/options/option_words.h"

namespace lightwalk {

bool ProgramWords::at_option() const {
    return !at_end() && words_[at_].size() > 1 && words_[at_][0] == '-';
}

std::vector<std::string> ProgramWords::rest() const {
    return {words_.begin() + static_cast<std::ptrdiff_t>(at_), words_.end()};
}

std::string ProgramWords::history(const std::string& program) const {
    const std::string line = history_line(std::span(words_).first(at_));
    return program + (line.empty() ? "" : ' ' + line);
}

std::string ProgramWords::option() const {
    return words_[at_ - 1];
}

const std::string& ProgramWords::text(std::string_view what) {
    if (at_end()) throw UsageError("option " + option() + ": expected " + std::string(what));
    return take();
}

double ProgramWords::real(std::string_view what) {
    const std::string& word = text(what);
    double value = 0;
    if (!parse_real(word, value))
        throw UsageError("expected " + std::string(what) + ", found \"" + word + '"');
    return value;
}

int ProgramWords::integer(std::string_view what, int least, int most) {
    const std::string& word = text(what);
    long value = 0;
    if (!parse_integer(word, value) || value < least || value > most)
        throw UsageError("expected " + std::string(what) + " from " + std::to_string(least) +
                         " to " + std::to_string(most) + ", found \"" + word + '"');
    return static_cast<int>(value);
}

void ProgramWords::unknown() const {
    throw UsageError("unknown option: '" + option() + "'");
}

void ProgramWords::refuse(const std::string& instead) const {
    throw UsageError("option " + option() + " is not supported: " + instead);
}

}  // namespace lightwalk
