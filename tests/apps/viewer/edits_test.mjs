import assert from "node:assert/strict";
import { test } from "node:test";
import {
    colour_of,
    Edits,
    number_of,
    problem_of,
    rgb_of,
    rows_of,
    sound_edits,
} from "../../../apps/viewer/edits.js";

const layer = (name, built = [0.5, 0.5, 0.5, 0, 0]) => ({
    name,
    definition: 0,
    kind: "plastic",
    built,
});

test("a change is told with all numbers, and is none once they are as built", () => {
    const edits = new Edits();
    assert.ok(edits.change(layer("wall"), 1, 0.25, 0));
    assert.deepEqual(edits.list, [
        { name: "wall", definition: 0, kind: "plastic", reals: [0.5, 0.25, 0.5, 0, 0] },
    ]);
    assert.ok(edits.change({ ...layer("wall"), definition: 1 }, 0, 0, 0));
    assert.equal(edits.list.length, 2);
    assert.ok(edits.change(layer("wall"), 1, 0.5, 5000));
    assert.deepEqual(
        edits.list.map((one) => one.definition),
        [1],
    );
    assert.deepEqual(edits.reals_of(layer("wall")), layer("wall").built);
});

test("undo takes back a gesture, not each of its steps", () => {
    const edits = new Edits();
    for (let k = 1; k <= 20; ++k) edits.change(layer("wall"), 0, k / 100, 50 * k);
    edits.change(layer("wall"), 1, 0.1, 1100);
    edits.change(layer("wall"), 1, 0.2, 9000);
    const red_and_green = () => edits.reals_of(layer("wall")).slice(0, 2);
    for (const wanted of [
        [0.2, 0.2],
        [0.2, 0.1],
        [0.2, 0.5],
        [0.5, 0.5],
    ]) {
        assert.deepEqual(red_and_green(), wanted);
        edits.undo();
    }
    assert.equal(edits.can_undo, false);
    edits.change(layer("wall"), 0, 0, 0);
    edits.change(layer("door"), 0, 0, 0);
    edits.reset();
    assert.equal(edits.list.length, 0);
    edits.undo();
    assert.equal(edits.list.length, 2);
    edits.reset(layer("wall"));
    assert.deepEqual(
        edits.list.map((one) => one.name),
        ["door"],
    );
});

test("no more materials than the server takes", () => {
    const edits = new Edits();
    for (let k = 0; k < 64; ++k) assert.ok(edits.change(layer(`m${k}`), 0, 0, k));
    assert.equal(edits.change(layer("one more"), 0, 0, 0), false);
    assert.ok(edits.change(layer("m3"), 0, 0.1, 99));
    assert.equal(edits.list.length, 64);
});

test("what is not sound in a message is left out", () => {
    const good = { name: "a", definition: 0, kind: "metal", reals: [1] };
    const wrong = [null, 1, {}, { ...good, reals: ["1"] }, { ...good, definition: 0.5 }];
    assert.deepEqual(sound_edits([...wrong, { ...good, more: 1 }]), [good]);
    assert.deepEqual(sound_edits("none"), []);
});

test("numbers as they are typed, and why they cannot be", () => {
    assert.equal(number_of(" 0,5 "), 0.5);
    assert.ok(Number.isNaN(number_of("")));
    const argument = { quantity: "roughness", channel: "", low: 0, high: 1, unit: "" };
    assert.equal(problem_of(argument, 1), "");
    assert.equal(problem_of(argument, 1.01), "The roughness must be from 0 to 1.");
    assert.equal(problem_of(argument, NaN), "The roughness must be a number.");
    const far = { ...argument, quantity: "reach", high: 1e6, unit: "m" };
    assert.equal(problem_of(far, 2e6), "The reach must be from 0 to 1000000 m.");
});

test("channels are shown in one row, with a colour where they are shares", () => {
    const three = (quantity, high) =>
        ["red", "green", "blue"].map((channel) => ({ quantity, channel, high }));
    const names = [...three("a", 1), { quantity: "b", channel: "", high: 1 }, ...three("c", 9)];
    assert.deepEqual(rows_of(names), [
        { quantity: "a", indices: [0, 1, 2], colour: true },
        { quantity: "b", indices: [3], colour: false },
        { quantity: "c", indices: [4, 5, 6], colour: false },
    ]);
});

test("colours of the screen and back", () => {
    assert.equal(colour_of([0, 1, 2]), "#00ffff");
    for (const colour of ["#000000", "#ffffff", "#123456", "#80c0fe"])
        assert.equal(colour_of(rgb_of(colour)), colour);
    assert.ok(Math.abs(rgb_of("#bcbcbc")[0] - 0.5028) < 1e-3); // 188/255 is half the light
});
