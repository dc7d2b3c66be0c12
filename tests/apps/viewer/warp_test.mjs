// Drawing the camera from frames: where a frame's pixels are on the screen, how wide frames are, and where the eye will be.
import assert from "node:assert/strict";
import { test } from "node:test";
import { advanced, next_rates } from "../../../apps/viewer/motion.js";
import { Navigator } from "../../../apps/viewer/navigator.js";
import {
    distances_ahead,
    DragSpeed,
    FrameTimes,
    view_ahead,
} from "../../../apps/viewer/prediction.js";
import { add, dot, length, subtract, times } from "../../../apps/viewer/vector.js";
import { axes_of, fit_view, locate } from "../../../apps/viewer/view.js";
import {
    can_warp,
    is_picture_of,
    margin_for,
    turn_between,
    warp_of,
    widened,
} from "../../../apps/viewer/warp.js";

const kWidth = 640,
    kHeight = 360;
const view_at = (position, direction, more = {}) => ({
    ...fit_view({ type: "v", position, direction, up: [0, 0, 1], horizontal: 70 }, kWidth, kHeight),
    ...more,
});
const near = (a, b, most) => assert.ok(Math.abs(a - b) <= most, `${a} instead of ${b}`);

/** Where a point of view `from` appears in view `to`, by its pixel and its inverse depth alone (x, y from the upper left, 0..1). */
function warped(from, to, point) {
    const at = locate(from, point);
    const depth = dot(subtract(point, from.position), axes_of(from).forward);
    const { turn, shift } = warp_of(from, kWidth, kHeight, to);
    const pixel = [at.x * kWidth, (1 - at.y) * kHeight, 1];
    const [x, y, w] = [0, 1, 2].map(
        (k) => dot(pixel, [turn[k], turn[k + 3], turn[k + 6]]) + shift[k] / depth,
    );
    return [0.5 + (0.5 * x) / w, 0.5 - (0.5 * y) / w];
}

test("points of a frame appear in another view where that view has them, shifted pictures included", () => {
    const from = view_at([1, 2, 1.6], [1, 0.3, -0.1], { shift: 0.2, lift: -0.1 });
    for (const to of [
        from,
        view_at([1.2, 1.9, 1.7], [1, 0.1, 0.1]),
        view_at([0.6, 2.2, 1.6], [1, 0.5, -0.2], { horizontal: 50, vertical: 40, lift: 0.3 }),
    ])
        for (const point of [
            [4, 3, 1],
            [9, 2, 3],
            [300, 80, -10],
        ]) {
            const [x, y] = warped(from, to, point);
            const wanted = locate(to, point);
            near(x, wanted.x, 1e-9);
            near(1 - y, wanted.y, 1e-9);
        }
});

test("the pixels of a plane go where their plane goes: inverse depth is affine, and so is what is interpolated", () => {
    const from = view_at([0, 0, 1.6], [0, 1, 0]),
        to = view_at([0.3, 0.2, 1.7], [0.2, 1, -0.1]);
    const { turn, shift } = warp_of(from, kWidth, kHeight, to);
    // The floor: its inverse depth at a pixel row, from the ray's slope.
    const inverse = (y) =>
        (2 * Math.tan((from.vertical * Math.PI) / 360) * (y / kHeight - 0.5)) / 1.6;
    const clip = (x, y) =>
        [0, 1, 2].map(
            (k) => dot([x, y, 1], [turn[k], turn[k + 3], turn[k + 6]]) + inverse(y) * shift[k],
        );
    const [a, b, middle] = [clip(100, 200), clip(300, 340), clip(200, 270)];
    for (const k of [0, 1, 2]) near(middle[k], (a[k] + b[k]) / 2, 1e-9);
});

test("only perspective views from the eye on are drawn", () => {
    const view = view_at([0, 0, 1], [0, 1, 0]);
    assert.ok(can_warp(view) && can_warp({ ...view, fore: 0 }));
    for (const other of [null, { ...view, type: "a" }, { ...view, fore: 1 }, { ...view, aft: 5 }])
        assert.ok(!can_warp(other));
});

test("a frame is the picture of its own view alone", () => {
    const view = view_at([0, 0, 1], [0, 1, 0]);
    assert.ok(is_picture_of(view, { ...view }));
    assert.ok(!is_picture_of(widened(view, 1.01), view));
    assert.ok(!is_picture_of(view, view_at([0, 0.01, 1], [0, 1, 0])));
    assert.ok(!is_picture_of({ ...view, shift: 0.1 }, view));
});

test("a wider view's picture has the window's in its middle; how wide it is has limits", () => {
    const view = view_at([0, 0, 1], [0, 1, 0]);
    const wide = widened(view, 1.25);
    const { forward, right } = axes_of(view);
    const edge = add(
        view.position,
        add(forward, times(right, Math.tan((view.horizontal * Math.PI) / 360))),
    );
    near(locate(wide, edge).x, 0.5 + 0.5 / 1.25, 1e-12);
    assert.ok(margin_for(view, 0) > 1 && margin_for(view, 0) < 1.1);
    assert.ok(margin_for(view, 0.08) > margin_for(view, 0.04));
    assert.equal(margin_for(view, 3), margin_for(view, 30));
    near(turn_between(view, view_at([5, 5, 5], [1, 0, 0])), Math.PI / 2, 1e-12);
});

test("the way that is foretold is the way that keys then lead", () => {
    let view = view_at([1, 2, 1.6], [1, 0.2, 0]);
    let rates = [0, 0.3, 0, -0.5, 0];
    const wish = [0, 1, 0, 1, 0];
    const foretold = view_ahead(view, rates, wish, 0.2, 1.4, true);
    const summed = [0, 0, 0, 0, 0];
    const ahead = distances_ahead(rates, wish, 0.2);
    for (let k = 0; k < 2000; ++k) {
        rates = next_rates(rates, wish, 1e-4);
        view = advanced(view, rates, 1e-4, 1.4, true);
        rates.forEach((rate, j) => (summed[j] += 1e-4 * rate));
    }
    ahead.forEach((way, j) => near(way, summed[j], 1e-3));
    assert.ok(length(subtract(foretold.position, view.position)) < 5e-3);
    assert.ok(turn_between(foretold, view) < 1e-3);
});

test("the navigator foretells keys, transitions and drags, and rests at rest", () => {
    const start = view_at([0, 0, 1.6], [0, 1, 0]);
    const eye = new Navigator();
    eye.place(start);
    eye.tick(0);
    assert.deepEqual(eye.ahead(0, 0.1), start);
    eye.press("KeyW", 0);
    assert.ok(eye.ahead(0, 0.1).position[1] > 0.02);
    eye.release_all();
    const goal = view_at([3, 0, 1.6], [1, 0, 0]);
    eye.jump(goal, 0, 1000);
    eye.tick(500);
    const half = eye.ahead(500, 0.2);
    eye.tick(700);
    assert.deepEqual(half, eye.view);
    assert.deepEqual(eye.ahead(700, 9), goal);
    eye.tick(1000);
    for (let k = 0; k < 8; ++k) eye.look(0.01, 0, 2000 + 16 * k);
    const turned = turn_between(eye.ahead(2112, 0.1), eye.view);
    near(turned, 0.0625, 0.02);
    assert.equal(turn_between(eye.ahead(2400, 0.1), eye.view), 0);
});

test("a drag is foretold for a moment only", () => {
    const drag = new DragSpeed();
    assert.deepEqual(drag.ahead(0, 1), [0, 0]);
    for (let k = 0; k < 20; ++k) drag.step(0.02, -0.01, 10 * k);
    const [yaw, pitch] = drag.ahead(190, 0.1);
    near(yaw, 0.2, 0.01);
    near(pitch, -0.1, 0.01);
    assert.deepEqual(drag.ahead(190, 5), drag.ahead(190, 1));
    assert.deepEqual(drag.ahead(500, 0.1), [0, 0]);
});

test("frames' times are medians of the newest, and a pause is none", () => {
    const frames = new FrameTimes();
    assert.equal(frames.ahead, 0);
    for (let k = 0; k < 20; ++k) frames.shown(100 * k, 100 * k + (k === 15 ? 900 : 60));
    near(frames.apart, 0.1, 1e-9);
    near(frames.ahead, 0.11, 1e-9);
    frames.shown(60000, 60060);
    near(frames.apart, 0.1, 1e-9);
    for (let k = 0; k < 20; ++k) frames.shown(0, 70000 + 500 * k);
    near(frames.ahead, 0.4, 1e-9);
});
