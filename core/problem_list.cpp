#include "core/problem_list.h"

namespace lightwalk {

void ProblemList::add(const SourceLocation& where, const std::string& message,
                      const std::string& kind, std::size_t told) {
    if (++counts_[kind] <= told) lines_.push_back({to_prefix(where) + message, kind});
}

std::string ProblemList::text() const {
    std::map<std::string, std::size_t> left = counts_;  // of each kind, after the lines so far
    std::map<std::string, std::size_t> lines;
    for (const Line& line : lines_) ++lines[line.kind];
    std::string text;
    for (const Line& line : lines_) {
        if (!text.empty()) text += '\n';
        text += line.text;
        if (line.kind.empty()) continue;
        --left[line.kind];
        if (--lines[line.kind] == 0 && left[line.kind] > 0)
            text += " (and " + std::to_string(left[line.kind]) + " more)";
    }
    return text;
}

void ProblemList::raise() const {
    if (!empty()) throw InputError(text());
}

}  // namespace lightwalk
