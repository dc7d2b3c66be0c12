// What rad(1) makes of its file: options and views as `rad -n` of Radiance 6.1 prints them.
#include "io/rad/rad_options.h"

#include <doctest/doctest.h>

#include <sstream>
#include <string>
#include <vector>

#include "io/rad/rad_views.h"
#include "tests/temporary_folder.h"

namespace lightwalk {
namespace {

const std::string kInside = "ZONE= I 0 4 0 4 0 3\n";
constexpr double kEdge = 4.00002;  ///< of the cube of a room of that size [m]

RadPlan plan_of(const std::string& text) {
    return rad_plan(decode_rad_file("scene= room.rad\n" + text, "s.rif"));
}

std::string refusal_of_rad_plan(const std::string& text) {
    try {
        (void)plan_of(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

std::string options_of(const std::string& text) {
    const RadPlan plan = plan_of(text);
    std::ostringstream out;
    out << joined(rad_light_words(plan)) << " -ar "
        << rad_ambient_resolution(plan, *plan.zone, kEdge);
    if (const double step = rad_scatter_step(plan, *plan.zone); step > 0) out << " -ms " << step;
    out << ' ' << joined(rad_pixel_words(plan));
    return out.str();
}

/// The only view of a file, or one that is named.
std::string view_of_plan(const std::string& text, const std::string& name = "1") {
    const RadPlan plan = plan_of(text);
    return joined(rad_view_words(plan, find_rad_view(plan, name), *plan.zone));
}

TEST_CASE("rendering options are those of rad for quality, detail, variability and the rest") {
    CHECK(options_of(kInside) ==
          "-dp 128 -ds 0 -dt .1 -dc .5 -dr 0 -ss 0 -st .5 -aa .3 -ad 256 -as 0 -av 0.01 0.01 0.01 "
          "-lr 6 -lw .001 -ar 17 -ps 8 -pt .16");
    CHECK(options_of(kInside + "QUALITY= med\nDETAIL= h\nVAR= Medium\nINDIRECT= 2\n") ==
          "-dp 1024 -ds .3 -dt .07 -dc .7 -dr 1 -ss 1 -st .1 -ab 2 -aa .15 -ad 800 -as 128 -av "
          "0.01 0.01 0.01 -lr 8 -lw 1e-4 -ar 69 -ms 0.046 -ps 4 -pt .08");
    CHECK(options_of("ZONE= Exterior 0 4 0 4 0 3\nQUALITY= H\nPENUMBRAS= true\nAMBFILE= x.amb\n") ==
          "-dp 2048 -ds .1 -dj .9 -dt .04 -dc .9 -dr 3 -ss 16 -st .01 -ab 1 -af x.amb -aa .125 -ad "
          "512 -as 64 -av 10 10 10 -lr 12 -lw 5e-6 -ar 69 -ms 0.046 -ps 1 -pt .04");
    CHECK(options_of(kInside +
                     "QUALITY= L\nDETAIL= L\nVARIABILITY= H\nPENUMBRAS= T\nINDIRECT= 3\n") ==
          "-dp 64 -ds .4 -dt .1 -dc .5 -dr 0 -ss 0 -st .5 -aa .2 -ad 1024 -as 0 -av 0.01 0.01 0.01 "
          "-lr 6 -lw .001 -ar 8 -ps 16 -pt .16");
}

TEST_CASE("the ambient value is middle grey for the exposure") {
    for (const auto& [exposure, grey] :
         {std::pair{"1", "0.18"}, {"2.5", "0.072"}, {".01", "18"}, {"+1", "0.09"}, {"-2", "0.72"}})
        CHECK(options_of(kInside + "EXPOSURE= " + exposure)
                  .find(std::string("-av ") + grey + ' ' + grey + ' ' + grey + " -lr") !=
              std::string::npos);
    CHECK(plan_of("EXPOSURE= -2").exposure == 0.25);
}

TEST_CASE(
    "pictures have the size that is asked for, and the rays that rad draws before it filters") {
    CHECK(joined(rad_size_words(plan_of(""))) == "-x 512 -y 512");
    CHECK(joined(rad_size_words(plan_of("RESOLUTION= 300"))) == "-x 300 -y 300");
    CHECK(joined(rad_size_words(plan_of("RESOLUTION= 300 200 1.5"))) ==
          "-x 300 -y 200 -pa 1.500000");
    CHECK(rad_samples(plan_of("")) == 1);
    CHECK(rad_samples(plan_of("QUALITY= M")) == 4);
    CHECK(rad_samples(plan_of("QUALITY= H")) == 9);
}

TEST_CASE("standard views look from the sides of the zone to its middle") {
    CHECK(view_of_plan(kInside) == "-vtv -vp 3.8 2 1.5 -vd -4 0 0 -vu 0 0 1 -vh 45 -vv 45");
    CHECK(view_of_plan(kInside, "xyz") ==
          "-vtv -vp 0.2 0.2 0.15 -vd 4 4 3 -vu 0 0 1 -vh 45 -vv 45");
    CHECK(view_of_plan(kInside, "Xl") == "-vtl -vp 3.8 2 1.5 -vd -4 0 0 -vu 0 0 1 -vh 6.4 -vv 6.4");
    const std::string outside = "ZONE= E -1000 1234.5678 0 100 0 10\n";
    CHECK(view_of_plan(outside + "view= xyZ\n") ==
          "-vtv -vp -4.35e+03 -150 25 -vd 2.23e+03 100 -10 -vu 0 0 1 -vh 45 -vv 45");
    CHECK(view_of_plan(outside + "view= XyZa -vh 90\n") ==
          "-vta -vp 4.59e+03 -150 25 -vd -2.23e+03 100 -10 -vu 0 0 1 -vh 180 -vv 180 -vh 90");
    CHECK(view_of_plan(kInside, "xc").find("-vtc") == 0);
    CHECK(view_of_plan(kInside, "xc").find("-vh 180 -vv 90") != std::string::npos);
    for (const char* none : {"XX", "ZX", "q", "Xq", "l", "Xvl"})
        CHECK_THROWS_AS(view_of_plan(kInside, none), InputError);
}

TEST_CASE("up is the axis that is named, but for a view along it") {
    const auto up = [](const std::string& axis, const std::string& view) {
        const std::string text = view_of_plan(kInside + "UP= " + axis + "\nview= " + view + "\n");
        const std::size_t begin = text.find("-vu ") + 4;
        return text.substr(begin, text.find(" -v", begin) - begin);
    };
    CHECK(up("X", "x") == "0 0 1");
    CHECK(up("-X", "Y") == "-1 0 0");
    CHECK(up("y", "Y") == "1 0 0");
    CHECK(up("-Y", "X") == "0 -1 0");
    CHECK(up("Z", "z") == "0 1 0");
    CHECK(up("-Z", "Z") == "0 1 0");
    CHECK(up("-Z", "XY") == "0 0 -1");
    CHECK(view_of_plan(kInside + "UP= Y\nview= a -vp 1 1 1") == "-vu 0 1 0 -vp 1 1 1");
    CHECK(view_of_plan(kInside + "UP= Y\nview= -vp 1 1 1") == "-vp 1 1 1");  // as rad does
}

TEST_CASE("a view is found by its number, then its name, then as a standard one") {
    const std::string views = kInside + "view= 2 -vp 1 1 1\nview= b -vp 2 2 2\nview= -vp 3 3 3\n";
    CHECK(view_of_plan(views, "2") == "-vp 2 2 2");
    CHECK(view_of_plan(views, "b") == "-vp 2 2 2");
    CHECK(view_of_plan(views, "3") == "-vp 3 3 3");
    CHECK(view_of_plan(views, "Y").starts_with("-vtv -vp 2 3.8 1.5"));
    CHECK_THROWS_WITH_AS(
        view_of_plan(views, "c"),
        "s.rif: has no view \"c\": its views are 2, b, 3, and the standard ones X, x, Yl, xyZ ...",
        InputError);
}

TEST_CASE("a value that its variable cannot have is told with its line") {
    for (const auto& [line, expected] : {
             std::pair{"QUALITY= Mid", "expected Low, Medium or High, found \"Mid\""},
             {"DETAIL= Mediumm", "expected Low, Medium or High, found \"Mediumm\""},
             {"PENUMBRAS= yes", "expected True or False, found \"yes\""},
             {"INDIRECT= 1.5", "expected a number of bounces, found \"1.5\""},
             {"EXPOSURE= x", "expected a positive factor"},
             {"EXPOSURE= 0", "expected a positive factor"},
             {"ZONE= Q 0 4 0 4 0 3", "expected Interior or Exterior"},
             {"ZONE= I 0 4 0 4 0", "expected Interior or Exterior"},
             {"ZONE= I 4 0 0 4 0 3", "expected Interior or Exterior"},
             {"RESOLUTION= 300x200", "expected a width"},
             {"RESOLUTION= 0", "expected a width"},
             {"UP= W", "expected an axis"},
             {"view= entrance", "view \"entrance\" has no options"},
             {"scene= 'a", "a quote that does not end"},
         }) {
        CAPTURE(line);
        CHECK(refusal_of_rad_plan(std::string("\n") + line)
                  .find("s.rif:3: " + std::string(expected)) == 0);
    }
    CHECK(refusal_of_rad_plan("ZONE= Interior 0 4 0 4 0 3 7\nQUALITY= HI\nPENUMBRAS= tru") ==
          "no error");
}

TEST_CASE("the scene is its files, in rad's order, or its octree where they are not there") {
    const test::TemporaryFolder folder;
    const auto at = [&](const std::string& name) { return folder.path(name); };
    folder.write("a.rad", "");
    folder.write("b.rad", "");
    const auto files = real_files();
    const auto scene = [&](const std::string& text) {
        RadPlan plan = rad_plan(decode_rad_file(text, at("s.rif")));
        std::vector<std::string> names = rad_scene_files(plan, *files);
        names.insert(names.end(), plan.notices.begin(), plan.notices.end());
        return names;
    };
    const std::string a = at("a.rad"), b = at("b.rad"), lost = at("lost.rad");
    CHECK(scene("scene= " + a + "\nmaterials= " + b + "\nobjects= " + lost) ==
          std::vector<std::string>{b, a});
    CHECK(scene("scene= '!xform -rz 5 b.rad' " + a + "\noconv= -f -i base.oct -r 999") ==
          std::vector<std::string>{"base.oct", "!xform -rz 5 b.rad", a});
    CHECK(scene("illum= " + a + "\nscene= " + b)[1] == a);
    CHECK(scene("illum= " + a + "\nscene= " + b)[2].find("illum=: mkillum is not run") !=
          std::string::npos);
    CHECK_THROWS_WITH_AS(scene("scene= " + a + "\nscene= " + lost),
                         (at("s.rif") + ":2: cannot read \"" + lost +
                          "\"; names are relative to the working directory")
                             .c_str(),
                         InputError);
    CHECK_THROWS_AS(scene("OCTREE= " + at("x.oct")), InputError);
    folder.write("s.oct", "");
    folder.write("x.oct", "");
    CHECK(scene("QUALITY= L") == std::vector<std::string>{at("s.oct")});
    CHECK(scene("OCTREE= " + at("x.oct")) == std::vector<std::string>{at("x.oct")});
    CHECK(scene("scene= " + a) == std::vector<std::string>{a});
    const std::vector<std::string> taken = scene("scene= " + lost);
    REQUIRE(taken.size() == 2);
    CHECK(taken[0] == at("s.oct"));
    CHECK(taken[1].find("lost.rad cannot be read, the octree") != std::string::npos);
}

}  // namespace
}  // namespace lightwalk
