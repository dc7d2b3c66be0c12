#include "io/net/depth_patches.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>

namespace lightwalk {
namespace {

constexpr float kNearestStep = 65535;
constexpr float kUnknown = -1;
// An edge is where a neighbour is this many tolerances off the patch's plane: what is less does not
// tear a surface apart.
constexpr float kEdgeTolerances = 3;
constexpr float kLargestSlope = 32767;
constexpr int kCompression = 4;  // zlib's: higher levels take longer, and save next to nothing

/// Inverse depths of a band, with the rows above and below it as far as the picture goes [steps].
class InverseDepths {
  public:
    InverseDepths(const DepthPicture& picture, int y0, int y1)
        : width_(picture.width),
          first_(std::max(y0 - 1, 0)),
          end_(std::min(y1 + 1, picture.height)) {
        const Camera camera(picture.view);
        // The image plane at unit distance: a ray is as much longer than its depth as its place
        // there is from the eye.
        const auto place = [&](double h, double v) {
            const Vec3 ray = camera.perspective_ray(h, v).direction;
            const double depth = dot(ray, camera.forward());
            return std::pair{dot(ray, camera.right()) / depth, dot(ray, camera.upward()) / depth};
        };
        std::vector<float> across(static_cast<std::size_t>(width_));
        for (int x = 0; x < width_; ++x) {
            const double side = place((x + 0.5) / width_, 0.5).first;
            across[static_cast<std::size_t>(x)] = static_cast<float>(side * side);
        }
        values_.reserve(across.size() * static_cast<std::size_t>(end_ - first_));
        const float scale = 1 / picture.step;
        for (int y = first_; y < end_; ++y) {
            const double rise = place(0.5, 1 - (y + 0.5) / picture.height).second;
            const auto up = static_cast<float>(1 + rise * rise);
            const std::span<const float> row = picture.distance.subspan(
                static_cast<std::size_t>(y) * across.size(), across.size());
            for (std::size_t x = 0; x < row.size(); ++x) {
                const float inverse = std::sqrt(across[x] + up) * scale / row[x];
                values_.push_back(row[x] > 0 ? std::min(inverse, kNearestStep) : kUnknown);
            }
        }
        fill_unknown();
    }

    [[nodiscard]] bool has(int x, int y) const {
        return x >= 0 && x < width_ && y >= first_ && y < end_;
    }
    [[nodiscard]] const float* at(int x, int y) const { return &values_[index(x, y)]; }
    /// Whether most pixels of a square are filled from others.
    [[nodiscard]] bool is_guess(int x, int y, int side) const {
        int unknown = 0;
        for (int v = y; v < y + side; ++v)
            for (int u = x; u < x + side; ++u) unknown += gaps_[index(u, v)] != 0;
        return 2 * unknown > side * side;
    }
    [[nodiscard]] std::size_t stride() const { return static_cast<std::size_t>(width_); }

  private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - first_) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    /// A row or column of pixels.
    struct Line {
        std::size_t first, count, stride;
    };

    /// In short gaps of a row or a column, whichever is shorter, unknown pixels lie on the surface
    /// of the known ones; elsewhere they are as far away as the known ones of the smallest square
    /// of a quadtree that has some.
    void fill_unknown() {
        gaps_.resize(values_.size());
        std::size_t unknown = 0;
        for (std::size_t i = 0; i < values_.size(); ++i) {
            gaps_[i] = values_[i] == kUnknown ? kNoGap : 0;
            unknown += gaps_[i] != 0;
        }
        if (unknown == 0) return;
        const auto width = static_cast<std::size_t>(width_), rows = values_.size() / width;
        const std::vector<float> known = values_;
        for (std::size_t y = 0; y < rows; ++y) fill_line({y * width, width, 1}, known);
        for (std::size_t x = 0; x < width; ++x) fill_line({x, rows, width}, known);
        const int side = kLargestPatch, end = static_cast<int>(rows);
        for (int y = 0; y < end; y += side)
            for (int x = 0; x < width_; x += side) fill_square(x, y, side, 0);
    }

    void fill_line(const Line& line, std::span<const float> known) {
        const auto at = [&](std::size_t k) { return line.first + k * line.stride; };
        for (std::size_t k = 0; k < line.count;) {
            if (known[at(k)] != kUnknown) {
                ++k;
                continue;
            }
            std::size_t end = k;
            while (end < line.count && known[at(end)] == kUnknown) ++end;
            const bool begins = k == 0, ends = end == line.count;
            if ((!begins || !ends) && end - k <= kShortGap) {
                const float before = known[begins ? at(end) : at(k - 1)];
                const float after = ends ? before : known[at(end)];
                // With one known end only, less is known.
                const std::size_t gap = (end - k) * (begins || ends ? 4 : 1);
                fill_gap({at(k), end - k, line.stride}, before, after, gap);
            }
            k = end;
        }
    }

    /// Between two surfaces it is the farther one: what is too far away is hidden by what is not,
    /// what is too near hides what is right.
    void fill_gap(const Line& line, float before, float after, std::size_t gap) {
        const float slope = (after - before) / static_cast<float>(line.count + 1);
        const bool together = std::abs(slope) <= kEdgeTolerances * kDepthTolerance;
        const float farther = std::min(before, after);
        for (std::size_t k = 0; k < line.count; ++k) {
            const std::size_t i = line.first + k * line.stride;
            if (gaps_[i] <= gap) continue;
            gaps_[i] = static_cast<std::uint32_t>(gap);
            values_[i] = together ? before + slope * static_cast<float>(k + 1) : farther;
        }
    }

    /// @param y  from the first row
    /// @param around  the mean of a larger square's known pixels
    void fill_square(int x, int y, int side, float around) {
        const int right = std::min(x + side, width_), low = std::min(y + side, end_ - first_);
        float sum = 0;
        int known = 0, unknown = 0;
        for (int v = y; v < low; ++v)
            for (int u = x; u < right; ++u) {
                const float value = *at(u, v + first_);
                ++(value == kUnknown ? unknown : known);
                if (value != kUnknown) sum += value;
            }
        if (unknown == 0) return;
        const float mean = known > 0 ? sum / static_cast<float>(known) : around;
        if (known == 0) {
            for (int v = y; v < low; ++v)
                for (int u = x; u < right; ++u) values_[index(u, v + first_)] = mean;
            return;
        }
        for (int v = y; v < low; v += side / 2)
            for (int u = x; u < right; u += side / 2) fill_square(u, v, side / 2, mean);
    }

    static constexpr std::size_t kShortGap = 6;  // [pixels]
    static constexpr std::uint32_t kNoGap = ~std::uint32_t{0};
    std::vector<std::uint32_t>
        gaps_;  ///< by pixel: how far apart the known ones are; 0: it is known
    int width_, first_, end_;
    std::vector<float> values_;
};

class PatchCutter {
  public:
    PatchCutter(const DepthPicture& picture, const InverseDepths& inverse, int y0, int y1)
        : width_(picture.width), y1_(y1), inverse_(inverse) {
        for (int y = y0; y < y1; y += kLargestPatch)
            for (int x = 0; x < width_; x += kLargestPatch) cut(x, y, kHighestPatchLevel);
    }
    [[nodiscard]] std::vector<DepthPatch> take() { return std::move(patches_); }

  private:
    void cut(int x, int y, int level) {
        if (x >= width_ || y >= y1_) return;
        const int side = 1 << level;
        DepthPatch patch{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                         static_cast<std::uint8_t>(level)};
        if (x + side <= width_ && y + side <= y1_ && fits(patch)) {
            patch.edges = edges_of(patch);
            patch.guessed = inverse_.is_guess(x, y, side);
            patches_.push_back(patch);
            return;
        }
        const int half = side / 2;
        cut(x, y, level - 1);
        cut(x + half, y, level - 1);
        cut(x, y + half, level - 1);
        cut(x + half, y + half, level - 1);
    }

    /// Inverse depth of a patch's plane at a pixel [steps].
    [[nodiscard]] static float plane(const DepthPatch& patch, int x, int y) {
        const int side = 1 << patch.level;
        constexpr float kHalfUnit = 0.5f / kSlopeUnits;
        const auto right = static_cast<float>(2 * (x - patch.x) - side + 1);
        const auto down = static_cast<float>(2 * (y - patch.y) - side + 1);
        return patch.value + kHalfUnit * (patch.slope_x * right + patch.slope_y * down);
    }

    /// Find the plane of a square's pixels. False: they lie on none.
    [[nodiscard]] bool fits(DepthPatch& patch) const {
        const float* first = inverse_.at(patch.x, patch.y);
        if (patch.level == 0) {
            patch.value = static_cast<std::uint16_t>(std::lround(*first));
            return true;
        }
        const auto side = std::size_t{1} << patch.level;
        const std::size_t down = (side - 1) * inverse_.stride();
        // Of a plane the sums of opposite corners are the same; most squares that are none fail
        // here.
        if (std::abs(first[0] + first[down + side - 1] - first[side - 1] - first[down]) >
            4 * kDepthTolerance)
            return false;
        return fit_plane(patch, first) && holds(patch, first);
    }

    /// Least squares: on a full grid the mean and the two slopes are independent of each other.
    [[nodiscard]] bool fit_plane(DepthPatch& patch, const float* first) const {
        const int side = 1 << patch.level;
        const float middle = 0.5f * static_cast<float>(side - 1);
        float sum = 0, across = 0, down = 0;
        const float* row = first;
        for (int y = 0; y < side; ++y, row += inverse_.stride()) {
            float line = 0, tilt = 0;
            for (int x = 0; x < side; ++x) {
                line += row[x];
                tilt += row[x] * (static_cast<float>(x) - middle);
            }
            sum += line;
            across += tilt;
            down += line * (static_cast<float>(y) - middle);
        }
        const auto pixels = static_cast<float>(side * side);
        const float unit = 12 * kSlopeUnits / (pixels * (pixels - 1));
        // Two pixels lie on a plane even where one hides what the other shows.
        const float steepest =
            patch.level == 1 ? kSlopeUnits * kEdgeTolerances * kDepthTolerance : kLargestSlope;
        if (std::abs(across * unit) > steepest || std::abs(down * unit) > steepest) return false;
        patch.value = static_cast<std::uint16_t>(std::lround(sum / pixels));
        patch.slope_x = static_cast<std::int16_t>(std::lround(across * unit));
        patch.slope_y = static_cast<std::int16_t>(std::lround(down * unit));
        return true;
    }

    [[nodiscard]] bool holds(const DepthPatch& patch, const float* first) const {
        const int side = 1 << patch.level;
        const float* row = first;
        for (int y = 0; y < side; ++y, row += inverse_.stride()) {
            float worst = 0;
            for (int x = 0; x < side; ++x)
                worst = std::max(worst, std::abs(row[x] - plane(patch, patch.x + x, patch.y + y)));
            if (worst > kDepthTolerance) return false;
        }
        return true;
    }

    [[nodiscard]] bool parts(const DepthPatch& patch, int x, int y) const {
        return inverse_.has(x, y) && std::abs(*inverse_.at(x, y) - plane(patch, x, y)) >
                                         kEdgeTolerances * kDepthTolerance;
    }

    [[nodiscard]] std::uint8_t edges_of(const DepthPatch& patch) const {
        const int side = 1 << patch.level;
        std::uint8_t edges = 0;
        for (int k = 0; k < side; ++k) {
            if (parts(patch, patch.x - 1, patch.y + k)) edges |= kLeftEdge;
            if (parts(patch, patch.x + side, patch.y + k)) edges |= kRightEdge;
            if (parts(patch, patch.x + k, patch.y - 1)) edges |= kUpperEdge;
            if (parts(patch, patch.x + k, patch.y + side)) edges |= kLowerEdge;
        }
        return edges;
    }

    int width_, y1_;
    const InverseDepths& inverse_;
    std::vector<DepthPatch> patches_;
};

void append_number(std::string& out, std::uint32_t number) {
    for (int i = 0; i < 4; ++i) out += static_cast<char>((number >> (8 * i)) & 255);
}

/// Differences as small numbers: 0, -1, 1, -2 ... become 0, 1, 2, 3 ...
std::uint16_t zigzag(int difference) {
    const auto wrapped = static_cast<std::int16_t>(difference);
    return static_cast<std::uint16_t>((wrapped * 2) ^ (wrapped >> 15));
}

/// The numbers of a band before compression: bytes of one kind follow each other.
std::string band_numbers(std::span<const DepthPatch> patches) {
    std::string shapes;
    std::string values[2], slopes[4];
    const auto put = [](std::string* bytes, std::uint16_t number) {
        bytes[0] += static_cast<char>(number & 255);
        bytes[1] += static_cast<char>(number >> 8);
    };
    DepthPatch
        last;  // its plane foretells the next patch's value, which is often on the same surface
    int middle_x = 0, middle_y = 0;
    for (const DepthPatch& patch : patches) {
        shapes += static_cast<char>(patch.level | (patch.guessed ? 8 : 0) | patch.edges << 4);
        const int side = 1 << patch.level, x = 2 * patch.x + side - 1, y = 2 * patch.y + side - 1;
        const int ahead = (last.slope_x * (x - middle_x) + last.slope_y * (y - middle_y)) >> 7;
        put(values, zigzag(patch.value - std::clamp(last.value + ahead, 0, 65535)));
        last.value = patch.value;
        middle_x = x;
        middle_y = y;
        if (patch.level == 0) continue;
        put(slopes, zigzag(patch.slope_x - last.slope_x));
        put(slopes + 2, zigzag(patch.slope_y - last.slope_y));
        last.slope_x = patch.slope_x;
        last.slope_y = patch.slope_y;
    }
    std::string out;
    append_number(out, static_cast<std::uint32_t>(patches.size()));
    out += shapes;
    for (const std::string& bytes : values) out += bytes;
    for (const std::string& bytes : slopes) out += bytes;
    return out;
}

}  // namespace

float depth_step(const View& view, int width, double reach) {
    constexpr double kShift = 0.25;  // of a pixel that is off its plane [pixels]
    const double pixels = 0.5 * width / std::tan(view.horizontal * kPi / 360);
    return static_cast<float>(kShift / (double{kDepthTolerance} * pixels * reach));
}

std::vector<DepthPatch> depth_patches(const DepthPicture& picture, int band) {
    const int y0 = band * kDepthBand, y1 = std::min(y0 + kDepthBand, picture.height);
    return PatchCutter(picture, InverseDepths(picture, y0, y1), y0, y1).take();
}

std::string encode_depth_band(std::span<const DepthPatch> patches, bool last) {
    const std::string numbers = band_numbers(patches);
    z_stream stream{};
    constexpr int kRaw = -15, kMemory = 8;  // no header; zlib's own default
    if (deflateInit2(&stream, kCompression, Z_DEFLATED, kRaw, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
    constexpr std::size_t kFlush = 16;  // bytes that the end of a band takes beyond zlib's bound
    std::string out(deflateBound(&stream, numbers.size()) + kFlush, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(numbers.data()));
    stream.avail_in = static_cast<uInt>(numbers.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, last ? Z_FINISH : Z_FULL_FLUSH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

std::string encode_depth(float step, std::size_t patches, std::span<const std::string> bands) {
    std::string out;
    append_number(out, std::bit_cast<std::uint32_t>(step));
    append_number(out, static_cast<std::uint32_t>(patches));
    for (const std::string& band : bands) out += band;
    return out;
}

}  // namespace lightwalk
