#include "core/view/view_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/error.h"

namespace lightwalk {
namespace {

constexpr std::size_t kViewNumbers = 15;
using ViewNumbers = std::array<double, kViewNumbers>;

ViewNumbers numbers_of(const View& v) {
    return {v.position.x,  v.position.y, v.position.z, v.direction.x, v.direction.y,
            v.direction.z, v.up.x,       v.up.y,       v.up.z,        v.horizontal,
            v.vertical,    v.fore,       v.aft,        v.shift,       v.lift};
}

View view_of(char type, const ViewNumbers& n) {
    // Clamped, as splines overshoot zero where a clipping distance ends or begins.
    return {type,
            {n[0], n[1], n[2]},
            {n[3], n[4], n[5]},
            {n[6], n[7], n[8]},
            n[9],
            n[10],
            std::max(n[11], 0.0),
            std::max(n[12], 0.0),
            n[13],
            n[14]};
}

}  // namespace

std::optional<std::string> ViewPath::problem(const std::vector<ViewKey>& keys) {
    if (keys.empty()) return "a path needs a view";
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (!(keys[i].time > keys[i - 1].time)) return "the times of a path must rise";
        if (keys[i].view.type != keys[0].view.type) return "the views of a path are of one type";
    }
    return std::nullopt;
}

ViewPath::ViewPath(std::vector<ViewKey> keys) : keys_(std::move(keys)) {
    if (const std::optional<std::string> wrong = problem(keys_)) throw InputError(*wrong);
}

View ViewPath::at(double time) const {
    if (!(time > begin())) return keys_.front().view;
    if (time >= end()) return keys_.back().view;
    const auto after = std::upper_bound(keys_.begin(), keys_.end(), time,
                                        [](double t, const ViewKey& key) { return t < key.time; });
    const auto i = static_cast<std::size_t>(after - keys_.begin()) - 1;
    const auto value = [&](std::size_t key) { return numbers_of(keys_[key].view); };
    const auto slope = [&](std::size_t key, std::size_t n) {
        const std::size_t from = key > 0 ? key - 1 : key, to = std::min(key + 1, keys_.size() - 1);
        return (value(to)[n] - value(from)[n]) / (keys_[to].time - keys_[from].time);
    };
    const double span = keys_[i + 1].time - keys_[i].time;
    const double s = (time - keys_[i].time) / span, r = 1 - s;
    ViewNumbers numbers{};
    for (std::size_t n = 0; n < kViewNumbers; ++n) {
        numbers[n] = r * r * (1 + 2 * s) * value(i)[n] + s * s * (1 + 2 * r) * value(i + 1)[n] +
                     span * s * r * (r * slope(i, n) - s * slope(i + 1, n));
    }
    return view_of(keys_[i].view.type, numbers);
}

View turned_view(const View& view, double degrees) {
    const double angle = degrees * (kPi / 180);
    const Vec3 axis = normalize(view.up);
    const Vec3 along = axis * dot(axis, view.direction), across = view.direction - along;
    View turned = view;
    turned.direction = along + across * std::cos(angle) + cross(across, axis) * std::sin(angle);
    return turned;
}

View walked_view(const View& view, WalkMove move, double steps, double step, double distance) {
    const double part = steps * step;
    if (move == WalkMove::turn) {
        constexpr double kFlatDegrees = 45;  // a parallel view has a width, no angle
        return turned_view(view, part * (view.type == 'l' ? kFlatDegrees : view.horizontal));
    }
    const Camera camera(view);
    const double angle = view.horizontal * (kPi / 180);
    const double width = view.type == 'l'   ? view.horizontal
                         : view.type == 'v' ? 2 * distance * std::tan(angle / 2)
                                            : distance * angle;
    View walked = view;
    const double way = part * width;
    switch (move) {
        case WalkMove::forward:
            walked.position += camera.forward() * way;
            break;
        case WalkMove::backward:
            walked.position -= camera.forward() * way;
            break;
        case WalkMove::left:
            walked.position -= camera.right() * way;
            break;
        default:
            walked.position += camera.right() * way;
            break;
    }
    return walked;
}

}  // namespace lightwalk
