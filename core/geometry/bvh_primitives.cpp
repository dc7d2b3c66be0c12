#include "core/geometry/bvh_primitives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>
#include <utility>

#include "core/geometry/bounds.h"
#include "core/geometry/cone_slices.h"
#include "core/geometry/polygon.h"

namespace lightwalk {
namespace {

constexpr std::size_t kDivisions = 20000;   ///< limit for all polygons of a model, and for all its
                                            ///< cones; half the number of its primitives is another
constexpr int kMostParts = 64;              ///< parts of one polygon at most
constexpr std::size_t kMostVertices = 128;  ///< polygons with more are not divided
constexpr double kLeastGain =
    1e-5;  ///< gain of a division, relative to the area of the model's box
constexpr double kThickness =
    1.0 / 16;  ///< least thickness of the parts of slanted polygons, relative to the polygon
constexpr double kMargin = 4 * kEpsilon;  ///< by which boxes are grown [m]
constexpr double kRim =
    3 * kEpsilon;  ///< width of the rim of a cell that boxes of adjacent cells overlap [m]
constexpr std::size_t kManyPrimitives =
    std::size_t{1} << 17;  ///< from here on pairs are made, and cones not divided
constexpr double kPairArea =
    0.75;  ///< largest area of a pair's box, relative to the sum of both boxes

struct Point {
    std::array<double, 2> at{};
};

/// A rectangle in the polygon's projection.
struct Cell {
    std::array<double, 2> lower{}, upper{};
    [[nodiscard]] double side(std::size_t k) const { return upper[k] - lower[k]; }
    [[nodiscard]] double area() const { return side(0) * side(1); }
};

double cross(const Point& a, const Point& b, const Point& p) {
    return (b.at[0] - a.at[0]) * (p.at[1] - a.at[1]) - (b.at[1] - a.at[1]) * (p.at[0] - a.at[0]);
}

/// Sutherland & Hodgman: the part of the polygon with sign * coordinate <= sign * limit.
void clip(const std::vector<Point>& polygon, std::size_t k, double limit, double sign,
          std::vector<Point>& out) {
    out.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &a = polygon[i == 0 ? polygon.size() - 1 : i - 1], &b = polygon[i];
        const double da = sign * (limit - a.at[k]), db = sign * (limit - b.at[k]);
        if ((da < 0) != (db < 0)) {
            Point on = a;
            const double t = da / (da - db);
            on.at[1 - k] += t * (b.at[1 - k] - a.at[1 - k]);
            on.at[k] = limit;
            out.push_back(on);
        }
        if (db >= 0) out.push_back(b);
    }
}

/// Buffers for clipping a polygon, which are reused: thousands are clipped while a scene is built.
struct Clipping {
    std::vector<Point> part, next;
};

double area_of(const std::vector<Point>& polygon) {
    double twice = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        twice += cross(polygon[0], polygon[i - 1], polygon[i]);
    return 0.5 * std::abs(twice);
}

/// A polygon as it is divided: its projection along the axis that the inside test ignores.
class Projection {
  public:
    explicit Projection(const PolygonShape& polygon)
        : polygon_(polygon),
          z_(static_cast<std::size_t>(polygon.drop_axis)),
          axes_{(z_ + 1) % 3, (z_ + 2) % 3} {
        points_.reserve(polygon.vertices.size());
        for (const Vec3 v : polygon.vertices) points_.push_back({{v[axes_[0]], v[axes_[1]]}});
        whole_.lower = whole_.upper = points_[0].at;
        for (const Point& p : points_) {
            for (std::size_t k = 0; k < 2; ++k) {
                whole_.lower[k] = std::min(whole_.lower[k], p.at[k]);
                whole_.upper[k] = std::max(whole_.upper[k], p.at[k]);
            }
        }
    }

    [[nodiscard]] const Cell& whole() const { return whole_; }
    [[nodiscard]] const std::vector<Point>& points() const { return points_; }

    /// Whether no hit can lie in the cell, except so near its rim that boxes of adjacent cells
    /// contain it.
    [[nodiscard]] bool is_empty(Cell cell) const {
        for (std::size_t k = 0; k < 2; ++k) {
            cell.lower[k] += kRim;
            cell.upper[k] -= kRim;
            if (cell.side(k) <= 0) return false;
        }
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (may_touch(points_[i == 0 ? points_.size() - 1 : i - 1], points_[i], cell))
                return false;
        }
        const double x = 0.5 * (cell.lower[0] + cell.upper[0]),
                     y = 0.5 * (cell.lower[1] + cell.upper[1]);
        return !contains(polygon_, on_plane(x, y), nullptr);
    }

    /// The area of the cell that the polygon does not cover. An approximation for polygons that
    /// cross themselves.
    [[nodiscard]] double waste(const Cell& cell, Clipping& scratch) const {
        scratch.part = points_;
        for (std::size_t k = 0; k < 2; ++k) {
            clip(scratch.part, k, cell.upper[k], 1, scratch.next);
            clip(scratch.next, k, cell.lower[k], -1, scratch.part);
        }
        const double free = cell.area() - area_of(scratch.part);
        return free > 1e-6 * cell.area() ? free : 0;
    }

    /// Extent along the axis of projection.
    [[nodiscard]] double thickness(const Cell& cell) const {
        return cell.side(0) * slope(0) + cell.side(1) * slope(1);
    }
    [[nodiscard]] double slope(std::size_t k) const {
        return std::abs(polygon_.normal[axes_[k]] / polygon_.normal[z_]);
    }

    /// Box of the hits in the cell.
    [[nodiscard]] Bounds box(const Cell& cell) const {
        Bounds bounds;
        for (unsigned corner = 0; corner < 4; ++corner) {
            bounds.extend(on_plane((corner & 1U) != 0 ? cell.upper[0] : cell.lower[0],
                                   (corner & 2U) != 0 ? cell.upper[1] : cell.lower[1]));
        }
        return grown(bounds, kMargin);
    }

  private:
    [[nodiscard]] Vec3 on_plane(double x, double y) const {
        Vec3 p;
        p[axes_[0]] = x;
        p[axes_[1]] = y;
        p[z_] = (polygon_.offset - dot(polygon_.normal, p)) / polygon_.normal[z_];
        return p;
    }

    /// Whether the inside test may accept a point of the cell for being on the edge. Its tolerance
    /// is an area within the edge's rectangle, a length elsewhere.
    [[nodiscard]] static bool may_touch(const Point& a, const Point& b, const Cell& cell) {
        for (std::size_t k = 0; k < 2; ++k) {
            if (std::max(a.at[k], b.at[k]) < cell.lower[k] - 0.5 * kRim ||
                std::min(a.at[k], b.at[k]) > cell.upper[k] + 0.5 * kRim)
                return false;
        }
        const double tolerance =
            2 * kMargin * (1 + std::abs(b.at[0] - a.at[0]) + std::abs(b.at[1] - a.at[1]));
        int left = 0, right = 0;
        for (unsigned corner = 0; corner < 4; ++corner) {
            const double side = cross(a, b,
                                      {{(corner & 1U) != 0 ? cell.upper[0] : cell.lower[0],
                                        (corner & 2U) != 0 ? cell.upper[1] : cell.lower[1]}});
            left += side > tolerance ? 1 : 0;
            right += side < -tolerance ? 1 : 0;
        }
        return left < 4 && right < 4;
    }

    PolygonShape polygon_;
    std::size_t z_;
    std::array<std::size_t, 2> axes_;
    std::vector<Point> points_;
    Cell whole_;
};

/// Where a cell is cut.
struct Cut {
    std::size_t axis = 0;
    double at = 0;
};

std::array<Cell, 2> halves(const Cell& cell, const Cut& cut) {
    std::array<Cell, 2> parts{cell, cell};
    parts[0].upper[cut.axis] = parts[1].lower[cut.axis] = cut.at;
    return parts;
}

/// The cut at a vertex that leaves the largest parts finished (fully covered, or empty); where no
/// cut does, the middle.
Cut best_cut(const Projection& polygon, const Cell& cell, bool wasteful, Clipping& scratch) {
    Cut best;
    const std::array<double, 2> steep{cell.side(0) * (1 + polygon.slope(0)),
                                      cell.side(1) * (1 + polygon.slope(1))};
    best.axis = steep[0] >= steep[1] ? 0 : 1;
    if (!wasteful)
        best.axis = cell.side(0) * polygon.slope(0) >= cell.side(1) * polygon.slope(1) ? 0 : 1;
    best.at = 0.5 * (cell.lower[best.axis] + cell.upper[best.axis]);
    if (!wasteful) return best;
    double finished = 0;
    const std::vector<Point>& points = polygon.points();
    for (auto p = points.begin(); p != points.end(); ++p) {
        for (std::size_t k = 0; k < 2; ++k) {
            const double at = p->at[k], sliver = 0.01 * cell.side(k);
            if (!(at > cell.lower[k] + sliver && at < cell.upper[k] - sliver)) continue;
            // Walls have many corners at one height.
            if (std::any_of(points.begin(), p, [&](const Point& q) { return q.at[k] == at; }))
                continue;
            double gain = 0;
            for (const Cell& part : halves(cell, {k, at})) {
                if (polygon.waste(part, scratch) == 0 || polygon.is_empty(part))
                    gain += part.area();
            }
            if (gain > finished) {
                finished = gain;
                best = {k, at};
            }
        }
    }
    return best;
}

/// A cell that might be divided further.
struct Task {
    double gain = 0;
    std::size_t polygon = 0;
    Cell cell;
    bool wasteful = false;
    friend bool operator<(const Task& a, const Task& b) { return a.gain < b.gain; }
};

Task task_for(const Projection& polygon, std::size_t number, const Cell& cell, Clipping& scratch) {
    Task task{0, number, cell, false};
    const double waste = polygon.waste(cell, scratch);
    const double thickness = polygon.thickness(cell);
    const double allowed = kThickness * std::max(polygon.whole().side(0), polygon.whole().side(1));
    task.wasteful = waste > 0.1 * cell.area();
    if (task.wasteful) task.gain = waste;
    if (thickness > allowed) task.gain += thickness * std::max(cell.side(0), cell.side(1));
    return task;
}

Bounds common(Bounds a, const Bounds& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        a.lower[k] = std::max(a.lower[k], b.lower[k]);
        a.upper[k] = std::min(a.upper[k], b.upper[k]);
    }
    return a;
}

double least_gain(const ModelPrimitives& model) {
    return kLeastGain * half_area(model.bounds());
}
std::size_t most_divisions(const ModelPrimitives& model) {
    return kDivisions + model.size() / 2;
}

/// Divides the polygons of a model greedily, always where the gain is largest.
class Division {
  public:
    explicit Division(const ModelPrimitives& model)
        : model_(model), least_(least_gain(model)), budget_(most_divisions(model)) {}

    /// A quick test, safe to call in parallel: false for primitives that are never divided.
    [[nodiscard]] bool is_candidate(std::uint32_t primitive) const {
        if (model_.half_area_at_most(primitive) <= least_) return false;
        const std::optional<PolygonShape> shape = model_.polygon(primitive);
        return shape && shape->vertices.size() <= kMostVertices &&
               half_area(hit_bounds(*shape)) > least_;
    }

    /// Adds those candidates that are worth dividing; returns them in their order.
    std::vector<std::uint32_t> add(const std::vector<std::uint32_t>& candidates,
                                   const TaskRunner& task_runner) {
        constexpr std::size_t kTogether = 64;
        std::vector<std::optional<std::pair<Projection, Task>>> looks(candidates.size());
        task_runner.run((candidates.size() + kTogether - 1) / kTogether, [&](std::size_t part) {
            Clipping scratch;
            const std::size_t last = std::min((part + 1) * kTogether, candidates.size());
            for (std::size_t i = part * kTogether; i < last; ++i) {
                Projection polygon(*model_.polygon(candidates[i]));
                const Task task = task_for(polygon, 0, polygon.whole(), scratch);
                if (task.gain > least_) looks[i].emplace(std::move(polygon), task);
            }
        });
        std::vector<std::uint32_t> taken;
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            if (!looks[i]) continue;
            looks[i]->second.polygon = polygons_.size();
            polygons_.push_back({std::move(looks[i]->first), candidates[i], 1});
            tasks_.push(looks[i]->second);
            taken.push_back(candidates[i]);
        }
        return taken;
    }

    void run(BvhPrimitives& bvh_primitives) {
        while (!tasks_.empty()) {
            const Task task = tasks_.top();
            tasks_.pop();
            Divided& polygon = polygons_[task.polygon];
            if (budget_ == 0 || polygon.bvh_primitives >= kMostParts || task.gain <= least_) {
                bvh_primitives.primitive_of.push_back(polygon.primitive);
                bvh_primitives.boxes.push_back(common(polygon.projection.box(task.cell),
                                                      model_.hit_bounds(polygon.primitive)));
                continue;
            }
            divide(task, polygon);
        }
    }

  private:
    struct Divided {
        Projection projection;
        std::uint32_t primitive = 0;
        int bvh_primitives = 0;  ///< number of parts so far
    };

    void divide(const Task& task, Divided& polygon) {
        --budget_;
        --polygon.bvh_primitives;
        const Cut cut = best_cut(polygon.projection, task.cell, task.wasteful, scratch_);
        for (const Cell& part : halves(task.cell, cut)) {
            if (polygon.projection.is_empty(part)) continue;
            tasks_.push(task_for(polygon.projection, task.polygon, part, scratch_));
            ++polygon.bvh_primitives;
        }
    }

    const ModelPrimitives& model_;
    double least_;  ///< gain [m²]
    std::size_t budget_;
    std::vector<Divided> polygons_;
    std::priority_queue<Task> tasks_;
    Clipping scratch_;
};

/// The primitives for which `is_wanted` is true, in their order.
template <class IsWanted>
std::vector<std::uint32_t> select_primitives(std::size_t count, const TaskRunner& task_runner,
                                             const IsWanted& is_wanted) {
    std::vector<std::vector<std::uint32_t>> parts(part_count(count));
    for_each_part(task_runner, count, [&](std::size_t part, std::size_t first, std::size_t last) {
        for (auto i = static_cast<std::uint32_t>(first); i < last; ++i)
            if (is_wanted(i)) parts[part].push_back(i);
    });
    std::vector<std::uint32_t> all;
    for (const std::vector<std::uint32_t>& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

/// A cone that is divided.
struct SlicedCone {
    std::uint32_t primitive = 0;
    ConeSlices slices;
};

/// The cones of a model whose slicing gains most, in their order. None for a large model: examining
/// a million takes a second, and rays gained nothing (measured).
std::vector<SlicedCone> slice_cones(const ModelPrimitives& model, const TaskRunner& task_runner) {
    if (model.size() > kManyPrimitives) return {};
    const double least = least_gain(model);
    const auto slices = [&](std::uint32_t i) {
        const ConeShape* const cone = model.cone(i);
        return cone ? slices_of(*cone, least) : ConeSlices{};
    };
    std::vector<SlicedCone> cones;
    for (const std::uint32_t i : select_primitives(
             model.size(), task_runner, [&](std::uint32_t k) { return slices(k).count > 1; }))
        cones.push_back({i, slices(i)});
    std::stable_sort(cones.begin(), cones.end(), [](const SlicedCone& a, const SlicedCone& b) {
        return a.slices.gain > b.slices.gain;
    });
    std::size_t budget = most_divisions(model), taken = 0;
    for (; taken < cones.size(); ++taken) {
        const auto cuts = static_cast<std::size_t>(cones[taken].slices.count - 1);
        if (cuts > budget) break;
        budget -= cuts;
    }
    cones.resize(taken);
    std::sort(cones.begin(), cones.end(),
              [](const SlicedCone& a, const SlicedCone& b) { return a.primitive < b.primitive; });
    return cones;
}

void append(const std::vector<SlicedCone>& cones, const ModelPrimitives& model,
            BvhPrimitives& bvh_primitives) {
    for (const auto& [primitive, slices] : cones) {
        for (int i = 0; i < slices.count; ++i) {
            bvh_primitives.primitive_of.push_back(primitive);
            bvh_primitives.boxes.push_back(hit_bounds(*model.cone(primitive), i, slices.count));
        }
    }
}

/// Primitives grouped into pairs and single ones.
struct Grouping {
    std::vector<std::uint32_t> pairs, alone;

    void append(const Grouping& other) {
        pairs.insert(pairs.end(), other.pairs.begin(), other.pairs.end());
        alone.insert(alone.end(), other.alone.begin(), other.alone.end());
    }
};

/// Pairs neighbours greedily, from the first primitive on.
Grouping pair_neighbours(const ModelPrimitives& model, std::span<const std::uint32_t> primitives) {
    Grouping grouping;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        const std::uint32_t one = primitives[i];
        const bool may_pair = model.size() > kManyPrimitives || model.is_triangle(one);
        if (may_pair && i + 1 < primitives.size() && primitives[i + 1] == one + 1) {
            const Bounds a = model.hit_bounds(one), b = model.hit_bounds(one + 1);
            Bounds both = a;
            extend(both, b);
            if (half_area(both) <= kPairArea * (half_area(a) + half_area(b))) {
                grouping.pairs.push_back(one);
                ++i;
                continue;
            }
        }
        grouping.alone.push_back(one);
    }
    return grouping;
}

Grouping pair_neighbours(const ModelPrimitives& model, std::span<const std::uint32_t> primitives,
                         const TaskRunner& task_runner) {
    std::vector<Grouping> parts(part_count(primitives.size()));
    for_each_part(task_runner, primitives.size(),
                  [&](std::size_t part, std::size_t first, std::size_t last) {
                      parts[part] = pair_neighbours(model, primitives.subspan(first, last - first));
                  });
    Grouping all;
    for (const Grouping& part : parts) all.append(part);
    return all;
}

/// Whether the ascending numbers have no gaps.
bool are_consecutive(const std::vector<std::uint32_t>& numbers) {
    return numbers.empty() || numbers.back() - numbers.front() + 1 == numbers.size();
}

}  // namespace

Bounds BvhPrimitives::box(std::size_t bvh_primitive, const ModelPrimitives& model) const {
    if (bvh_primitive >= whole) return boxes[bvh_primitive - whole];
    Bounds box = model.hit_bounds(primitive(bvh_primitive));
    if (count(bvh_primitive) == 2) extend(box, model.hit_bounds(primitive(bvh_primitive) + 1));
    return box;
}

BvhPrimitives divide_primitives(const ModelPrimitives& model, const TaskRunner& task_runner,
                                bool slices) {
    Division division(model);
    std::vector<std::uint32_t> divided =
        division.add(select_primitives(model.size(), task_runner,
                                       [&](std::uint32_t i) { return division.is_candidate(i); }),
                     task_runner);
    std::vector<SlicedCone> cones;
    if (slices) cones = slice_cones(model, task_runner);
    for (const SlicedCone& cone : cones) divided.push_back(cone.primitive);
    std::sort(divided.begin(), divided.end());
    Grouping whole;
    whole.alone = select_primitives(model.size(), task_runner, [&](std::uint32_t i) {
        return model.is_finite(i) && !std::binary_search(divided.begin(), divided.end(), i);
    });
    whole = pair_neighbours(model, whole.alone, task_runner);
    BvhPrimitives bvh_primitives;
    bvh_primitives.pairs = whole.pairs.size();
    bvh_primitives.primitive_of = std::move(whole.pairs);
    bvh_primitives.primitive_of.insert(bvh_primitives.primitive_of.end(), whole.alone.begin(),
                                       whole.alone.end());
    bvh_primitives.whole = bvh_primitives.primitive_of.size();
    if (divided.empty() && bvh_primitives.pairs == 0 &&
        are_consecutive(bvh_primitives.primitive_of)) {
        if (bvh_primitives.whole > 0) bvh_primitives.first = bvh_primitives.primitive_of.front();
        bvh_primitives.primitive_of = std::vector<std::uint32_t>();  // {} would keep the memory
        return bvh_primitives;
    }
    division.run(bvh_primitives);
    append(cones, model, bvh_primitives);
    bvh_primitives.primitive_of.shrink_to_fit();
    return bvh_primitives;
}

}  // namespace lightwalk
