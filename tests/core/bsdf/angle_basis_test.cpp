#include "core/bsdf/angle_basis.h"

#include <doctest/doctest.h>

#include <string>

#include "core/math/random.h"

using namespace lightwalk;

TEST_CASE("angle bases: Klems' have 145, 77 and 41 patches, older files' half basis 73") {
    CHECK(klems_basis("LBNL/Klems Full")->size() == 145);
    CHECK(klems_basis("LBNL/Klems Half")->size() == 77);
    CHECK(klems_basis("LBNL/Klems Quarter")->size() == 41);
    CHECK(old_klems_half_basis().size() == 73);
    CHECK_FALSE(klems_basis("LBNL/Klems Eighth"));
}

TEST_CASE("angle bases: patches fill the hemisphere, and samples of a patch lie in it") {
    for (const char* name : {"LBNL/Klems Full", "LBNL/Klems Half", "LBNL/Klems Quarter"}) {
        CAPTURE(std::string(name));
        const AngleBasis basis = *klems_basis(name);
        RandomStream random(7);
        double sum = 0;
        for (std::size_t patch = 0; patch < basis.size(); ++patch) {
            sum += basis.solid_angle(patch);
            CHECK(basis.solid_angle(patch) >= basis.least_solid_angle());
            for (int i = 0; i < 20; ++i)
                CHECK(basis.index(basis.sample(patch, random.next(), random.next())) == patch);
        }
        CHECK(sum == doctest::Approx(kPi).epsilon(1e-12));
    }
}

TEST_CASE("angle bases: a patch gets points of the disk in proportion to its solid angle") {
    const AngleBasis basis = *klems_basis("LBNL/Klems Quarter");
    std::vector<int> hits(basis.size());
    RandomStream random(11);
    constexpr int kPoints = 200000;
    for (int i = 0; i < kPoints; ++i) {
        const double radius = std::sqrt(random.next()), azimuth = 2 * kPi * random.next();
        ++hits[basis.index({radius * std::cos(azimuth), radius * std::sin(azimuth)})];
    }
    for (std::size_t patch = 0; patch < basis.size(); ++patch) {
        const double expected = kPoints * basis.solid_angle(patch) / kPi;
        CHECK(std::abs(hits[patch] - expected) < 5 * std::sqrt(expected));
    }
}

TEST_CASE(
    "angle bases: the first sector is centred on azimuth 0, the second follows counterclockwise") {
    const AngleBasis basis = *klems_basis("LBNL/Klems Full");
    const double sine = std::sin(10 * kPi / 180);  // ring of 8 sectors
    const auto at = [&](double degrees) {
        return basis.index(
            {sine * std::cos(degrees * kPi / 180), sine * std::sin(degrees * kPi / 180)});
    };
    CHECK(basis.index({0, 0}) == 0);
    CHECK(at(0) == 1);
    CHECK(at(22) == 1);
    CHECK(at(-22) == 1);
    CHECK(at(23) == 2);
    CHECK(at(-23) == 8);
}

TEST_CASE(
    "angle bases: directions that are looked up together are in the patches that each is in") {
    for (const AngleBasis& basis :
         {*klems_basis("LBNL/Klems Full"), *klems_basis("LBNL/Klems Half"),
          *klems_basis("LBNL/Klems Quarter"), AngleBasis({{90, 1}})}) {
        RandomStream random(5);
        for (int k = 0; k < 2000; ++k) {
            NearDirections near;
            for (std::size_t i = 0; i < kNearDirections; ++i) {
                const double radius = std::sqrt(random.next()), azimuth = 2 * kPi * random.next();
                near.x[i] = radius * std::cos(azimuth);
                near.y[i] = radius * std::sin(azimuth);
            }
            // Directions on the axes, and the pole.
            if (k < 100) near.x[static_cast<std::size_t>(k) % kNearDirections] = k % 3 ? 0.0 : -0.0;
            if (k < 50) near.y[static_cast<std::size_t>(k) % kNearDirections] = k % 5 ? 0.0 : -0.0;
            const PatchNumbers patches = basis.indices(near);
            for (std::size_t i = 0; i < kNearDirections; ++i)
                CHECK(patches[i] == basis.index({near.x[i], near.y[i]}));
        }
    }
}
