// Where a double click leads.
import assert from "node:assert/strict";
import { test } from "node:test";
import { levelled, view_at_pick } from "../../../apps/viewer/go_there.js";
import { dot, length, normalize, subtract } from "../../../apps/viewer/vector.js";

const kView = {
    type: "v",
    position: [0, 0, 1.5],
    direction: [0, 0.8, -0.6],
    up: [0, 0, 1],
    horizontal: 60,
    vertical: 40,
};
const near = (a, b) => assert.ok(length(subtract(a, b)) < 1e-9, `${a} is not ${b}`);
const pick = (position, normal) => ({ hit: true, position, normal });

test("on a floor the eye stands at the point, with its height and direction", () => {
    for (const normal of [
        [0, 0, 1],
        [0, 0, -1],
    ]) {
        const there = view_at_pick(kView, pick([2, 3, 0], normal), 1.6);
        near(there.position, [2, 3, 1.5]);
        near(there.direction, kView.direction);
    }
});

test("a floor below or above is a storey: the eye stands there as people do", () => {
    near(view_at_pick(kView, pick([2, 3, -3], [0, 0, 1]), 1.6).position, [2, 3, -1.4]);
    near(view_at_pick(kView, pick([2, 3, 1.2], [0, 0, 1]), 1.6).position, [2, 3, 2.8]);
});

test("over a table the eye keeps its height", () => {
    near(view_at_pick(kView, pick([2, 3, 0.75], [0, 0, 1]), 1.6).position, [2, 3, 1.5]);
});

test("a wall is looked at from near, from the side where the eye was, whichever way its normal points", () => {
    for (const normal of [
        [0, -1, 0],
        [0, 1, 0],
    ]) {
        const there = view_at_pick(kView, pick([1, 8, 1.5], normal), 1.6);
        near(there.position, [1, 8 - 1.1 * 1.6, 1.5]);
        near(there.direction, [0, 1, 0]);
    }
});

test("who stands at a wall does not go back from it", () => {
    const there = view_at_pick(kView, pick([1, 0.9, 1.2], [0, -1, 0]), 1.6);
    near(there.position, [1, 0, 1.5]);
    assert.ok(dot(there.direction, normalize(subtract([1, 0.9, 1.2], there.position))) > 1 - 1e-9);
});

test("of a ceiling one sees what one saw, from nearer", () => {
    const there = view_at_pick(kView, pick([0, 9, 3], [0, 0, -1]), 1.6);
    near(there.position, [0, 9 - 1.76, 1.5]);
});

test("the sky is no place to go to", () => {
    assert.equal(view_at_pick(kView, { hit: false, position: null, normal: null }, 1.6), null);
});

test("looking level keeps the heading", () => {
    near(levelled(kView).direction, [0, 1, 0]);
    const down = { ...kView, direction: [0, 0, -1] };
    assert.equal(levelled(down), down);
});
