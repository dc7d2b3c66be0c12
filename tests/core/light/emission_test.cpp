#include "core/light/emission.h"

#include <doctest/doctest.h>

#include "tests/test_scene.h"
#include "tests/tolerance.h"

using namespace lightwalk;
using namespace lightwalk::test;

TEST_CASE("mean emission: the material's, times the mean of patterns over what a source shows") {
    MemoryResources files;
    files.functions["f.cal"] =
        "quarter = .25; none = 0; upward = if(Dz, 2, 1); cosine = -(Dx*Nx + Dy*Ny + Dz*Nz);"
        "broken = sqrt(-1 - Px*Px);";
    std::string text;
    for (const char* name : {"quarter", "none", "upward", "cosine", "broken"})
        text += std::string("void brightfunc p_") + name + " 2 " + name + " f.cal 0 0\np_" + name +
                " light " + name + " 0 0 3 8 8 8\n";
    text +=
        "void light plain 0 0 3 8 8 8\nplain sphere a 0 0 4 0 0 0 1\n"
        "quarter sphere b 0 0 4 5 0 0 1\nnone sphere c 0 0 4 10 0 0 1\n"
        "upward sphere d 0 0 4 15 0 0 1\n"
        "cosine polygon e 0 0 12 20 0 0  21 0 0  21 1 0  20 1 0\n"
        "broken sphere f 0 0 4 25 0 0 1\nquarter source g 0 0 4 0 0 1 1\n";
    TestScene scene(text, TestScene::exact(), files);
    const std::size_t told = scene.warnings.messages.size();
    const std::vector<float> found = mean_emissions(scene.tracer.lights(), scene.tracer);
    REQUIRE(found.size() == 7);
    CHECK(found[0] == 8);
    CHECK(found[1] == rounded(2.0));
    CHECK(found[2] == rounded(0.5));  // nothing was seen, which does not mean that there is nothing
    CHECK(found[3] == rounded(12.0));  // seen from half of the directions
    // Over the half sphere, by the cosine: the integral of 2 c^2 is 2/3.
    CHECK(found[4] == within(0.01 * 8, 8 * 2.0 / 3));
    CHECK(found[5] == rounded(8.0));  // as in pictures, an error leaves the material's own
    CHECK(found[6] == rounded(2.0));
    CHECK(scene.warnings.messages.size() == told);
}
