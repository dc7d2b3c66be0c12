// Views: positions in the picture are those of Radiance's view types; sizes follow the window.
import assert from "node:assert/strict";
import { test } from "node:test";
import { add, length, normalize, subtract, times } from "../../../apps/viewer/vector.js";
import { axes_of, fit_view, locate, same_picture, same_place } from "../../../apps/viewer/view.js";

const kView = {
    type: "v",
    position: [1, 2, 3],
    direction: [2, 1, -0.3],
    up: [0, 0, 1],
    horizontal: 60,
    vertical: 40,
    fore: 0,
    aft: 0,
    shift: 0,
    lift: 0,
};
const near = (a, b, allowed = 1e-9) => assert.ok(Math.abs(a - b) <= allowed, `${a} is not ${b}`);

/** The point `distance` away, turned from the middle by angles to the right and then up [degrees]. */
function point_at(view, right, up, distance = 5) {
    const axes = axes_of(view),
        rad = Math.PI / 180;
    const level = add(
        times(axes.forward, Math.cos(right * rad)),
        times(axes.right, Math.sin(right * rad)),
    );
    const d = add(times(level, Math.cos(up * rad)), times(axes.upward, Math.sin(up * rad)));
    return add(view.position, times(d, distance));
}

test("the middle of every type of view is what it looks at, at its distance", () => {
    for (const type of "vlchas") {
        const at = locate(
            { ...kView, type, horizontal: 90, vertical: 90 },
            point_at(kView, 0, 0, 7),
        );
        near(at.x, 0.5);
        near(at.y, 0.5);
        near(at.distance, 7);
        assert.ok(at.visible);
    }
});

test("half the horizontal angle away is the picture's right edge, half the vertical one its top", () => {
    for (const type of "vchas") {
        const view = { ...kView, type };
        near(locate(view, point_at(view, 30, 0)).x, 1);
        near(locate(view, point_at(view, -30, 0)).x, 0);
        near(locate(view, point_at(view, 0, 20)).y, 1);
    }
});

test("a parallel view's sizes are lengths", () => {
    const view = { ...kView, type: "l", horizontal: 4, vertical: 2 },
        axes = axes_of(view);
    const at = locate(view, add(view.position, add(times(axes.forward, 9), times(axes.right, 1))));
    near(at.x, 0.75);
    near(at.y, 0.5);
});

test("an angular fisheye is linear in the angle, beyond 90 degrees too", () => {
    const view = { ...kView, type: "a", horizontal: 240, vertical: 240 };
    near(locate(view, point_at(view, 60, 0)).x, 0.75);
    near(locate(view, point_at(view, 110, 0)).x, 0.5 + 110 / 240);
});

test("shift and lift move the picture by their share of it", () => {
    const at = locate({ ...kView, shift: 0.25, lift: -0.1 }, point_at(kView, 0, 0));
    near(at.x, 0.25);
    near(at.y, 0.6);
});

test("what lies behind a perspective is not visible, though its mirror image would be", () => {
    assert.equal(locate(kView, point_at(kView, 180, 0)).visible, false);
});

test("a fitted view has square pixels and keeps its horizontal angle", () => {
    for (const [width, height] of [
        [1280, 800],
        [640, 480],
        [3840, 1200],
    ]) {
        const view = fit_view(kView, width, height);
        near(view.horizontal, 60);
        const tangent = (angle) => Math.tan((angle * Math.PI) / 360);
        near(tangent(view.vertical) / tangent(60), height / width);
    }
});

test("a window taller than wide does not tear the picture: the horizontal angle gives way", () => {
    const view = fit_view(kView, 390, 844);
    assert.ok(view.vertical <= 80 && view.horizontal < 60);
    const tangent = (angle) => Math.tan((angle * Math.PI) / 360);
    near(tangent(view.vertical) / tangent(view.horizontal), 844 / 390);
});

test("fitted sizes are legal for every type and any window", () => {
    const largest = {
        v: [180, 180],
        l: [Infinity, Infinity],
        c: [360, 180],
        h: [180.001, 180.001],
        a: [360.001, 360.001],
        s: [360, 360],
    };
    for (const type of "vlchas")
        for (const size of [
            [1, 4096],
            [4096, 1],
            [1000, 1000],
        ]) {
            const { horizontal, vertical } = fit_view({ ...kView, type, horizontal: 170 }, ...size);
            assert.ok(horizontal > 0 && horizontal < largest[type][0], `${type} ${horizontal}`);
            assert.ok(vertical > 0 && vertical < largest[type][1], `${type} ${vertical}`);
        }
});

test("the axes are at right angles and right-handed", () => {
    const { forward, right, upward } = axes_of(kView);
    assert.ok(right[0] > 0 && right[1] < 0 && right[2] === 0); // east-north-east: right is south-east
    near(length(subtract(forward, normalize(kView.direction))), 0);
    assert.ok(upward[2] > 0.9);
});

test("two views are the same place whatever their sizes; the same picture only with the same sizes", () => {
    const longer = { ...kView, direction: times(kView.direction, 3), horizontal: 20 };
    assert.ok(same_place(kView, longer));
    assert.ok(!same_picture(kView, longer));
    assert.ok(!same_place(kView, { ...kView, position: [1, 2, 3.001] }));
});
