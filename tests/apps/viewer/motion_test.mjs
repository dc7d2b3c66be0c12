// Motion: turning, walking, and the way between two views.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
    advanced,
    at_height,
    between,
    kKeys,
    looked,
    moved,
    next_rates,
    wish_of,
    zoomed,
} from "../../../apps/viewer/motion.js";
import { dot, length, normalize, subtract } from "../../../apps/viewer/vector.js";

const kView = {
    type: "v",
    position: [0, 0, 1.6],
    direction: [0, 1, 0],
    up: [0, 0, 1],
    horizontal: 60,
    vertical: 45,
};
const near = (a, b, allowed = 1e-9) => {
    const off = Array.isArray(a) ? length(subtract(a, b)) : Math.abs(a - b);
    assert.ok(off <= allowed, `${a} is not ${b}`);
};

test("turning right by 90 degrees looks where right was", () => {
    near(looked(kView, Math.PI / 2, 0).direction, [1, 0, 0]);
    near(looked(kView, 0, Math.PI / 6).direction[2], 0.5);
});

test("looking up ends before the zenith, and down before the nadir: the way back is the same", () => {
    const top = looked(kView, 0, 10);
    assert.ok(top.direction[2] < 1 && top.direction[2] > 0.999);
    near(looked(looked(top, 0, -10), 0, (89 * Math.PI) / 180).direction, [0, 1, 0], 1e-9);
});

test("turning keeps the elevation, with any up vector", () => {
    const tilted = { ...kView, up: normalize([0.2, 0, 1]), direction: [0.3, 1, -0.4] };
    const elevation = (v) => dot(normalize(v.direction), tilted.up);
    near(elevation(looked(tilted, 1.1, 0)), elevation(tilted));
});

test("walking is level however the eye looks; flying goes where it looks", () => {
    const down = looked(kView, 0, -1);
    near(moved(down, [0, 2, 0], true).position, [0, 2, 1.6]);
    near(moved(down, [0, 2, 0], false).position, [0, 2 * Math.cos(1), 1.6 - 2 * Math.sin(1)]);
    near(moved(down, [1, 0, 0.5], true).position, [1, 0, 2.1]);
});

test("opposite keys cancel, and W with arrow up is no faster", () => {
    assert.deepEqual(wish_of(["KeyW", "KeyS", "KeyD"]), [1, 0, 0, 0, 0]);
    assert.deepEqual(wish_of(["KeyW", "ArrowUp"]), [0, 1, 0, 0, 0]);
    assert.deepEqual(wish_of(["KeyZ"]), [0, 0, 0, 0, 0]);
    for (const wish of Object.values(kKeys)) assert.equal(wish.filter((x) => x !== 0).length, 1);
});

test("rates reach the wish and come to rest exactly, within a third of a second", () => {
    let rates = [0, 0, 0, 0, 0];
    for (let k = 0; k < 20; ++k) rates = next_rates(rates, [1, 0, 0, -1, 0], 1 / 60);
    near(rates[0], 1, 0.01);
    near(rates[3], -1, 0.01);
    for (let k = 0; k < 20; ++k) rates = next_rates(rates, [0, 0, 0, 0, 0], 1 / 60);
    assert.deepEqual(rates, [0, 0, 0, 0, 0]);
});

test("the first tick already moves: a key is seen at once", () => {
    assert.ok(next_rates([0, 0, 0, 0, 0], [0, 1, 0, 0, 0], 1 / 60)[1] > 0.2);
});

test("at full rate a second covers the speed, in any number of ticks", () => {
    let view = kView;
    for (let k = 0; k < 50; ++k) view = advanced(view, [0, 1, 0, 0, 0], 0.02, 1.4, true);
    near(view.position, [0, 1.4, 1.6]);
});

test("steps of the floor raise the eye along up alone", () => {
    near(at_height({ ...kView, position: [5, 6, 1.6] }, [1, 1, 2.1]).position, [5, 6, 2.1]);
});

test("a lens stays within what a walk can bear", () => {
    near(zoomed(kView, 0.5).horizontal, 30);
    assert.equal(zoomed(kView, 1e-9).horizontal, 4);
    assert.equal(zoomed(kView, 1e9).horizontal, 130);
});

test("the way between two views begins at one and ends at the other, unit all along", () => {
    const to = { ...kView, position: [4, -2, 1], direction: [-1, 0, 0.2], horizontal: 90 };
    near(between(kView, to, 0).position, kView.position);
    near(between(kView, to, 0).direction, kView.direction);
    assert.deepEqual(between(kView, to, 1), to);
    near(between(kView, to, 0.5).position, [2, -1, 1.3]);
    near(between(kView, to, 0.5).horizontal, 75);
    for (let s = 0; s < 1; s += 0.1) near(length(between(kView, to, s).direction), 1);
});

test("half the way from north to east is north-east, with the elevation half changed", () => {
    const to = { ...kView, direction: [1, 0, Math.tan(0.4)] };
    const half = between(kView, to, 0.5).direction;
    near(half, [Math.SQRT1_2 * Math.cos(0.2), Math.SQRT1_2 * Math.cos(0.2), Math.sin(0.2)]);
});

test("turning round goes round, not through nothing", () => {
    const back = { ...kView, direction: [0, -1, 0] };
    const half = between(kView, back, 0.5).direction;
    near(length(half), 1);
    near(dot(half, [0, 1, 0]), 0, 1e-6);
});

test("between two views that look up, the eye goes round, not over its head", () => {
    const from = { ...kView, direction: [0, 1, 1] },
        to = { ...kView, direction: [0.01, -1, 1] };
    for (let s = 0.05; s < 1; s += 0.1)
        near(normalize(between(from, to, s).direction)[2], Math.SQRT1_2, 1e-4);
});

test("views of unlike types have no way between them", () => {
    const fisheye = { ...kView, type: "a", horizontal: 180 };
    assert.deepEqual(between(kView, fisheye, 0.1), fisheye);
});
