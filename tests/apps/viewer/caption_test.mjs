// What a saved picture says about itself.
import assert from "node:assert/strict";
import { test } from "node:test";
import { broken_lines, caption_lines, display_words } from "../../../apps/viewer/caption.js";

const kDisplay = {
    mode: "tone",
    exposure: { auto: true, ev: 0 },
    human: false,
    scale: { low: 1, high: 10000, log: true },
};
const kView = {
    type: "v",
    position: [3, -2.2, 1.6000001],
    direction: [0, 1, 0],
    up: [0, 0, 1],
    horizontal: 70,
    vertical: 47.301234,
    fore: 0,
    aft: 20,
    shift: 0,
    lift: 0,
};

test("exposure or scale, in words", () => {
    assert.equal(display_words(kDisplay, 1.5), "Exposure +1.5 EV, automatic");
    const fixed = { ...kDisplay, exposure: { auto: false, ev: -2 }, human: true };
    assert.equal(display_words(fixed, -2), "Exposure −2.0 EV, as the eye sees");
    const false_colour = { ...kDisplay, mode: "false" };
    assert.match(
        display_words(false_colour, 0),
        /^False colour 1 – 10\u202f000 cd\/m², logarithmic$/,
    );
});

test("a caption names scene, time and view", () => {
    const lines = caption_lines("a/lodge.rad", kView, kDisplay, 0, new Date(0));
    assert.deepEqual(lines, [
        "lodge.rad   Exposure +0.0 EV, automatic   1970-01-01 00:00 UTC",
        "-vtv -vp 3 -2.2 1.6 -vd 0 1 0 -vu 0 0 1 -vh 70 -vv 47.301 -va 20",
    ]);
    assert.equal(caption_lines("", null, kDisplay, 0, new Date(0)).length, 1);
});

test("lines are broken between words, and lose none", () => {
    const text = "one two three four";
    const lines = broken_lines([text, "x"], 9, (words) => words.length);
    assert.deepEqual(lines, ["one two", "three", "four", "x"]);
    assert.deepEqual(
        broken_lines(["enormous"], 3, (words) => words.length),
        ["enormous"],
    );
});
