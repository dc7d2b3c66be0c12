#pragma once
// BSDF data for tests: matrices over Klems' quarter basis, and a library that has them as a.xml.
#include <memory>
#include <optional>
#include <utility>

#include "core/bsdf/bsdf.h"
#include "tests/test_scene.h"

namespace lightwalk::test {

/// A matrix over Klems' quarter basis with the same value everywhere but on the diagonal.
inline BsdfMatrix quarter(double constant, double peak = 0) {
    const AngleBasis basis = *klems_basis("LBNL/Klems Quarter");
    BsdfMatrix matrix{basis, basis, {}, {}};
    for (std::size_t i = 0; i < basis.size(); ++i) {
        for (std::size_t o = 0; o < basis.size(); ++o)
            matrix.y.push_back(
                static_cast<float>(constant + (i == o ? peak / basis.solid_angle(i) : 0)));
    }
    return matrix;
}

inline std::shared_ptr<const Bsdf> bsdf_of(std::optional<BsdfTable> transmission,
                                           std::optional<BsdfTable> reflection) {
    auto data = std::make_shared<BsdfData>();
    data->name = "test";
    data->parts = {transmission, transmission, reflection, reflection};
    return std::make_shared<const Bsdf>(data);
}

inline MemoryResources with_file(std::shared_ptr<const Bsdf> bsdf) {
    MemoryResources files;
    files.bsdfs["a.xml"] = std::move(bsdf);
    return files;
}

}  // namespace lightwalk::test
