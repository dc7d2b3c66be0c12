#include "io/photometry/eulumdat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/model/transform_args.h"
#include "io/formats/words.h"

namespace lightwalk {
namespace {

constexpr double kMetresInMillimetre = 0.001;
constexpr double kLargestEulumdat = 1e9;
constexpr double kPoint = 0.001;      ///< the size of a luminous area that has none [m]
constexpr double kFlatArea = 0.0005;  ///< its height [m]
constexpr std::size_t kMostPlanes = 721, kMostAngles = 361, kMostSets = 20;

class EulumdatReader {
  public:
    EulumdatReader(std::string_view text, const std::string& name) : rest_(text), where_{name, 0} {}

    EulumdatFile read() {
        skip(1);  // manufacturer
        (void)real("a type indicator");
        symmetry_ = count("symmetry indicator", 0, 4);
        const std::size_t planes = count("number of C-planes", 1, kMostPlanes);
        (void)real("a distance between C-planes");
        const std::size_t angles = count("number of intensities in a plane", 2, kMostAngles);
        (void)real("a distance between intensities");
        skip(5);  // report, luminaire, number, file, date
        for (int i = 0; i < 3; ++i) (void)real("a size of the luminaire");
        read_body();
        (void)real("the downward flux fraction");
        (void)real("the light output ratio");
        file_.photometry.factor = not_negative("a conversion factor");
        (void)real("the tilt");
        read_lamps();
        for (int i = 0; i < 10; ++i) (void)real("a direct ratio");
        read_distribution(planes, angles);
        return std::move(file_);
    }

  private:
    std::string_view line(const char* what) {
        ++where_.line;
        if (rest_.empty()) throw InputError(where_, std::string("the file ends, expected ") + what);
        return take_line(rest_);
    }
    void skip(int lines) {
        for (int i = 0; i < lines; ++i) (void)line("a line of text");
    }

    double real(const char* what) {
        std::string_view text = line(what);
        std::string word(take_word(text));
        std::ranges::replace(word, ',', '.');
        double value = 0;
        if (!parse_real(word, value) || !(std::abs(value) <= kLargestEulumdat))
            throw InputError(where_, "found \"" + word + "\", expected " + what);
        return value;
    }
    double not_negative(const char* what) {
        const double value = real(what);
        if (value < 0) throw InputError(where_, std::string(what) + " is negative");
        return value;
    }
    std::size_t count(const char* what, std::size_t least, std::size_t most) {
        const double value = real(what);
        if (value != std::floor(value) || value < static_cast<double>(least) ||
            value > static_cast<double>(most))
            throw InputError(where_, std::string("bad ") + what +
                                         ", expected a whole number from " + std::to_string(least) +
                                         " to " + std::to_string(most));
        return static_cast<std::size_t>(value);
    }

    void read_body() {
        const double length = not_negative("length of the luminous area") * kMetresInMillimetre;
        const double width = not_negative("width of the luminous area") * kMetresInMillimetre;
        double height = 0;
        for (int i = 0; i < 4; ++i)
            height = std::max(height, not_negative("height of the luminous area"));
        height = std::max(height * kMetresInMillimetre, kFlatArea);
        LuminousBody& body = file_.photometry.body;
        if (length == 0 && width == 0)
            body = {LuminousBody::Form::sphere, kPoint, kPoint, kPoint};
        else if (width == 0)
            body = {LuminousBody::Form::cylinder, length, length, height};
        else
            body = {LuminousBody::Form::box, width, std::max(length, kPoint), height};
    }

    /// The first set of lamps counts: others are what the luminaire may hold instead.
    void read_lamps() {
        const std::size_t sets = count("number of sets of lamps", 1, kMostSets);
        for (std::size_t i = 0; i < sets; ++i) {
            (void)real("a number of lamps");
            skip(1);  // their type
            const double flux = not_negative("the flux of the lamps");
            std::string_view color = line("a colour temperature");
            skip(1);  // group of colour rendering
            (void)real("watts");
            if (i > 0) continue;
            file_.flux = flux;
            file_.lamp = lamp_of(take_word(color));
        }
        file_.photometry.factor *= file_.flux / 1000;
    }

    /// Of "3000", "3000K", and what begins so; other texts are names of colours.
    static std::optional<Lamp> lamp_of(std::string_view text) {
        const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
        double kelvin = 0;
        if (!parse_real(text.substr(0, digits), kelvin)) return std::nullopt;
        return black_body(kelvin);
    }

    std::vector<double> ascending(std::size_t count, const char* what) {
        std::vector<double> values;
        while (values.size() < count) {
            const double value = real(what);
            if (!values.empty() && value <= values.back())
                throw InputError(where_, std::string("found ") + what +
                                             " that is not larger than the one before");
            values.push_back(value);
        }
        return values;
    }

    void read_distribution(std::size_t planes, std::size_t angles) {
        const std::size_t step = symmetry_ < 2 ? 1 : symmetry_ == 2 ? 2 : 4;
        if (planes % step != 0)
            throw InputError(where_, "a symmetric luminaire has " + std::to_string(planes) +
                                         " C-planes, expected a multiple of " +
                                         std::to_string(step));
        std::vector<double> c = ascending(planes, "the angle of a C-plane");
        Photometry& p = file_.photometry;
        p.vertical = ascending(angles, "an angle of intensity");
        const std::size_t held = symmetry_ == 0   ? planes
                                 : symmetry_ == 1 ? 1
                                 : symmetry_ == 4 ? planes / 4 + 1
                                                  : planes / 2 + 1;
        std::vector<std::vector<double>> rows(held);
        for (std::vector<double>& row : rows) {
            while (row.size() < angles) row.push_back(real("an intensity"));
        }
        if (symmetry_ == 3) rows = whole_circle(rows, planes);
        if (symmetry_ == 0 && planes > 1) rows.push_back(rows.front());
        c.push_back(c.front() + 360);  // where the whole circle closes
        p.horizontal.assign(c.begin(), c.begin() + static_cast<std::ptrdiff_t>(rows.size()));
        for (const std::vector<double>& row : rows)
            p.intensities.insert(p.intensities.end(), row.begin(), row.end());
    }

    /// Of the planes from C270 by C0 to C90: their mirror images complete the circle.
    static std::vector<std::vector<double>> whole_circle(
        const std::vector<std::vector<double>>& half, std::size_t planes) {
        std::vector<std::vector<double>> rows;
        const std::size_t quarter = planes / 4;
        for (std::size_t i = 0; i <= planes; ++i) {
            std::size_t plane = i % planes;
            if (plane > quarter && plane < 3 * quarter) plane = (6 * quarter - plane) % planes;
            rows.push_back(half[(plane + quarter) % planes]);
        }
        return rows;
    }

    std::string_view rest_;
    SourceLocation where_;
    std::size_t symmetry_ = 0;
    EulumdatFile file_;
};

}  // namespace

EulumdatFile decode_eulumdat(std::string_view text, const std::string& name) {
    return EulumdatReader(text, name).read();
}

std::optional<Lamp> black_body(double kelvin) {
    if (!(kelvin >= 1667 && kelvin <= 25000)) return std::nullopt;
    const double t = 1000 / kelvin;
    const double x = kelvin <= 4000 ? ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.179910
                                    : ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.240390;
    double y = 0;
    if (kelvin <= 2222)
        y = ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683;
    else if (kelvin <= 4000)
        y = ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867;
    else
        y = ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
    return Lamp{x, y, 1};
}

}  // namespace lightwalk
