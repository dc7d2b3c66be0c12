#include "io/rad/rad_views.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <string_view>

#include "core/model/transform_args.h"

namespace lightwalk {
namespace {

/// A standard view: its sides, 1: that of the largest coordinate, -1: of the smallest, 0: the
/// middle; and its type.
struct StandardView {
    std::array<int, 3> sides{};
    char type = 'v';
};

std::optional<StandardView> standard_view(std::string_view name) {
    constexpr std::string_view kLarge = "XYZ", kSmall = "xyz", kTypes = "vlahcs";
    StandardView view;
    bool any = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (name.empty()) break;
        view.sides[axis] = name[0] == kLarge[axis] ? 1 : name[0] == kSmall[axis] ? -1 : 0;
        if (view.sides[axis] == 0) continue;
        any = true;
        name.remove_prefix(1);
    }
    if (name.size() == 1 && kTypes.find(name[0]) != std::string_view::npos) {
        view.type = name[0];
        name.remove_prefix(1);
    }
    if (!any || !name.empty()) return std::nullopt;
    return view;
}

/// As rad writes them: to three digits.
std::string short_number(double x) {
    std::array<char, 32> text{};
    (void)std::snprintf(text.data(), text.size(), "%.3g", x);
    return text.data();
}

void add_vector(const char* option, const Vec3& v, std::vector<std::string>& words) {
    words.insert(words.end(), {option, short_number(v.x), short_number(v.y), short_number(v.z)});
}

/// Up, or another axis for a view along it.
Vec3 up_for(const Vec3& up, const std::array<int, 3>& sides) {
    const std::array<double, 3> axis{up.x, up.y, up.z};
    std::size_t vertical = 0;
    while (axis[vertical] == 0) ++vertical;
    for (std::size_t i = 0; i < 3; ++i)
        if ((sides[i] != 0) != (i == vertical)) return up;
    std::array<double, 3> other{};
    other[(vertical + 2) % 3] = 1;
    return {other[0], other[1], other[2]};
}

std::vector<std::string> standard_words(const StandardView& view, const RadZone& zone,
                                        const Vec3& up) {
    const double distance = zone.exterior ? 2 : 0.45;  // [sizes of the zone]
    const Vec3 size = zone.upper - zone.lower;
    const Vec3 offset{view.sides[0] * size.x, view.sides[1] * size.y, view.sides[2] * size.z};
    std::vector<std::string> words{std::string("-vt") + view.type};
    add_vector("-vp", 0.5 * (zone.lower + zone.upper) + distance * offset, words);
    add_vector("-vd", Vec3{} - offset, words);
    add_vector("-vu", up_for(up, view.sides), words);
    std::string width = "45", height = "45";
    if (view.type == 'l') width = height = short_number(length(size));
    if (view.type == 'a' || view.type == 'h' || view.type == 's') width = height = "180";
    if (view.type == 'c') width = "180", height = "90";
    words.insert(words.end(), {"-vh", width, "-vv", height});
    return words;
}

}  // namespace

RadView rad_view(const std::vector<std::string>& words, const SourceLocation& where) {
    RadView view{"", words, where, false};
    if (words.empty() || words[0].starts_with('-')) return view;
    view.name = words[0];
    view.words.erase(view.words.begin());
    view.standard = standard_view(view.name).has_value();
    if (!view.standard && view.words.empty())
        throw InputError(where, "view \"" + view.name +
                                    "\" has no options, and is none of the standard views X, x, "
                                    "Yl, xyZ ...");
    return view;
}

RadView find_rad_view(const RadPlan& plan, const std::string& name) {
    long number = 0;
    if (parse_integer(name, number) && number >= 1 &&
        static_cast<std::size_t>(number) <= plan.views.size())
        return plan.views[static_cast<std::size_t>(number) - 1];
    const auto found = std::ranges::find(plan.views, name, &RadView::name);
    if (found != plan.views.end() && !name.empty()) return *found;
    if (standard_view(name)) return rad_view({name}, {plan.name, 0});
    std::string known;
    for (std::size_t i = 0; i < plan.views.size(); ++i)
        known += (i > 0 ? ", " : "") + plan.views[i].title(i + 1);
    throw InputError({plan.name, 0}, "has no view \"" + name + "\": its views are " + known +
                                         ", and the standard ones X, x, Yl, xyZ ...");
}

std::vector<std::string> rad_view_words(const RadPlan& plan, const RadView& view,
                                        const RadZone& zone) {
    std::vector<std::string> words;
    if (const std::optional<StandardView> standard = standard_view(view.name))
        words = standard_words(*standard, zone, plan.up.value_or(Vec3{0, 0, 1}));
    else if (plan.up && !view.name.empty())  // views without a name have rpict's own
        add_vector("-vu", *plan.up, words);
    words.insert(words.end(), view.words.begin(), view.words.end());
    return words;
}

}  // namespace lightwalk
