#include "io/generators/luminaire_scene.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/math/vec3.h"
#include "core/math/xyz.h"
#include "io/generators/scene_writer.h"
#include "io/language/primitive_text.h"

namespace lightwalk {
namespace {

constexpr int kLuminaireDigits = 6;
constexpr double kFlatHeight = 0.001;     ///< of a body without sides [m]
constexpr double kHorizontal = 90;        ///< the vertical angle of what shines sideways [degrees]
constexpr double kAngleTolerance = 1e-6;  ///< [degrees]

using Form = LuminousBody::Form;

/// An axis of a data file: two ends when its points are evenly spaced, else all of them.
void append_axis(std::span<const double> points, std::string& out) {
    const double step = (points.back() - points.front()) / static_cast<double>(points.size() - 1);
    bool even = true;
    for (std::size_t i = 0; i < points.size(); ++i)
        even = even && std::abs(points[i] - (points.front() + static_cast<double>(i) * step)) <
                           kAngleTolerance;
    const std::string count = std::to_string(points.size());
    if (even) {
        out += general(points.front(), kLuminaireDigits) + " " +
               general(points.back(), kLuminaireDigits) + " " + count + "\n";
        return;
    }
    out += "0 0 " + count + "\n";
    for (const double point : points) out += " " + general(point, kLuminaireDigits);
    out += "\n";
}

void append_values(std::span<const double> values, double factor, std::string& out) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        out += i % 8 == 0 ? "\n" : " ";
        out += general(values[i] * factor, kLuminaireDigits);
    }
    out += "\n";
}

/// The coordinates of a direction in the data file, and the transform that they need.
struct DataCoordinates {
    std::vector<std::string> words, transform;
};

/// Of type C from the nadir, and around it in the planes that symmetry leaves.
DataCoordinates coordinates_c(const Photometry& photometry) {
    const double first = photometry.horizontal.front(), last = photometry.horizontal.back();
    const double range = last - first;
    if (photometry.horizontal.size() == 1) return {{"src_theta"}, {}};
    if (range <= 90) return {{"src_phi4", "src_theta"}, {}};
    if (range > 180) return {{"src_phi", "src_theta"}, {}};
    if (std::abs(first - 90) > kAngleTolerance) return {{"src_phi2", "src_theta"}, {}};
    // As ies2rad has it, by which the planes of 90 and of 270 degrees change places.
    return {{"src_phi2+90", "src_theta"}, {"-rz", "-90"}};
}

DataCoordinates coordinates_of(const Photometry& photometry) {
    if (photometry.type == PhotometryType::c) return coordinates_c(photometry);
    // Angles that begin with 0 are of both sides.
    const bool both = photometry.horizontal.front() == 0;
    DataCoordinates result;
    if (photometry.type == PhotometryType::b) {
        result.words = {both ? "srcB_horiz2" : "srcB_horiz", "srcB_vert"};
    } else {  // azimuth and elevation about the axis x, seen along -z
        result.words = {
            both ? "abs(atan2(Dy,Dz))/DEGREE" : "atan2(Dy,Dz)/DEGREE",
            photometry.vertical.front() == 0 ? "abs(Asin(-Dx))/DEGREE" : "Asin(-Dx)/DEGREE"};
    }
    if (photometry.horizontal.size() == 1) result.words.erase(result.words.begin());
    return result;
}

/// How the light of a body depends on its projected area, as source.cal has it.
struct BodyCorrection {
    std::string function;
    std::vector<double> reals;
};

class LuminaireWriter {
  public:
    LuminaireWriter(const Photometry& photometry, const LuminaireStyle& style)
        : photometry_(photometry), style_(style), body_(photometry.body) {
        const bool all = body_.form == Form::sphere;
        lower_ = all || photometry.vertical.front() < kHorizontal;
        upper_ = all || photometry.vertical.back() > kHorizontal;
        sides_ = lower_ && upper_ && body_.z > kFlatHeight;
    }

    std::string write() {
        write_pattern();
        const std::string light = style_.name + "_light";
        const Rgb c = style_.color;
        primitive(style_.name + "_dist", style_.illum ? "illum" : "light", light, {},
                  {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)});
        switch (body_.form) {
            case Form::box:
                write_box();
                break;
            case Form::cylinder:
                write_cylinder();
                break;
            case Form::sphere:
                surface("sphere", "s", {0, 0, 0, 0.5 * body_.x * style_.unit});
        }
        return std::move(out_);
    }

  private:
    void write_pattern() {
        const BodyCorrection correction = correction_of();
        const DataCoordinates coordinates = coordinates_of(photometry_);
        std::vector<std::string> words = {correction.function, style_.data_name, "source.cal"};
        words.insert(words.end(), coordinates.words.begin(), coordinates.words.end());
        words.insert(words.end(), coordinates.transform.begin(), coordinates.transform.end());
        primitive(style_.modifier, "brightdata", style_.name + "_dist", words, correction.reals);
    }

    [[nodiscard]] BodyCorrection correction_of() const {
        // Of a single argument Radiance 6.1a's source_corr() takes no notice: the ones are no
        // sizes.
        const double factor = photometry_.factor;
        const double disk = kPi / 4 * body_.x * body_.x;
        if (body_.form == Form::sphere) return {"corr", {factor / disk, 1}};
        const double area = body_.form == Form::box ? body_.x * body_.y : disk;
        if (!sides_) return {"flatcorr", {factor / area, 1}};
        if (body_.form == Form::cylinder) return {"cylcorr", {factor, body_.x, body_.z}};
        return {"boxcorr", {factor, body_.x, body_.y, body_.z}};
    }

    void write_box() {
        // The corners by the halves of x, y and z on which they lie.
        const double x = 0.5 * body_.x, y = 0.5 * body_.y, z = 0.5 * body_.z;
        const Vec3 d00{-x, -y, -z}, d10{x, -y, -z}, d11{x, y, -z}, d01{-x, y, -z};
        const Vec3 u00{-x, -y, z}, u10{x, -y, z}, u11{x, y, z}, u01{-x, y, z};
        if (lower_) polygon("d", {d00, d01, d11, d10});
        if (upper_) polygon("u", {u00, u10, u11, u01});
        if (!sides_) return;
        polygon("1", {d00, d10, u10, u00});
        polygon("2", {d10, d11, u11, u10});
        polygon("3", {d11, d01, u01, u11});
        polygon("4", {d01, d00, u00, u01});
    }

    void write_cylinder() {
        const double radius = 0.5 * body_.x * style_.unit, z = 0.5 * body_.z * style_.unit;
        if (lower_) surface("ring", "d", {0, 0, -z, 0, 0, -1, 0, radius});
        if (upper_) surface("ring", "u", {0, 0, z, 0, 0, 1, 0, radius});
        if (sides_) surface("cylinder", "c", {0, 0, z, 0, 0, -z, radius});
    }

    void polygon(std::string_view suffix, std::initializer_list<Vec3> corners) {
        std::vector<double> reals;
        for (const Vec3& p : corners)
            for (std::size_t axis = 0; axis < 3; ++axis) reals.push_back(p[axis] * style_.unit);
        surface("polygon", suffix, reals);
    }

    void surface(std::string_view type, std::string_view suffix, const std::vector<double>& reals) {
        primitive(style_.name + "_light", type, style_.name + "." + std::string(suffix), {}, reals);
    }

    void primitive(std::string_view modifier, std::string_view type, const std::string& name,
                   const std::vector<std::string>& strings, const std::vector<double>& reals) {
        append_primitive(modifier, type, name, strings, reals, kLuminaireDigits, out_);
    }

    const Photometry& photometry_;
    const LuminaireStyle& style_;
    const LuminousBody& body_;
    bool lower_ = false, upper_ = false, sides_ = false;  ///< what shines
    std::string out_;
};

}  // namespace

std::string luminaire_scene(const Photometry& photometry, const LuminaireStyle& style) {
    return LuminaireWriter(photometry, style).write();
}

std::string luminaire_data(const Photometry& photometry) {
    const bool one_plane = photometry.horizontal.size() == 1;
    std::string out = one_plane ? "1\n" : "2\n";
    if (!one_plane) append_axis(photometry.horizontal, out);
    append_axis(photometry.vertical, out);
    append_values(photometry.intensities, 1 / static_cast<double>(kEfficacy), out);
    return out;
}

std::string tilt_scene(const LampTilt& tilt, const std::string& name,
                       const std::string& data_name) {
    // Factors up to 90 degrees are of both halves.
    std::string angle = tilt.geometry == 1 ? "tilt_ang" : "tilt_xang";
    if (tilt.angles.back() <= 90) angle += "2";
    std::vector<std::string> words = {"noop", data_name, "tilt.cal", angle};
    if (tilt.geometry == 2) words.insert(words.end(), {"-rz", "90"});
    std::string out;
    append_primitive("void", "brightdata", name, words, {}, kLuminaireDigits, out);
    return out;
}

std::string tilt_data(const LampTilt& tilt) {
    std::string out = "1\n";
    append_axis(tilt.angles, out);
    append_values(tilt.factors, 1, out);
    return out;
}

}  // namespace lightwalk
