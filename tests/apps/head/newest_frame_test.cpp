// The newest frame is what the client has by now that it is followed of.
#include "apps/head/newest_frame.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace lightwalk::test {
namespace {

constexpr ClientId kFirst{1}, kSecond{2};
constexpr int kHalf = 160, kHeight = 120;

/// A frame of two halves, of which it brings those that have bytes.
std::string frame_of(std::uint32_t number, bool whole, const std::string& left,
                     const std::string& right, const std::string& depth = "",
                     std::uint32_t view = 7) {
    WalkFrameHeader header;
    header.frame = number;
    header.view = view;
    header.width = 2 * kHalf;
    header.height = kHeight;
    header.whole = whole;
    header.eye = {1, 2, 1.5};
    std::vector<WalkFramePiece> pieces;
    if (!left.empty()) pieces.push_back({0, 0, kHalf, kHeight, PieceCodec::jpeg, left});
    if (!right.empty()) pieces.push_back({kHalf, 0, kHalf, kHeight, PieceCodec::jpeg, right});
    if (!depth.empty())
        pieces.push_back({0, 0, header.width, header.height, PieceCodec::depth, depth});
    return encode_walk_frame(header, pieces);
}

std::string shown(const NewestFrame& newest, bool depth = false) {
    HelloRequest to;
    to.depth = depth;
    const auto messages = newest.messages(to);
    return messages ? messages->frame : "nothing";
}

std::string view_text(int id) {
    return R"({"type":"view","id":)" + std::to_string(id) +
           R"(,"view":{"type":"v","position":[1,2,3],"direction":[0,1,0],"up":[0,0,1],)"
           R"("horizontal":60,"vertical":40},"width":320,"height":120,"moving":false,"walk":true})";
}

}  // namespace

TEST_CASE("newest frame: what is sent piece by piece is told as a whole, with what was asked for") {
    NewestFrame newest;
    CHECK(shown(newest) == "nothing");
    newest.came(kFirst, true, frame_of(1, true, "a", "b", "d"));
    newest.came(kFirst, true, frame_of(2, false, "", "c"));
    CHECK(shown(newest) == frame_of(2, true, "a", "c"));
    CHECK(shown(newest, true) == frame_of(2, true, "a", "c", "d"));
    newest.came(kFirst, true, "no frame");
    CHECK(shown(newest) == frame_of(2, true, "a", "c"));
}

TEST_CASE("newest frame: it is one client's, and who drives goes before") {
    NewestFrame newest;
    newest.came(kFirst, false, frame_of(1, true, "a", "b"));
    newest.came(kSecond, false, frame_of(2, true, "x", "y"));
    newest.came(kSecond, false, frame_of(3, false, "z", ""));
    CHECK(shown(newest) == frame_of(1, true, "a", "b"));
    newest.came(kSecond, true, frame_of(4, true, "x", "y"));
    newest.came(kFirst, false, frame_of(5, false, "c", ""));
    CHECK(shown(newest) == frame_of(4, true, "x", "y"));
    newest.left(kSecond);
    CHECK(shown(newest) == frame_of(4, true, "x", "y"));
    newest.came(kFirst, false, frame_of(6, false, "c", ""));  // of what it had before
    CHECK(shown(newest) == frame_of(4, true, "x", "y"));
    newest.came(kFirst, false, frame_of(7, true, "e", "f"));
    CHECK(shown(newest) == frame_of(7, true, "e", "f"));
}

TEST_CASE("newest frame: pieces that do not belong to the picture end it") {
    NewestFrame newest;
    newest.came(kFirst, true, frame_of(1, true, "a", ""));
    newest.came(kFirst, true, frame_of(2, false, "", "b"));
    CHECK(shown(newest) == "nothing");
    newest.came(kFirst, true, frame_of(3, false, "a", ""));
    CHECK(shown(newest) == "nothing");
    newest.came(kFirst, true, frame_of(4, true, "a", "b"));
    CHECK(shown(newest) == frame_of(4, true, "a", "b"));
}

TEST_CASE("newest frame: its view is the one that was asked for, from where the eye was") {
    NewestFrame newest;
    for (int id = 1; id < 9; ++id) newest.said(view_text(id));
    newest.said(R"({"type":"view","id":9})");  // malformed: the run says so
    newest.said(R"({"type":"display","mode":"false","exposure":{"auto":true,"ev":0},"human":false,)"
                R"("scale":{"low":1,"high":100,"log":true},"number":3})");
    newest.came(kFirst, true, frame_of(1, true, "a", "b"));
    const auto told = newest.messages({});
    REQUIRE(told);
    REQUIRE(told->texts.size() == 2);
    CHECK(told->texts[0].find(R"("number":3)") != std::string::npos);
    CHECK(told->texts[1].find(R"("position":[1.0,2.0,1.5])") != std::string::npos);
    CHECK(told->texts[1].find(R"("type":"view")") != std::string::npos);
    newest.came(kFirst, true, frame_of(2, false, "c", "", "", 1));  // of another client's view
    CHECK(newest.messages({})->texts.size() == 1);
}

}  // namespace lightwalk::test
