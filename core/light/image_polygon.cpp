#include "core/light/image_polygon.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightwalk {

void ImagePolygon::remove(std::size_t i) {
    for (; i + 1 < count_; ++i) corner_[i] = corner_[i + 1];
    if (count_ > 0) --count_;
}

double ImagePolygon::area() const {
    double twice = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const ImagePoint &p = (*this)[i], &q = (*this)[i + 1];
        twice += p.x * q.y - q.x * p.y;
    }
    return 0.5 * std::abs(twice);
}

ImagePoint ImagePolygon::center() const {
    ImagePoint sum;
    for (std::size_t i = 0; i < count_; ++i) {
        sum.x += corner_[i].x;
        sum.y += corner_[i].y;
    }
    const auto n = static_cast<double>(std::max<std::size_t>(count_, 1));
    return {sum.x / n, sum.y / n};
}

double ImagePolygon::width(double y_scale) const {
    double least_squared = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count_; ++i) {
        const ImagePoint &p = (*this)[i], &q = (*this)[i + 1];
        const double ex = q.x - p.x, ey = (q.y - p.y) * y_scale;
        const double edge_squared = ex * ex + ey * ey;
        if (edge_squared <= 0) continue;
        double largest = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            const double twice_area =
                ex * (corner_[k].y - p.y) * y_scale - ey * (corner_[k].x - p.x);
            largest = std::max(largest, twice_area * twice_area / edge_squared);
        }
        least_squared = std::min(least_squared, largest);
    }
    return std::isinf(least_squared) ? 0 : std::sqrt(least_squared);
}

void ImagePolygon::make_convex() {
    for (std::size_t i = 0; i < count_ && count_ > 3;) {
        ImagePolygon without = *this;
        without.remove(i);
        if (without.area() >= area()) {
            *this = without;
            i = 0;
        } else {
            ++i;
        }
    }
}

ImagePolygon ImagePolygon::clip(double ImagePoint::*axis, double limit, bool keep_below) const {
    ImagePolygon kept;
    for (std::size_t i = 0; i < count_; ++i) {
        const ImagePoint &p = (*this)[i], &q = (*this)[i + 1];
        const bool p_in = keep_below ? p.*axis <= limit : p.*axis >= limit;
        const bool q_in = keep_below ? q.*axis <= limit : q.*axis >= limit;
        if (p_in) kept.add(p);
        if (p_in != q_in) {
            const double share = (limit - p.*axis) / (q.*axis - p.*axis);
            ImagePoint cut{p.x + (q.x - p.x) * share, p.y + (q.y - p.y) * share};
            cut.*axis = limit;
            kept.add(cut);
        }
    }
    return kept;
}

ImagePolygon ImagePolygon::clip_to_cell(int x0, int y0) const {
    return clip(&ImagePoint::x, x0, false)
        .clip(&ImagePoint::x, x0 + 1, true)
        .clip(&ImagePoint::y, y0, false)
        .clip(&ImagePoint::y, y0 + 1, true);
}

}  // namespace lightwalk
