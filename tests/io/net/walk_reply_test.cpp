#include "io/net/walk_reply.h"

#include <doctest/doctest.h>
#include <zlib.h>

#include <limits>
#include <nlohmann/json.hpp>

using namespace lightwalk;
using nlohmann::json;

namespace {

const View kView{'v', {1, 2, 1.6}, {0, 1, 0}, {0, 0, 1}, 60, 40, 0.1, 0, 0, 0.5};
const json kViewJson = json::parse(R"({"type": "v", "position": [1.0, 2.0, 1.6],
    "direction": [0.0, 1.0, 0.0], "up": [0.0, 0.0, 1.0], "horizontal": 60.0, "vertical": 40.0,
    "fore": 0.1, "aft": 0.0, "shift": 0.0, "lift": 0.5})");

std::string from_base64(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char letter : text) {
        if (letter == '=') break;
        const std::size_t digit = digits.find(letter);
        REQUIRE(digit != std::string::npos);
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> count & 255);
    }
    return bytes;
}

}  // namespace

TEST_CASE("walk reply: a welcome tells all that a page starts from") {
    WelcomeReply reply{"0.1.0",           3,     true, "cabin.rad", {1280, 720}, 30,
                       {{"door", kView}}, kView, {},   {}};
    reply.display.settings.false_colour = true;
    reply.settings.ambient = WalkAmbient::always;
    json expected = json::parse(R"({"type": "welcome", "version": "0.1.0", "you": 3,
        "driver": true, "scene": "cabin.rad", "max_size": [1280, 720], "fps": 30.0,
        "display": {"number": 0, "mode": "false", "exposure": {"auto": true, "ev": 0.0}, "human": false,
                    "scale": {"low": 1.0, "high": 10000.0, "log": true}},
        "settings": {"ambient": "always"}})");
    expected["view"] = kViewJson;
    expected["views"] = json::array({{{"name", "door"}, {"view", kViewJson}}});
    CHECK(json::parse(walk_text(reply)) == expected);
    reply.denoises = expected["denoises"] = true;
    CHECK(json::parse(walk_text(reply)) == expected);
    reply.view.reset();
    CHECK(json::parse(walk_text(reply))["view"].is_null());
}

TEST_CASE("walk reply: views and settings come back as the same requests") {
    WelcomeReply reply;
    reply.view = kView;
    reply.display = {{true, false, -1.5, true, 0.25, 2000, false}, 9};
    for (const WalkAmbient ambient : {WalkAmbient::rest, WalkAmbient::always, WalkAmbient::off}) {
        reply.settings.ambient = ambient;
        reply.display.clean = ambient == WalkAmbient::rest;
        const json told = json::parse(walk_text(reply));
        json display = told["display"], settings = told["settings"];
        display["type"] = "display";
        settings["type"] = "settings";
        const json view{{"type", "view"}, {"id", 1},         {"view", told["view"]}, {"width", 8},
                        {"height", 8},    {"moving", false}, {"walk", false}};
        CHECK(std::get<ViewRequest>(parse_walk_request(view.dump())).view == kView);
        CHECK(std::get<DisplayRequest>(parse_walk_request(display.dump())) == reply.display);
        CHECK(std::get<SettingsRequest>(parse_walk_request(settings.dump())) == reply.settings);
    }
}

TEST_CASE("walk reply: each is the text that the format has for it") {
    const auto same = [](const std::string& text, const char* expected) {
        CHECK(json::parse(text) == json::parse(expected));
    };
    same(walk_text(LoadingReply{"octree", 0.5}),
         R"({"type": "loading", "text": "octree", "share": 0.5})");
    same(walk_text(FailedReply{{"a.rad:1: x", "b"}}),
         R"({"type": "failed", "messages": ["a.rad:1: x", "b"]})");
    same(walk_text(FailedReply{}), R"({"type": "failed", "messages": []})");
    same(walk_text(LoadedReply{{}, 1.5, {}}),
         R"({"type": "loaded", "views": [], "eye_height": 1.5})");
    same(walk_text(LoadedReply{{}, 1.5, {"sun", "desk"}}),
         R"({"type": "loaded", "views": [], "eye_height": 1.5, "lights": ["sun", "desk"]})");
    same(walk_text(LoadedReply{{}, 1.5, {}, {}, BesidePlace{"b.rad", ""}}),
         R"({"type": "loaded", "views": [], "eye_height": 1.5, "beside": {"scene": "b.rad"}})");
    same(walk_text(LoadedReply{{}, 1.5, {}, {}, BesidePlace{"", "no"}}),
         R"({"type": "loaded", "views": [], "eye_height": 1.5, "beside": {"refused": "no"}})");
    same(walk_text(LightsReply{{{{"desk", 0.5, {1, 0.5f, 0.25f}}}}}),
         R"({"type": "lights", "levels": [{"name": "desk", "level": 0.5,
             "rgb": [1.0, 0.5, 0.25]}]})");
    same(walk_text(RoleReply{true, 4, {4, 5}}),
         R"({"type": "role", "driver": true, "driver_id": 4, "clients": [4, 5]})");
    same(walk_text(RoleReply{}),
         R"({"type": "role", "driver": false, "driver_id": null, "clients": []})");
    same(walk_text(PickedReply{
             7, true, {100.5, 2}, {30, 0.5}, 2.5, {1, 2, 3}, {0, 0, 1}, "oak", "table.1"}),
         R"({"type": "picked", "id": 7, "hit": true, "luminance": 100.5, "luminance_95": 2.0,
             "illuminance": 30.0, "illuminance_95": 0.5,
             "distance": 2.5, "position": [1.0, 2.0, 3.0], "normal": [0.0, 0.0, 1.0],
             "material": "oak", "surface": "table.1"})");
    same(walk_text(MeanReply{8, {12.5, 0.25}, 640}),
         R"({"type": "mean", "id": 8, "luminance": 12.5, "luminance_95": 0.25, "pixels": 640})");
    same(walk_text(ProbesReply{{{1, {500, 10}, {80, 1.5}}}, 0.25}),
         R"({"type": "probes", "probes": [{"id": 1, "illuminance": 500.0, "illuminance_95": 10.0,
             "luminance": 80.0, "luminance_95": 1.5}],
             "settled": 0.25})");
    same(walk_text(GlareReply{9, 1, {0.5, 0.125}, {{{{0, 0.5}, {1, 1}}, 2000, 0.125, 1.5}}}),
         R"({"type": "glare", "id": 9, "done": 1.0, "dgp": 0.5, "dgp_95": 0.125, "sources": [
             {"outline": [[0.0, 0.5], [1.0, 1.0]], "luminance": 2000.0, "solid_angle": 0.125,
              "position_index": 1.5}]})");
    same(walk_text(PlanReply{6, 3, 2, -1.5, 2, 0.25, 1.5, "AAAA"}),
         R"({"type": "plan", "id": 6, "width": 3, "height": 2, "origin": [-1.5, 2.0],
             "cell": 0.25, "z": 1.5, "cells": "AAAA"})");
    same(walk_text(StateReply{30, 0.97, 0.015, 0.01, 1e6, WalkPhase::refining, 0.5, 2, 8, 300000}),
         R"({"type": "state", "fps": 30.0, "reuse": 0.97, "inferred": 0.015, "guessed": 0.01,
             "rays_per_second": 1000000.0, "phase": "refining", "share": 0.5, "ranks": 2, "threads": 8, "points": 300000})");
    same(walk_text(RefusedReply{"no", 3}), R"({"type": "refused", "text": "no", "id": 3})");
    same(walk_text(RefusedReply{"no", {}}), R"({"type": "refused", "text": "no"})");
    same(walk_text(RefusedReply{"no", {}, 9}), R"({"type": "refused", "text": "no", "view": 9})");
    same(walk_text(ByeReply{"end"}), R"({"type": "bye", "reason": "end"})");
}

TEST_CASE("walk reply: a plan's cells come back from base64 and zlib") {
    for (const std::size_t width : {0, 1, 2, 3, 4, 384}) {
        FloorPlan plan;
        plan.width = static_cast<int>(width);
        plan.height = 77;
        plan.left = -3.5;
        plan.z = 1.25;
        for (std::size_t k = 0; k < 77 * width; ++k)
            plan.cells.push_back(static_cast<std::uint8_t>(k * k / 7 % 256));
        const PlanReply reply = plan_reply(plan);
        CHECK(reply.width == plan.width);
        CHECK(reply.left == -3.5);
        CHECK(reply.z == 1.25);
        CHECK(reply.cells.size() % 4 == 0);
        const std::string packed = from_base64(reply.cells);
        std::vector<std::uint8_t> cells(plan.cells.size() + 1);
        auto size = static_cast<uLongf>(cells.size());
        REQUIRE(uncompress(cells.data(), &size, reinterpret_cast<const Bytef*>(packed.data()),
                           static_cast<uLong>(packed.size())) == Z_OK);
        cells.resize(size);
        CHECK(cells == plan.cells);
    }
}

TEST_CASE("walk reply: illuminances come back from base64, also those that are none") {
    IsoluxReply reply{3, 0.5, 2, 1, {1, 2, 0.75}, {0.5, 0, 0}, {0, 0.25, 0}, {0, 0, 1}};
    reply.values = {123.25f, std::numeric_limits<float>::quiet_NaN()};
    const json told = json::parse(walk_text(reply));
    CHECK(told["type"] == "isolux");
    CHECK(told["id"] == 3);
    CHECK(told["done"] == 0.5);
    CHECK(told["columns"] == 2);
    CHECK(told["rows"] == 1);
    CHECK(told["origin"] == json({1, 2, 0.75}));
    CHECK(told["across"] == json({0.5, 0, 0}));
    CHECK(told["along"] == json({0, 0.25, 0}));
    CHECK(told["normal"] == json({0, 0, 1}));
    const std::string bytes = from_base64(told["values"].get<std::string>());
    REQUIRE(bytes.size() == 8);
    CHECK(bytes.substr(0, 4) == std::string("\0\x80\xf6\x42", 4));  // IEEE 754, lowest byte first
    CHECK((bytes[7] & 0x7f) == 0x7f);
    CHECK_FALSE(told.contains("mean"));
    reply.figures = IsoluxFigures{{130, 2}, {123, 3}, {140, 4}};
    const json done = json::parse(walk_text(reply));
    const std::vector<std::pair<const char*, double>> wanted{{"mean", 130},  {"mean_95", 2},
                                                             {"least", 123}, {"least_95", 3},
                                                             {"most", 140},  {"most_95", 4}};
    for (const auto& [name, number] : wanted) CHECK(done[name] == number);
    CHECK(json::parse(walk_text(IsoluxReply{4, 1})) ==
          json::parse(R"({"type": "isolux", "id": 4, "done": 1.0, "columns": 0, "rows": 0})"));
}

TEST_CASE("walk reply: names that are no UTF-8 and numbers that are none are still JSON") {
    PickedReply reply;
    reply.material = "wei\xdf \"quoted\"\n";
    reply.luminance = {std::numeric_limits<double>::quiet_NaN(), 0};
    reply.illuminance = {1, std::numeric_limits<double>::infinity()};
    reply.distance = std::numeric_limits<double>::infinity();
    const json told = json::parse(walk_text(reply));
    CHECK(told["material"] == "wei\xef\xbf\xbd \"quoted\"\n");
    CHECK(told["luminance"].is_null());
    CHECK(told["illuminance_95"].is_null());
    CHECK(told["distance"].is_null());
}
