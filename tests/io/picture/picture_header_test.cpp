#include "io/picture/picture_header.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "io/options/view_text.h"
#include "tests/shared_data.h"

using namespace lightwalk;

namespace {

PictureFacts facts() {
    PictureFacts facts;
    facts.scene_lines = {"#?RADIANCE", "oconv a.rad"};
    facts.command = "lightwalk render -x 64";
    facts.software = "Lightwalk 0.1";
    facts.time = 1795234654;  // 2026-11-21 04:17:34 UTC
    return facts;
}

}  // namespace

TEST_CASE("header lines stand in rpict's order") {
    PictureFacts f = facts();
    f.frame = 7;
    f.pixel_aspect = 1.25;
    const std::vector<std::string> lines = make_picture_header(f).lines;
    REQUIRE(lines.size() == 9);
    CHECK(lines[0] == "oconv a.rad");
    CHECK(lines[1] == "lightwalk render -x 64");
    CHECK(lines[2] == "SOFTWARE= Lightwalk 0.1");
    CHECK(lines[3] == "FRAME=7");
    CHECK(lines[4] == "VIEW= " + view_text(f.view));
    CHECK(lines[5] == "PIXASPECT=1.250000");
    CHECK(lines[6].starts_with("CAPDATE= 2026:11:2"));
    CHECK(lines[7] == "GMT= 2026:11:21 04:17:34");
    CHECK(lines[8] == "PRIMARIES= 0.6400 0.3300 0.2900 0.6000 0.1500 0.0600 0.3333 0.3333");
}

TEST_CASE("the pixel aspect is said only when it is not about 1") {
    for (const double aspect : {0.996, 1.0, 1.004}) {
        PictureFacts f = facts();
        f.pixel_aspect = aspect;
        for (const std::string& line : make_picture_header(f).lines)
            CHECK_FALSE(line.starts_with("PIXASPECT"));
    }
}

TEST_CASE("the whole file equals Radiance's, up to the scanlines") {
    LIGHTWALK_NEEDS_SHARED(path, "reference/pictures/virtual-back.hdr");
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    PictureFacts f;
    f.scene_lines = {"oconv -f plainoff.rad environ.rad furniture.rad"};
    f.command = "rpict -w -vf back.vp -x 320 -y 240 -ps 1 -pj 0 -dj 0 -ss 0 -dt 0 -ab 0 -av 4 4 4";
    f.software = "RADIANCE 6.1a 2026-11-21 LBNL (6.1.bcffc2b52d)";
    read_view_file(bytes, path, f.view);
    f.time = 1795234677;
    PictureHeader header = make_picture_header(f);
    for (std::string& line : header.lines) {
        if (line.starts_with("CAPDATE="))
            line = "CAPDATE= 2026:11:21 04:17:57";  // local time is this machine's
    }
    CHECK((encode_hdr(read_hdr(bytes, path), header) == bytes));
}
