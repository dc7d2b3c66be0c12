#include "core/model/primitive.h"

#include <doctest/doctest.h>

#include <set>
#include <string>

namespace lightwalk {
namespace {

constexpr int kTypes = static_cast<int>(PrimitiveType::alias) + 1;

TEST_CASE("every type has its own word, and the word leads back to the type") {
    std::set<std::string_view> words;
    for (int i = 0; i < kTypes; ++i) {
        const auto type = static_cast<PrimitiveType>(i);
        const std::string_view word = to_string(type);
        CAPTURE(std::string(word));
        CHECK(words.insert(word).second);
        CHECK(primitive_type(word) == type);
    }
    CHECK(words.size() == 59);
}

TEST_CASE("the words are those of the scene language, in their own case") {
    CHECK(primitive_type("BRTDfunc") == PrimitiveType::brtdfunc);
    CHECK(primitive_type("WGMDfunc") == PrimitiveType::wgmdfunc);
    CHECK(primitive_type("aBSDF") == PrimitiveType::absdf);
    CHECK(primitive_type("mesh") == PrimitiveType::mesh);
    CHECK(primitive_type("specpict") == PrimitiveType::specpict);
    CHECK_FALSE(primitive_type("brtdfunc"));
    CHECK_FALSE(primitive_type("Polygon"));
    CHECK_FALSE(primitive_type(""));
}

TEST_CASE("11 types are surfaces, 29 materials, 4 mixtures, and no type is two of these") {
    int surfaces = 0, materials = 0, mixtures = 0;
    for (int i = 0; i < kTypes; ++i) {
        const auto type = static_cast<PrimitiveType>(i);
        surfaces += is_surface(type) ? 1 : 0;
        materials += is_material(type) ? 1 : 0;
        mixtures += is_mixture(type) ? 1 : 0;
        CHECK(int{is_surface(type)} + int{is_material(type)} + int{is_mixture(type)} <= 1);
    }
    CHECK(surfaces == 11);
    CHECK(materials == 29);
    CHECK(mixtures == 4);
    CHECK(is_surface(PrimitiveType::source));
    CHECK(is_surface(PrimitiveType::mesh));
    CHECK(is_material(PrimitiveType::antimatter));
    CHECK_FALSE(is_material(PrimitiveType::texfunc));
    CHECK(is_mixture(PrimitiveType::mixtext));
}

}  // namespace
}  // namespace lightwalk
