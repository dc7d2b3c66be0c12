#include "io/options/view_keys.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/model/transform_args.h"
#include "io/options/view_text.h"

namespace lightwalk {
namespace {

/// Take the number at the front of a line; nothing, and the line as it was, where there is none.
std::optional<double> take_time(std::string_view& line) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    double time = 0;
    if (!parse_real(std::string(line.substr(0, end)), time) || !std::isfinite(time))
        return std::nullopt;
    line.remove_prefix(std::min(line.find_first_not_of(" \t", end), line.size()));
    return time;
}

}  // namespace

std::vector<ViewKey> read_view_keys(std::string_view text, const std::string& name, View view) {
    std::vector<ViewKey> keys;
    for (std::int32_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.ends_with('\r')) line.remove_suffix(1);
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
        if (line.empty() || line.starts_with('#')) continue;
        const SourceLocation where{name, number};
        const std::optional<double> time = take_time(line);
        const std::vector<View> views = read_view_sequence(line, view);
        if (views.size() != 1)
            throw InputError(where, "expected a view like \"VIEW= -vp x y z -vd x y z\", found \"" +
                                        std::string(line) + "\"");
        view = views.front();
        if (const std::optional<std::string> wrong = Camera::problem(view))
            throw InputError(where, *wrong);
        keys.push_back({time.value_or(keys.empty() ? 0 : keys.back().time + 1), view});
        if (const std::optional<std::string> wrong = ViewPath::problem(keys))
            throw InputError(where, *wrong);
    }
    if (keys.empty())
        throw InputError({name, 0}, "no line like \"VIEW= -vp x y z -vd x y z\": no path");
    return keys;
}

}  // namespace lightwalk
