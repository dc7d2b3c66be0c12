#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/net/material_reply.h"
#include "io/net/walk_request.h"

using namespace lightwalk;
using nlohmann::json;

namespace {

json edit(const std::string& name = "wall", int definition = 0) {
    return {{"name", name},
            {"definition", definition},
            {"kind", "plastic"},
            {"reals", {0.5, 0.25, 1, 0, 0.1}}};
}

json edits(const std::vector<json>& materials) {
    return {{"type", "edits"}, {"id", 4}, {"materials", materials}};
}

bool is_refused(const json& message) {
    try {
        (void)parse_walk_request(message.dump());
    } catch (const InputError&) {
        return true;
    }
    return false;
}

}  // namespace

TEST_CASE("material messages: edits are read as they stand") {
    const auto request =
        std::get<EditsRequest>(parse_walk_request(edits({edit(), edit("wall", 1)}).dump()));
    CHECK(request.id == 4);
    REQUIRE(request.materials.size() == 2);
    CHECK(request.materials[0] == MaterialEdit{"wall", 0, "plastic", {0.5, 0.25, 1, 0, 0.1}});
    CHECK(request.materials[1].definition == 1);
    CHECK(std::get<EditsRequest>(parse_walk_request(edits({}).dump())).materials.empty());
    const json question{{"type", "material"}, {"id", 7}, {"x", 0.25}, {"y", 1}};
    const auto asked = std::get<MaterialRequest>(parse_walk_request(question.dump()));
    CHECK(asked.id == 7);
    CHECK(asked.x == 0.25);
    CHECK_FALSE(asked.view);
}

TEST_CASE("material messages: edits that cannot be are refused, whatever is wrong with them") {
    REQUIRE_FALSE(is_refused(edits({edit()})));
    const auto refused = [](const char* pointer, const json& value) {
        json wrong = edits({edit()});
        wrong[json::json_pointer(pointer)] = value;
        return is_refused(wrong);
    };
    for (const json& value : std::vector<json>{nullptr, true, json::object(), "x", -1, 1e30}) {
        CAPTURE(value.dump());
        CHECK(refused("/id", value));
        CHECK(refused("/materials", value));
        CHECK(refused("/materials/0", value));
        CHECK(refused("/materials/0/reals", value));
        CHECK(refused("/materials/0/definition", value));
        if (value != -1) CHECK(refused("/materials/0/reals/2", value));
        if (!value.is_string()) CHECK(refused("/materials/0/name", value));
        if (!value.is_string()) CHECK(refused("/materials/0/kind", value));
    }
    CHECK(refused("/materials/0/definition", 0.5));
    CHECK(refused("/materials/0/name", ""));
    CHECK(refused("/materials/0/name", std::string(257, 'x')));
    CHECK(refused("/materials/0/kind", std::string(33, 'x')));
    CHECK(refused("/materials/0/reals", json::array()));
    CHECK(refused("/materials/0/reals", std::vector<double>(17, 0.5)));
    CHECK(is_refused(edits({edit(), edit()})));
    std::vector<json> many;
    for (int i = 0; i < 65; ++i) many.push_back(edit("wall", i));
    CHECK(is_refused(edits(many)));
    many.pop_back();
    CHECK_FALSE(is_refused(edits(many)));
    for (const char* name : {"name", "definition", "kind", "reals"}) {
        json lacking = edit();
        lacking.erase(name);
        CHECK(is_refused(edits({lacking})));
    }
}

TEST_CASE("material messages: replies are written as the protocol has them") {
    MaterialLayer layer;
    layer.name = "wall\xff";
    layer.definition = 1;
    layer.kind = "light";
    layer.modifier = "void";
    layer.where = "a.rad:3";
    layer.strings = {"s"};
    layer.names = {{"radiance", "red", 0, 10, "W"}};
    layer.built = {1};
    layer.reals = {2};
    const json told = json::parse(walk_text(MaterialReply{3, true, "floor", {layer}}));
    CHECK(told == json::parse(R"({"type": "material", "id": 3, "hit": true, "surface": "floor",
        "layers": [{"name": "wall�", "definition": 1, "kind": "light", "modifier": "void",
        "where": "a.rad:3", "strings": ["s"], "built": [1.0], "reals": [2.0], "fixed": "",
        "names": [{"quantity": "radiance", "channel": "red", "low": 0.0, "high": 10.0, "unit": "W"}]}]})"));
    const EditedReply edited{5, {{"wall", 0, "plastic", {1, 2}}}, {{"door", 2, "no"}}};
    CHECK(json::parse(walk_text(edited)) == json::parse(R"({"type": "edited", "id": 5,
        "materials": [{"name": "wall", "definition": 0, "kind": "plastic", "reals": [1.0, 2.0]}],
        "refused": [{"name": "door", "definition": 2, "why": "no"}], "kept": 1.0})"));
}
