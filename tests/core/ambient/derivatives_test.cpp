// Radii, axes, gradients and corrals of hemispheres that Radiance sampled, held to the records that
// it made of them.
#include "core/ambient/derivatives.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "tests/shared_data.h"
#include "tests/tolerance.h"

namespace lightwalk {
using namespace test;

namespace {

struct Sampled {
    Hemisphere hemisphere;
    RadiusLimits limits;
    std::map<std::string, std::vector<double>> expected;
    std::uint32_t corral = 0;
};

std::vector<double> numbers(std::istream& in) {
    std::vector<double> values;
    for (double x = 0; in >> x;) values.push_back(x);
    return values;
}

void read_header(const std::string& line, Sampled& s, Vec3& point) {
    std::istringstream in(line.substr(2));
    std::string word, name;
    in >> word;
    if (word == "ns") {
        std::string skip;
        in >> s.hemisphere.divisions >> skip >> s.limits.weight >> skip >> s.limits.accuracy >>
            skip >> s.limits.least >> skip >> s.limits.most;
    } else if (word == "point") {
        Vec3& n = s.hemisphere.normal;
        Vec3& u = s.hemisphere.u;
        in >> point.x >> point.y >> point.z >> name >> n.x >> n.y >> n.z >> name >> u.x >> u.y >>
            u.z;
    } else if (word == "expect") {
        in >> name;
        if (name == "corral")
            in >> std::hex >> s.corral;
        else
            s.expected[name] = numbers(in);
    }
}

Sampled read_sampled(const std::string& path) {
    Sampled s;
    Vec3 point;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("#")) {
            read_header(line, s, point);
            continue;
        }
        Hemisphere& h = s.hemisphere;
        const auto n = static_cast<std::size_t>(h.divisions);
        h.cells.resize(n * n);
        std::istringstream in(line);
        std::size_t i = 0, j = 0;
        double distance = 0;
        Vec3 p;
        Rgb radiance;
        if (!(in >> i >> j >> p.x >> p.y >> p.z >> distance >> radiance.r >> radiance.g >>
              radiance.b))
            continue;
        HemisphereCell& cell = h.cells[i * n + j];
        cell.vertex = p - point;
        cell.nearness = 1 / distance;
        cell.value = radiance * (0.5f / static_cast<float>(n * n));
        h.sum += cell.value;
        ++h.succeeded;
    }
    s.hemisphere.v = cross(s.hemisphere.normal, s.hemisphere.u);
    return s;
}

/// The samples' frame was recovered from them, to a few 1e-4 rad, and gradients grow such errors.
constexpr double kRecorded = 2e-3;

void check_near(const std::array<double, 2>& found, const std::vector<double>& expected,
                double sign) {
    REQUIRE(expected.size() == 2);
    const double scale = std::max({std::abs(expected[0]), std::abs(expected[1]), 1e-6});
    for (std::size_t k = 0; k < 2; ++k)
        CHECK(std::abs(sign * found[k] - expected[k]) <= kRecorded * scale);
}

}  // namespace

TEST_CASE("records of sampled hemispheres have Radiance's radii, axes, gradients and corrals") {
    LIGHTWALK_NEEDS_SHARED(folder, "spec/5-cases");
    for (int file = 1; file <= 5; ++file) {
        CAPTURE(file);
        const Sampled s = read_sampled(folder + "/unit-hemi-" + std::to_string(file) + ".tsv");
        REQUIRE(s.hemisphere.complete());
        const AmbientDerivatives d = derive(s.hemisphere, s.limits);
        check_near(d.radius, s.expected.at("rad"), 1);
        const std::vector<double>& u = s.expected.at("u");
        const Vec3 axis{u.at(0), u.at(1), u.at(2)};
        const double sign = dot(axis, d.u) < 0 ? -1 : 1;  // both axes may be negated
        CHECK(length(d.u * sign - axis) < kRecorded);
        check_near(d.translation, s.expected.at("gpos"), sign);
        check_near(d.rotation, s.expected.at("gdir"), sign);
        const std::uint32_t turned = sign > 0 ? d.corral : (d.corral >> 16 | d.corral << 16);
        CHECK(std::popcount(turned ^ s.corral) <= 1);
        for (std::size_t k = 0; k < 3; ++k) {
            const double value = 2 * static_cast<double>(s.hemisphere.sum[k]);
            // The record's colour is RGBE: half a step of eight bits is up to 0.4 %.
            CHECK(value == within(0.004, s.expected.at("value")[k]));
        }
    }
}

namespace {

/// A box of 4 x 2 x 1 m; the point on its floor, off the middle.
class BrightRoom final : public HemisphereRays {
  public:
    bool start(const Vec3& d) override {
        const Vec3 p{1, 0.7, 0};
        double t = kHuge;
        const Vec3 size{4, 2, 1};
        for (std::size_t k = 0; k < 3; ++k) {
            if (d[k] != 0) t = std::min(t, ((d[k] > 0 ? size[k] : 0) - p[k]) / d[k]);
        }
        started_.push_back({Rgb::grey(0.5f / 1024), t > 0 ? t : kHuge});
        return true;
    }
    std::span<const HemisphereAnswer> trace() override {
        answers_.swap(started_);
        started_.clear();
        return answers_;
    }

  private:
    std::vector<HemisphereAnswer> started_, answers_;
};

}  // namespace

TEST_CASE("a closed room of one brightness has no gradients, however the walls stand") {
    BrightRoom rays;
    const Hemisphere h =
        sample_hemisphere({0, 0, 1}, {32, 0, 0.5 / 1024, 100}, RandomStream(5), rays);
    REQUIRE(h.complete());
    CHECK(static_cast<double>(h.sum.g) == rounded(0.5));
    const AmbientDerivatives d = derive(h, {0.1, 0.01, 1, 1});
    // What the jitter of 1024 samples leaves of terms near 1 that cancel: about 1/32, halved.
    CHECK(std::abs(d.translation[0]) < 0.02);
    CHECK(std::abs(d.translation[1]) < 0.02);
    CHECK(std::abs(d.rotation[0]) < 0.1);
}

}  // namespace lightwalk
