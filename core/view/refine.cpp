#include "core/view/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace lightwalk {
namespace {

// Found by simulation on views of the cabin, the virtual room, a lamp-lit box and the lodge, ten
// seeds each: means within 1 % of tracing every pixel, for no more rays than rpict's pattern.
constexpr double kStandsOut = 3;     ///< times as bright, or as dark, as those around
constexpr double kAlike = 0.8;       ///< share of the threshold that an opposite pair is held to
constexpr double kStake = 2;         ///< how fast that shrinks with the contrast
constexpr double kTooMuch = 3;       ///< contrast beyond which no pair is trusted
constexpr double kAllTraced = 0.95;  ///< share of traced pixels beyond which a tile may glitter

enum class State : std::uint8_t { kOpen, kTraced, kInterpolated, kLeftOut };

using Lines = std::vector<int>;  ///< ascending, from the first pixel of a side to the last

/// Lines of the first grid: as many a pixel as rpict has (its rows lie floor((99 s + 70) / 140)
/// apart, its columns floor((140 s + 49) / 99)), or one every s where that is fewer.
Lines first_lines(int length, int spacing) {
    const int cell = ((140 * spacing + 49) / 99) * ((99 * spacing + 70) / 140);
    const int as_rpict = static_cast<int>(length / std::sqrt(static_cast<double>(cell))) - 1;
    const int every = (length - 1 + spacing - 1) / spacing;
    const int intervals = std::clamp(as_rpict, 1, std::max(every, 1));
    Lines lines{0};
    for (int i = 1; i <= intervals; ++i) {
        const int at = i * (length - 1) / intervals;
        if (at > lines.back()) lines.push_back(at);
    }
    return lines;
}

Lines halved(const Lines& lines) {
    Lines finer{lines.front()};
    for (std::size_t i = 1; i < lines.size(); ++i) {
        if (lines[i] - lines[i - 1] > 1) finer.push_back((lines[i - 1] + lines[i]) / 2);
        finer.push_back(lines[i]);
    }
    return finer;
}

/// By line: whether it is new, i.e. not among the coarser ones.
std::vector<bool> new_lines(const Lines& finer, const Lines& coarser) {
    std::vector<bool> is_new;
    for (const int line : finer)
        is_new.push_back(!std::binary_search(coarser.begin(), coarser.end(), line));
    return is_new;
}

PixelValue mix(const PixelValue& a, const PixelValue& b, float t) {
    return {a.radiance * (1 - t) + b.radiance * t, a.distance * (1 - t) + b.distance * t};
}

/// Two decided pixels on opposite sides of the one to decide, and how far they are from it.
struct Pair {
    PixelValue a, b;
    float to_a = 1, to_b = 1;
    [[nodiscard]] PixelValue between() const { return mix(a, b, to_a / (to_a + to_b)); }
};

/// (max - min) / min of the channel where it is greatest.
double contrast(std::span<const PixelValue> values) {
    double greatest = 0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        double least = std::numeric_limits<double>::infinity();
        double most = 0;
        for (const PixelValue& value : values) {
            least = std::min(least, static_cast<double>(value.radiance[channel]));
            most = std::max(most, static_cast<double>(value.radiance[channel]));
        }
        if (most > least) greatest = std::max(greatest, (most - least) / std::max(least, 0.0));
    }
    return greatest;
}

class TileRefiner {
  public:
    TileRefiner(const PixelRectangle& tile, const RefineOptions& options, TracePixels trace,
                StorePixel store)
        : tile_(tile),
          options_(options),
          stands_out_(std::max(kStandsOut, 1 + options.threshold)),
          trace_(trace),
          store_(store),
          width_(tile.width()),
          height_(tile.height()),
          values_(tile.pixels()),
          states_(tile.pixels(), State::kOpen),
          sparkling_(tile.pixels(), false),
          ever_sparkling_(tile.pixels(), false) {}

    void run() {
        columns_ = first_lines(width_, options_.spacing);
        rows_ = first_lines(height_, options_.spacing);
        for (const int y : rows_) {
            for (const int x : columns_) want(x, y);
        }
        trace_wanted();
        while (true) {
            mark_sparkles();
            const Lines finer_columns = halved(columns_);
            const Lines finer_rows = halved(rows_);
            if (finer_columns == columns_ && finer_rows == rows_) break;
            decide_level(finer_columns, finer_rows);
            columns_ = finer_columns;
            rows_ = finer_rows;
        }
        follow_discoveries();
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x)
                store_({tile_.x0 + x, tile_.y0 + y}, values_[at(x, y)]);
        }
    }

  private:
    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }
    [[nodiscard]] bool is_decided(int x, int y) const { return states_[at(x, y)] != State::kOpen; }
    [[nodiscard]] double brightness_at(int x, int y) const {
        return static_cast<double>(brightness(values_[at(x, y)].radiance));
    }

    void want(int x, int y) { wanted_.push_back({tile_.x0 + x, tile_.y0 + y}); }
    void trace_wanted() {
        traced_.assign(wanted_.size(), PixelValue{});
        trace_(wanted_, traced_);
        for (std::size_t i = 0; i < wanted_.size(); ++i) {
            const std::size_t k = at(wanted_[i].x - tile_.x0, wanted_[i].y - tile_.y0);
            values_[k] = traced_[i];
            states_[k] = State::kTraced;
        }
        wanted_.clear();
    }

    /// Counts, among the up to eight values around that at column line i and row line j, those
    /// about as bright or brighter, and those about as dark or darker.
    struct Company {
        int all = 0, as_bright = 0, as_dark = 0;
    };
    [[nodiscard]] Company company(int i, int j, const Lines& columns, const Lines& rows) const {
        const auto last_column = static_cast<int>(columns.size()) - 1;
        const auto last_row = static_cast<int>(rows.size()) - 1;
        const auto bright = [&](int a, int b) {
            return brightness_at(columns[static_cast<std::size_t>(a)],
                                 rows[static_cast<std::size_t>(b)]);
        };
        const double own = bright(i, j);
        Company found;
        for (int b = std::max(j - 1, 0); b <= std::min(j + 1, last_row); ++b) {
            for (int a = std::max(i - 1, 0); a <= std::min(i + 1, last_column); ++a) {
                if (a == i && b == j) continue;
                const double other = bright(a, b);
                ++found.all;
                if (other * stands_out_ >= own) ++found.as_bright;
                if (other <= own * stands_out_) ++found.as_dark;
            }
        }
        return found;
    }

    /// Marks cells around outliers. A bright pixel with at most one similar neighbour among the
    /// grid's eight suggests further bright ones between the samples, within two cells; a dark one
    /// without similar neighbours, within one cell.
    void mark_sparkles() {
        std::fill(sparkling_.begin(), sparkling_.end(), false);
        for (int j = 0; j < std::ssize(rows_); ++j) {
            for (int i = 0; i < std::ssize(columns_); ++i) {
                const int x = columns_[static_cast<std::size_t>(i)];
                const int y = rows_[static_cast<std::size_t>(j)];
                if (states_[at(x, y)] != State::kTraced) continue;
                const Company around = company(i, j, columns_, rows_);
                if (around.all < 3) continue;  // too few for an outlier
                if (around.as_bright <= 1)
                    mark_cells(i, j, 2);
                else if (around.as_dark == 0)
                    mark_cells(i, j, 1);
            }
        }
    }
    void mark_cells(int i, int j, int reach) {
        const auto line = [](const Lines& lines, int k) {
            const int last = static_cast<int>(lines.size()) - 1;
            return lines[static_cast<std::size_t>(std::clamp(k, 0, last))];
        };
        for (int y = line(rows_, j - reach); y <= line(rows_, j + reach); ++y) {
            for (int x = line(columns_, i - reach); x <= line(columns_, i + reach); ++x)
                sparkling_[at(x, y)] = ever_sparkling_[at(x, y)] = true;
        }
    }

    /// Decide the pixels where a new line crosses another one.
    void decide_level(const Lines& columns, const Lines& rows) {
        const std::vector<bool> new_column = new_lines(columns, columns_);
        const std::vector<bool> new_row = new_lines(rows, rows_);
        for (const bool centres : {true, false}) {
            // A threshold of 0 means that every pixel is traced.
            glitters_ = !centres && options_.threshold > 0 && is_nearly_all_traced();
            decided_.clear();
            for (std::size_t j = 0; j < rows.size(); ++j) {
                for (std::size_t i = 0; i < columns.size(); ++i) {
                    if (centres ? new_column[i] && new_row[j] : new_column[i] != new_row[j])
                        decide(columns[i], rows[j], pairs(i, j, columns, rows, centres));
                }
            }
            for (const Decided& pixel : decided_) {
                values_[pixel.index] = pixel.value;
                states_[pixel.index] = pixel.state;
            }
            trace_wanted();
        }
    }

    /// The opposite pairs around a pixel: the corners around a centre, else along its line and,
    /// where both are decided, across it.
    struct Pairs {
        std::array<Pair, 2> pair;
        std::size_t count = 0;
        PixelValue mean;
        bool close = true;  ///< all but next to the pixel
        void add(const Pair& p) {
            pair[count++] = p;
            close = close && p.to_a + p.to_b <= 3;
        }
    };
    [[nodiscard]] Pairs pairs(std::size_t i, std::size_t j, const Lines& columns, const Lines& rows,
                              bool centre) const {
        Pairs found;
        const auto add = [&](int xa, int ya, int xb, int yb) {
            if (!is_decided(xa, ya) || !is_decided(xb, yb)) return;
            const auto far = [&](int x, int y) {
                return static_cast<float>(std::hypot(x - columns[i], y - rows[j]));
            };
            found.add({values_[at(xa, ya)], values_[at(xb, yb)], far(xa, ya), far(xb, yb)});
        };
        const bool inner_column = i > 0 && i + 1 < columns.size();
        const bool inner_row = j > 0 && j + 1 < rows.size();
        if (centre) {
            add(columns[i - 1], rows[j - 1], columns[i + 1], rows[j + 1]);
            add(columns[i + 1], rows[j - 1], columns[i - 1], rows[j + 1]);
            found.mean = bilinear(found, rows[j] - rows[j - 1], rows[j + 1] - rows[j],
                                  columns[i] - columns[i - 1], columns[i + 1] - columns[i]);
            return found;
        }
        if (inner_column) add(columns[i - 1], rows[j], columns[i + 1], rows[j]);
        if (inner_row) add(columns[i], rows[j - 1], columns[i], rows[j + 1]);
        found.mean = found.pair[0].between();
        if (found.count == 2) found.mean = mix(found.mean, found.pair[1].between(), 0.5f);
        return found;
    }

    struct Decided {
        std::size_t index;
        PixelValue value;
        State state;
    };
    void decide(int x, int y, const Pairs& around) {
        std::array<PixelValue, 4> values;
        std::size_t count = 0;
        for (std::size_t k = 0; k < around.count; ++k) {
            values[count++] = around.pair[k].a;
            values[count++] = around.pair[k].b;
        }
        const std::span<const PixelValue> all{values.data(), count};
        const bool sparkles = sparkling_[at(x, y)];
        if (!sparkles && !differ(all, options_)) return set_pixel(x, y, around.mean);
        const double range = contrast(all);
        if (glitters_ && ever_sparkling_[at(x, y)] && is_left_out(x, y) && around.close)
            return set_pixel(x, y, around.mean, State::kLeftOut);
        const Pair* pair = sparkles || range > kTooMuch ? nullptr : pair_alike(around, range);
        if (pair != nullptr) return set_pixel(x, y, pair->between());
        want(x, y);
    }
    void set_pixel(int x, int y, const PixelValue& value, State state = State::kInterpolated) {
        decided_.push_back({at(x, y), value, state});
    }

    /// At a point between the four corners of two crossing pairs, so far from the sides.
    [[nodiscard]] static PixelValue bilinear(const Pairs& corners, int below, int above, int left,
                                             int right) {
        const float u = static_cast<float>(left) / static_cast<float>(left + right);
        const float v = static_cast<float>(below) / static_cast<float>(below + above);
        const auto& [rising, falling] = corners.pair;
        return mix(mix(rising.a, falling.a, u), mix(falling.b, rising.b, u), v);
    }

    /// The pair that is most alike, if it is enough so where values differ by `range`; else null.
    [[nodiscard]] const Pair* pair_alike(const Pairs& around, double range) const {
        if (around.count < 2) return nullptr;
        const Pair* best = &around.pair[0];
        double least = contrast(std::array{best->a, best->b});
        for (const Pair& pair : around.pair) {
            const double difference = contrast(std::array{pair.a, pair.b});
            if (difference < least) {
                best = &pair;
                least = difference;
            }
        }
        RefineOptions strict = options_;
        strict.threshold *= kAlike / (1 + kStake * range);
        return differ(std::array{best->a, best->b}, strict) ? nullptr : best;
    }

    /// The pattern of pixels left out in a glittering tile: three of five.
    [[nodiscard]] static bool is_left_out(int x, int y) { return (x / 2 + y) % 5 < 3; }
    [[nodiscard]] bool is_nearly_all_traced() const {
        const auto open = std::count(states_.begin(), states_.end(), State::kOpen);
        const auto traced = std::count(states_.begin(), states_.end(), State::kTraced);
        return static_cast<double>(traced) >
               kAllTraced * static_cast<double>(std::ssize(states_) - open);
    }

    /// Trace around every traced pixel that has at most two similar neighbours, and repeat that for
    /// the outliers so found (adaptive cluster sampling).
    void follow_discoveries() {
        std::vector<PixelPlace> found;
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                if (states_[at(x, y)] == State::kTraced) found.push_back({x, y});
            }
        }
        while (!found.empty()) {
            for (const PixelPlace& place : found) {
                const Company around = company(place.x, place.y, columns_, rows_);
                if (around.as_bright <= 2 || around.as_dark <= 2) want_around(place);
            }
            found.clear();
            for (const PixelPlace& place : wanted_)
                found.push_back({place.x - tile_.x0, place.y - tile_.y0});
            trace_wanted();
        }
    }
    void want_around(const PixelPlace& place) {
        for (int y = std::max(place.y - 1, 0); y <= std::min(place.y + 1, height_ - 1); ++y) {
            for (int x = std::max(place.x - 1, 0); x <= std::min(place.x + 1, width_ - 1); ++x) {
                if (states_[at(x, y)] != State::kInterpolated) continue;
                states_[at(x, y)] = State::kTraced;  // about to be
                want(x, y);
            }
        }
    }

    PixelRectangle tile_;
    RefineOptions options_;
    double stands_out_;  ///< factor
    TracePixels trace_;
    StorePixel store_;
    int width_, height_;
    Lines columns_, rows_;  ///< whose crossings are decided
    std::vector<PixelValue> values_;
    std::vector<State> states_;
    std::vector<bool> sparkling_;       ///< at this level
    std::vector<bool> ever_sparkling_;  ///< at any so far
    bool glitters_ = false;
    std::vector<PixelPlace> wanted_;
    std::vector<PixelValue> traced_;
    std::vector<Decided> decided_;
};

}  // namespace

int refine_tile_side(int spacing) {
    // Border lines are traced more densely than what they enclose: the less, the larger a tile is.
    constexpr int kLeast = 64;
    constexpr int kCells = 6;
    return std::max(kLeast, kCells * spacing);
}

bool differ(std::span<const PixelValue> values, const RefineOptions& options) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
        double least = static_cast<double>(values[0].radiance[channel]);
        double most = least;
        for (const PixelValue& value : values.subspan(1)) {
            least = std::min(least, static_cast<double>(value.radiance[channel]));
            most = std::max(most, static_cast<double>(value.radiance[channel]));
        }
        if (most - least > options.threshold * least) return true;
    }
    if (!options.by_distance) return false;
    const auto [nearest, farthest] = std::minmax_element(
        values.begin(), values.end(),
        [](const PixelValue& a, const PixelValue& b) { return a.distance < b.distance; });
    const double near = static_cast<double>(nearest->distance);
    const double far = static_cast<double>(farthest->distance);
    return 2 * (far - near) > options.threshold * (far + near);
}

void refine_tile(const PixelRectangle& tile, const RefineOptions& options, TracePixels trace,
                 StorePixel store) {
    if (tile.empty()) return;
    TileRefiner(tile, options, trace, store).run();
}

}  // namespace lightwalk
