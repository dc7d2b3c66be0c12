#include "io/net/walk_request.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"

using namespace lightwalk;
using nlohmann::json;

namespace {

// One of each type.
const std::vector<std::string> kSound{
    R"({"type":"hello","session":"0123456789abcdefABCDEF"})",
    R"({"type":"view","id":4294967295,"view":{"type":"v","position":[1,2,1.6],"direction":[0,1,0],)"
    R"("up":[0,0,1],"horizontal":60,"vertical":40.5,"fore":0.1,"aft":9,"shift":0.25,"lift":-0.5},)"
    R"("width":640,"height":480,"moving":true,"walk":false})",
    R"({"type":"ack","frame":17})",
    R"({"type":"display","mode":"tone","exposure":{"auto":false,"ev":-2.5},"human":true,)"
    R"("scale":{"low":0.1,"high":3000,"log":true}})",
    R"({"type":"settings","ambient":"always"})",
    R"({"type":"pick","id":3,"x":0.25,"y":1})",
    R"({"type":"rectangle","id":4,"rect":[0,0.25,0.5,1]})",
    R"({"type":"probes","probes":[{"id":1,"position":[1,2,3],"normal":[0,0,2]},)"
    R"({"id":2,"position":[-1,0,0],"normal":[1,0,0]}]})",
    R"({"type":"glare","id":5})",
    R"({"type":"take"})",
    R"({"type":"hand","to":2})",
    R"({"type":"hello","session":"0123456789abcdef","depth":true})",
    R"({"type":"pick","id":3,"x":0.25,"y":1,"view":{"type":"v","position":[1,2,1.6],)"
    R"("direction":[0,1,0],"up":[0,0,1],"horizontal":60,"vertical":40.5}})",
    R"({"type":"plan","id":6})",
    R"({"type":"isolux","id":7,"position":[1,2,0.5],"normal":[0,0,4]})",
    R"({"type":"isolux","id":8,"position":[1,2,1.6],"height":0.75})",
    R"({"type":"material","id":9,"x":0.5,"y":0.25})",
    R"({"type":"time","time":{"month":9,"day":21,"hour":14.3,"sky":"+s"}})",
    R"({"type":"difference","shown":true})",
};

/// Fields of these messages that need not be there.
const std::map<std::size_t, std::string> kMayBeMissing{{11, "depth"}, {12, "view"}, {15, "height"}};

json sound(std::size_t k) {
    return json::parse(kSound[k]);
}

template <class Request>
Request read(const json& message, WalkSizeLimit limit = {}) {
    return std::get<Request>(parse_walk_request(message.dump(), limit));
}

std::string refusal(const std::string& text) {
    try {
        (void)parse_walk_request(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

/// The message with one value put in another's place.
std::string refusal(std::size_t k, const char* pointer, const json& value) {
    json message = sound(k);
    message[json::json_pointer(pointer)] = value;
    return refusal(message.dump());
}

}  // namespace

TEST_CASE("walk request: each message is read as it stands") {
    CHECK(read<HelloRequest>(sound(0)).session == "0123456789abcdefABCDEF");
    const auto view = read<ViewRequest>(sound(1));
    CHECK(view.id == 4294967295u);
    CHECK(view.view == View{'v', {1, 2, 1.6}, {0, 1, 0}, {0, 0, 1}, 60, 40.5, 0.1, 9, 0.25, -0.5});
    CHECK(view.width == 640);
    CHECK(view.height == 480);
    CHECK(view.moving);
    CHECK_FALSE(view.walk);
    CHECK(read<AckRequest>(sound(2)).frame == 17);
    CHECK(read<DisplayRequest>(sound(3)) ==
          DisplayRequest{{false, false, -2.5, true, 0.1, 3000, true}, 0});
    json numbered = sound(3);
    numbered["number"] = 255;
    CHECK(read<DisplayRequest>(numbered).number == 255);
    for (const json& wrong : {json(256), json(-1), json("1")})
        CHECK_FALSE(refusal(3, "/number", wrong).empty());
    json hello = sound(0);
    CHECK_FALSE(read<HelloRequest>(hello).luminance);
    hello["luminance"] = true;
    CHECK(read<HelloRequest>(hello).luminance);
    CHECK_FALSE(read<HelloRequest>(hello).depth);
    CHECK(read<SettingsRequest>(sound(4)).ambient == WalkAmbient::always);
    const auto pick = read<PickRequest>(sound(5));
    CHECK(pick.id == 3);
    CHECK(pick.x == 0.25);
    CHECK(pick.y == 1);
    const auto mean = read<MeanRequest>(sound(6));
    CHECK(mean.id == 4);
    CHECK(mean.x0 == 0);
    CHECK(mean.y0 == 0.25);
    CHECK(mean.x1 == 0.5);
    CHECK(mean.y1 == 1);
    const auto probes = read<ProbesRequest>(sound(7)).probes;
    REQUIRE(probes.size() == 2);
    CHECK(probes[0].id == 1);
    CHECK(probes[0].position == Vec3{1, 2, 3});
    CHECK(probes[0].normal == Vec3{0, 0, 1});
    CHECK(read<GlareRequest>(sound(8)).id == 5);
    (void)read<TakeRequest>(sound(9));
    CHECK(read<HandRequest>(sound(10)).to == 2);
    CHECK(read<PlanRequest>(sound(13)).id == 6);
    CHECK_FALSE(read<HelloRequest>(sound(0)).beside);
    hello["beside"] = true;
    CHECK(read<HelloRequest>(hello).beside);
    CHECK(refusal(0, "/beside", 1) != "accepted");
    CHECK(read<DifferenceRequest>(sound(18)).shown);
}

TEST_CASE("walk request: what may be missing may, what is not known is ignored") {
    json view = sound(1);
    for (const char* name : {"fore", "aft", "shift", "lift"}) view["view"].erase(name);
    view["later"] = {{"any", "thing"}};
    const View read_view = read<ViewRequest>(view).view;
    CHECK(read_view.fore == 0);
    CHECK(read_view.lift == 0);
    CHECK_FALSE(read<ViewRequest>(view).seen);
}

TEST_CASE("walk request: what the page draws meanwhile is a view, as the one that it asks for") {
    json message = sound(1);
    message["seen"] = message["view"];
    message["seen"]["horizontal"] = 50;
    const auto request = read<ViewRequest>(message);
    REQUIRE(request.seen);
    CHECK(request.seen->horizontal == 50);
    CHECK(request.view.horizontal == 60);
    CHECK_FALSE(refusal(1, "/seen", nullptr).empty());
    message["seen"]["horizontal"] = 0;
    CHECK_THROWS_AS((void)parse_walk_request(message.dump()), InputError);
}

TEST_CASE("walk request: every other field that is missing or of another type is refused") {
    for (std::size_t k = 0; k < kSound.size(); ++k) {
        const json whole = sound(k), fields = whole.flatten();
        for (const auto& [pointer, value] : fields.items()) {
            CAPTURE(pointer);
            CAPTURE(k);
            CHECK(refusal(k, pointer.c_str(), json::object()) != "accepted");
            CHECK(refusal(k, pointer.c_str(), nullptr) != "accepted");
            CHECK(refusal(k, pointer.c_str(), "1") != "accepted");
            if (!value.is_number()) CHECK(refusal(k, pointer.c_str(), 1) != "accepted");
        }
        for (const auto& [name, value] : whole.items()) {
            json message = whole;
            message.erase(name);
            if (kMayBeMissing.contains(k) && name == kMayBeMissing.at(k)) continue;
            CHECK(refusal(message.dump()) == "\"" + name + "\" is missing");
        }
    }
}

TEST_CASE("walk request: numbers beyond their range are refused, also where none is infinite") {
    CHECK(refusal(1, "/view/position/0", 1e30) ==
          "\"position\": expected a number within its range");
    CHECK(refusal(1, "/view/direction", {0, 0, 0}) == "zero view direction");
    CHECK(refusal(1, "/view/up", {0, 0, 0}) == "zero view up vector");
    CHECK(refusal(1, "/view/up", {0, -3, 0}) == "view up parallel to view direction");
    CHECK(refusal(1, "/view/horizontal", 180) == "illegal horizontal view size");
    CHECK(refusal(1, "/view/vertical", 0) == "illegal vertical view size");
    CHECK(refusal(1, "/view/aft", 0.05) == "illegal fore/aft clipping plane");
    CHECK(refusal(1, "/view/type", "x") == "unknown view type 'x'");
    CHECK(refusal(1, "/view/type", "vv") == "\"type\": expected one of the letters v l c h a s");
    for (const json& wrong : std::vector<json>{0, -1, 4097, 1e30, 0.5, true}) {
        CAPTURE(wrong.dump());
        CHECK(refusal(1, "/width", wrong) != "accepted");
        CHECK(refusal(1, "/height", wrong) != "accepted");
    }
    for (const json& wrong : std::vector<json>{-1, 4294967296, 1.5, 1e30}) {
        CAPTURE(wrong.dump());
        CHECK(refusal(1, "/id", wrong) != "accepted");
        CHECK(refusal(2, "/frame", wrong) != "accepted");
    }
    CHECK(refusal(3, "/exposure/ev", 41) != "accepted");
    CHECK(refusal(3, "/scale/low", 3000) == "\"scale\": expected low below high");
    CHECK(refusal(3, "/scale/low", 0) == "\"low\": expected more than 0 on a logarithmic scale");
    CHECK(refusal(3, "/scale/high", 1e13) != "accepted");
    CHECK(refusal(5, "/x", -0.01) != "accepted");
    CHECK(refusal(5, "/y", 1.01) != "accepted");
    CHECK(refusal(6, "/rect", {0.5, 0, 0.5, 1}) ==
          "\"rect\": expected left, bottom, right, top with left < right and bottom < top");
    CHECK(refusal(6, "/rect", {0, 0, 1}) == "\"rect\": expected a list of the right length");
    CHECK(refusal(7, "/probes/1/normal", {0, 0, 0}) == "\"normal\": expected a direction");
    CHECK(refusal(7, "/probes/0/position", {1e30, 0, 0}) != "accepted");
    CHECK(refusal(7, "/probes", std::vector<json>(65, sound(7)["probes"][0])) ==
          "\"probes\": expected a list of the right length");
    CHECK(read<ProbesRequest>(
              {{"type", "probes"}, {"probes", std::vector<json>(64, sound(7)["probes"][0])}})
              .probes.size() == 64);
}

TEST_CASE("walk request: a plane is that of a surface, or lies above the floor") {
    const auto surface = read<IsoluxRequest>(sound(14));
    CHECK(surface.id == 7);
    CHECK(surface.position == Vec3{1, 2, 0.5});
    CHECK(surface.normal == Vec3{0, 0, 1});
    const auto level = read<IsoluxRequest>(sound(15));
    CHECK_FALSE(level.normal);
    CHECK(level.height == 0.75);
    CHECK(refusal(14, "/normal", {0, 0, 0}) == "\"normal\": expected a direction");
    CHECK(refusal(14, "/normal", {0, 0, 1e30}) != "accepted");
    CHECK(refusal(14, "/position/2", 1e10) != "accepted");
    CHECK(refusal(14, "/height", 1) == "\"height\": expected no normal beside it");
    for (const json& wrong : std::vector<json>{-0.001, 1e10, "1", true, nullptr}) {
        CAPTURE(wrong.dump());
        CHECK(refusal(15, "/height", wrong) != "accepted");
    }
    json none = sound(15);
    none.erase("height");
    CHECK(refusal(none.dump()) == "\"normal\" is missing");
}

TEST_CASE("walk request: dimmers are read, and refused where they are beyond what can be shown") {
    const json lamp{{"name", "desk"}, {"level", 1.5}, {"rgb", {1, 0.5, 0.25}}};
    const json message{{"type", "lights"}, {"levels", {lamp}}};
    CHECK(read<LightsRequest>(message).levels ==
          std::vector<LightLevel>{{"desk", 1.5, {1, 0.5f, 0.25f}}});
    CHECK(read<LightsRequest>({{"type", "lights"}, {"levels", json::array()}}).levels.empty());
    const auto refused = [&](const char* pointer, const json& value) {
        json wrong = message;
        wrong[json::json_pointer(pointer)] = value;
        return refusal(wrong.dump()) != "accepted";
    };
    for (const json& value : std::vector<json>{-0.1, 101, 1e30, nullptr, "1", json::array()}) {
        CAPTURE(value.dump());
        CHECK(refused("/levels/0/level", value));
        CHECK(refused("/levels/0/rgb/1", value));
        CHECK(refused("/levels/0/rgb", value));
        CHECK(refused("/levels/0", value));
        CHECK(refused("/levels", json::array({lamp, value})));
    }
    CHECK(refused("/levels/0/name", 7));
    CHECK(refused("/levels/0/name", std::string(257, 'x')));
    CHECK(refused("/levels", json::array({lamp, lamp})));
    json many = json::array();
    for (std::size_t i = 0; i <= kMostLightLevels; ++i) {
        many.push_back(lamp);
        many.back()["name"] = std::to_string(i);
    }
    CHECK(refused("/levels", many));
    CHECK(refused("/levels", json::object()));
}

TEST_CASE("walk request: words that are none of the known are refused") {
    CHECK(refusal(0, "/session", "0123456789abcde") == "\"session\": expected 16 to 64 hex digits");
    CHECK(refusal(0, "/session", "0123456789abcdeg") != "accepted");
    CHECK(refusal(0, "/session", std::string(65, 'a')) != "accepted");
    CHECK(refusal(3, "/mode", "grey") == "\"mode\": expected \"tone\" or \"false\"");
    CHECK(refusal(4, "/ambient", "") == "\"ambient\": expected \"rest\", \"always\" or \"off\"");
    CHECK(refusal(9, "/type", "toke") == "unknown type of message \"toke\"");
}

TEST_CASE("walk request: what is no JSON object is refused, however long or deep") {
    for (const char* text : {"", "x", "{", "[]", "1", "null", "\"take\"", R"({"type":"take"}x)",
                             R"({"type":"ack","frame":NaN})", R"({"type":"ack","frame":1e400})",
                             R"({"type":"ack","frame":Infinity})", "{\"type\":\"t\xff\"}"}) {
        CAPTURE(text);
        CHECK(refusal(text) != "accepted");
    }
    CHECK(refusal("{\"type\":\"take\"" + std::string(70'000, ' ') + "}") ==
          "message is longer than 64 KB");
    CHECK(refusal(std::string(60'000, '[')) == "JSON is nested too deep");
    CHECK(refusal(R"({"type":"take","x":)" + std::string(20'000, '[') + std::string(20'000, ']') +
                  "}") == "JSON is nested too deep");
    CHECK(refusal(R"({"type":"take","x":[[[[[[]]]]]]})") == "accepted");
}

TEST_CASE("walk request: a window larger than the limit is shrunk in proportion") {
    const auto size = [](int width, int height, WalkSizeLimit limit) {
        json message = sound(1);
        message["width"] = width;
        message["height"] = height;
        const auto request = read<ViewRequest>(message, limit);
        return std::pair(request.width, request.height);
    };
    CHECK(size(640, 480, {1280, 720}) == std::pair(640, 480));
    CHECK(size(1280, 720, {1280, 720}) == std::pair(1280, 720));
    CHECK(size(2560, 1440, {1280, 720}) == std::pair(1280, 720));
    CHECK(size(4096, 1024, {1280, 720}) == std::pair(1280, 320));
    CHECK(size(1000, 2000, {1280, 720}) == std::pair(360, 720));
    CHECK(size(4096, 1, {1280, 720}) == std::pair(1280, 1));
    CHECK(size(1, 4096, {1280, 720}) == std::pair(1, 720));
}

TEST_CASE(
    "walk request: ten thousand random and malformed messages give a value or an InputError") {
    std::mt19937 random(12);
    const std::vector<std::string> pieces{"null", "-1",  "1e30", "1e309", "\"\"", "[]",   "{}",
                                          "true", "\\u", "[",    "}",     "\"",   "\xf0", "0.5"};
    int accepted = 0;
    for (int i = 0; i < 10'000; ++i) {
        std::string text = kSound[random() % kSound.size()];
        for (unsigned changes = random() % 4; changes > 0 && !text.empty(); --changes) {
            const std::size_t at = random() % text.size();
            switch (random() % 5) {
                case 0:
                    text[at] = static_cast<char>(random());
                    break;
                case 1:
                    text.erase(at, random() % 8);
                    break;
                case 2:
                    text.insert(at, pieces[random() % pieces.size()]);
                    break;
                case 3:
                    text.replace(at, 1 + random() % 3, pieces[random() % pieces.size()]);
                    break;
                default:
                    text[at] = static_cast<char>('0' + random() % 10);
            }
        }
        try {
            const WalkRequest request = parse_walk_request(text, {1280, 720});
            ++accepted;
            if (const auto* view = std::get_if<ViewRequest>(&request)) {
                CHECK_FALSE(Camera::problem(view->view));
                CHECK((view->width >= 1 && view->width <= 1280));
                CHECK((view->height >= 1 && view->height <= 720));
                CHECK(length(view->view.position) < 2e9);
            }
        } catch (const InputError& error) {
            CHECK(std::string(error.what()).size() < 200);
        }
    }
    CHECK((accepted > 2500 && accepted < 7500));
}

TEST_CASE("walk request: whether frames shall have depth may be missing, and the view of a pick") {
    CHECK_FALSE(read<HelloRequest>(sound(0)).depth);
    CHECK(read<HelloRequest>(sound(11)).depth);
    CHECK(refusal(11, "/depth", 1) == "\"depth\": expected true or false");
    CHECK_FALSE(read<PickRequest>(sound(5)).view);
    CHECK(read<PickRequest>(sound(12)).view.value().vertical == 40.5);
    CHECK(refusal(12, "/view/up", json::array({0, 1, 0})) != "accepted");
}

TEST_CASE("walk request: a time is a day, an hour and a kind of sky, or that of the files") {
    constexpr std::size_t kTime = 17;
    CHECK(read<TimeRequest>(sound(kTime)).time == SkyTime{9, 21, 14.3, "+s"});
    json message = sound(kTime);
    message["time"] = nullptr;
    CHECK(read<TimeRequest>(message).time == std::nullopt);
    for (const auto& [pointer, values] : std::map<const char*, std::vector<json>>{
             {"/time/month", {0, 13, 1.5, -1}},
             {"/time/day", {0, 32, 1.5}},
             {"/time/hour", {24, -0.1, 1e300}},
             {"/time/sky", {"+x", "+c", "s", "+s -c"}},
             {"/time", {json::array(), 1, "now", json::object()}}})
        for (const json& value : values) {
            CAPTURE(pointer);
            CAPTURE(value.dump());
            CHECK(refusal(kTime, pointer, value) != "accepted");
        }
    CHECK(refusal(kTime, "/time/sky", "") == "accepted");
    CHECK(refusal(kTime, "/time/hour", 23.9999) == "accepted");
}
