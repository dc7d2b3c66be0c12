#include "core/cloud/gaps.h"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <vector>

namespace lightwalk {
namespace {

/// A picture, and which of its pixels are known.
struct GapPicture {
    int width = 0, height = 0;
    std::span<Rgb> radiance;
    std::span<const std::uint8_t> known;

    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
    [[nodiscard]] bool full() const {
        return std::find(known.begin(), known.end(), std::uint8_t{0}) == known.end();
    }
};

/// A picture of a fraction of the size: means of the known pixels below each of its pixels.
struct GapLevel {
    int width = 0, height = 0;
    std::vector<Rgb> radiance;
    std::vector<std::uint8_t> known;

    GapLevel(int w, int h) : width(w), height(h), radiance(count()), known(count()) {}
    [[nodiscard]] std::size_t count() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    [[nodiscard]] GapPicture picture() { return {width, height, radiance, known}; }
};

/// Calls part(first, last) for ranges of rows that make up [0, rows).
template <class Part>
void for_rows(const TaskRunner& task_runner, int rows, Part part) {
    constexpr int kRowsATask = 32;
    const int tasks = (rows + kRowsATask - 1) / kRowsATask;
    task_runner.run(static_cast<std::size_t>(tasks), [&](std::size_t task) {
        const int first = static_cast<int>(task) * kRowsATask;
        part(first, std::min(first + kRowsATask, rows));
    });
}

/// The mean of the known ones among the four pixels below a coarse one. Returns 0 where none is
/// known.
std::uint8_t mean_below(const GapPicture& fine, int x, int y, Rgb& mean) {
    Rgb sum;
    int found = 0;
    for (int v = 2 * y; v < std::min(2 * y + 2, fine.height); ++v) {
        for (int u = 2 * x; u < std::min(2 * x + 2, fine.width); ++u) {
            if (fine.known[fine.at(u, v)] == 0) continue;
            sum += fine.radiance[fine.at(u, v)];
            ++found;
        }
    }
    if (found == 0) return 0;
    mean = sum * (1.0f / static_cast<float>(found));
    return 1;
}

GapLevel halved(const GapPicture& fine, const TaskRunner& task_runner) {
    GapLevel level((fine.width + 1) / 2, (fine.height + 1) / 2);
    const GapPicture coarse = level.picture();
    for_rows(task_runner, coarse.height, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < coarse.width; ++x)
                level.known[coarse.at(x, y)] =
                    mean_below(fine, x, y, coarse.radiance[coarse.at(x, y)]);
    });
    return level;
}

/// Bilinear interpolation of the coarse picture: weights 9 : 3 : 3 : 1 of the four pixels around a
/// fine one.
Rgb between(const GapPicture& coarse, int x, int y) {
    const int x0 = x / 2, y0 = y / 2;
    const int x1 = std::clamp(x0 + (x % 2 == 0 ? -1 : 1), 0, coarse.width - 1);
    const int y1 = std::clamp(y0 + (y % 2 == 0 ? -1 : 1), 0, coarse.height - 1);
    const auto value = [&](int u, int v) { return coarse.radiance[coarse.at(u, v)]; };
    return (9.0f / 16) * value(x0, y0) + (3.0f / 16) * (value(x1, y0) + value(x0, y1)) +
           (1.0f / 16) * value(x1, y1);
}

void fill_from(const GapPicture& coarse, const GapPicture& fine, const TaskRunner& task_runner) {
    for_rows(task_runner, fine.height, [&](int first, int last) {
        for (int y = first; y < last; ++y) {
            for (int x = 0; x < fine.width; ++x) {
                const std::size_t i = fine.at(x, y);
                if (fine.known[i] == 0) fine.radiance[i] = between(coarse, x, y);
            }
        }
    });
}

}  // namespace

void fill_gaps(int width, int height, std::span<Rgb> radiance, std::span<const std::uint8_t> known,
               const TaskRunner& task_runner) {
    std::vector<GapPicture> levels{{width, height, radiance, known}};
    std::deque<GapLevel> coarser;  // levels refer to them
    while (!levels.back().full()) {
        if (levels.back().known.size() <= 1) return;  // no pixel is known
        coarser.push_back(halved(levels.back(), task_runner));
        levels.push_back(coarser.back().picture());
    }
    for (std::size_t i = levels.size() - 1; i > 0; --i)
        fill_from(levels[i], levels[i - 1], task_runner);
}

}  // namespace lightwalk
