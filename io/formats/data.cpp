#include <algorithm>
#include <cmath>
#include <limits>

#include "core/model/transform_args.h"
#include "io/formats/decode.h"
#include "io/formats/words.h"

namespace lightwalk {
namespace {

constexpr long kMaxDimensions = 6;

std::string quoted(std::string_view word) {
    return '"' + std::string(word) + '"';
}

class DataReader {
  public:
    DataReader(std::string_view text, const std::string& name) : words_(text, name) {}

    DataArray read() {
        const long dimensions = integer("the number of dimensions");
        if (dimensions < 1 || dimensions > kMaxDimensions) {
            throw words_.error("bad number of dimensions " + std::to_string(dimensions) +
                               ", expected 1 to 6");
        }
        DataArray table;
        std::size_t size = 1;
        for (long i = 0; i < dimensions; ++i) {
            table.axes.push_back(axis());
            const std::size_t count = table.axes.back().count;
            if (count > words_.most_left() / size) throw too_short();
            size *= count;
        }
        table.values.reserve(size);
        while (table.values.size() < size) table.values.push_back(real("a value"));
        return table;
    }

  private:
    std::string_view word() {
        const std::optional<std::string_view> found = words_.next();
        if (!found) throw too_short();
        return *found;
    }
    long integer(const char* expected) {
        const std::string_view found = word();
        long value = 0;
        if (!parse_integer(found, value)) throw bad_format(found, expected);
        return value;
    }
    float real(const char* expected) {
        const std::string_view found = word();
        double value = 0;
        if (!parse_real(found, value)) throw bad_format(found, expected);
        if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()))) {
            throw bad_format(found, "a number within the range of floats");
        }
        return static_cast<float>(value);
    }
    DataArray::Axis axis() {
        DataArray::Axis axis;
        axis.origin = real("the beginning of a range");
        const float end = real("the end of a range");
        const long count = integer("a number of points");
        if (count < 2) throw bad_format(std::to_string(count), "at least 2 points");
        if (static_cast<unsigned long>(count) > words_.most_left()) throw too_short();
        axis.count = static_cast<std::uint32_t>(count);
        if (end == axis.origin) {
            read_points(axis);
        } else {
            axis.extent = end - axis.origin;
        }
        if (!std::isfinite(axis.extent))
            throw words_.error("bad format in data file: range too wide");
        return axis;
    }
    /// Coordinates must be monotonic. As in Radiance neighbours on a falling axis may be equal.
    void read_points(DataArray::Axis& axis) {
        std::vector<float>& p = axis.points;
        p.reserve(axis.count);
        while (p.size() < axis.count) {
            p.push_back(real("a coordinate"));
            const std::size_t n = p.size();
            if (n > 2 && (p[n - 3] < p[n - 2]) != (p[n - 2] < p[n - 1])) {
                throw words_.error("bad format in data file: coordinates are not monotonic");
            }
        }
        axis.origin = p.front();
        axis.extent = p.back() - p.front();
        if (axis.extent == 0)
            throw words_.error("bad format in data file: all coordinates are equal");
    }

    [[nodiscard]] InputError bad_format(std::string_view found, const char* expected) const {
        return words_.error("bad format in data file: found " + quoted(found) + ", expected " +
                            expected);
    }
    [[nodiscard]] InputError too_short() const {
        return words_.error("unexpected EOF in data file");
    }

    WordReader words_;
};

}  // namespace

DataArray decode_data(std::string_view text, const std::string& name) {
    return DataReader(text, name).read();
}

}  // namespace lightwalk
