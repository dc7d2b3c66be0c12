// Thumbs on a touch screen.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Navigator } from "../../../apps/viewer/navigator.js";
import { is_pair, is_stick_side, kStickRadius, stick_wish } from "../../../apps/viewer/stick.js";

test("a stick asks for nothing near where it came down, and for full speed at its radius and beyond", () => {
    assert.deepEqual(stick_wish([50, 300], [53, 302]), [0, 0]);
    assert.deepEqual(stick_wish([50, 300], [50, 300 - kStickRadius]), [0, 1]);
    assert.deepEqual(stick_wish([50, 300], [50 + 9 * kStickRadius, 300]), [1, 0]);
    const [right, forward] = stick_wish([50, 300], [30, 320]);
    assert.ok(right < 0 && forward < 0 && Math.abs(right - forward) < 1e-12);
    assert.ok(Math.hypot(right, forward) < 0.6);
});

test("fingers that come together and near each other are a pair; thumbs are none", () => {
    const finger = (x, time) => ({ at: [x, 200], time });
    assert.ok(is_pair(finger(300, 0), finger(420, 60), 800));
    assert.ok(!is_pair(finger(300, 0), finger(420, 400), 800), "one after the other");
    assert.ok(!is_pair(finger(80, 0), finger(720, 60), 800), "at both ends");
    assert.ok(is_stick_side(399, 800) && !is_stick_side(400, 800));
});

test("half a lean is half the speed, and letting go stops", () => {
    const went = (wish) => {
        const navigator = new Navigator();
        navigator.place({
            type: "v",
            position: [0, 0, 1.6],
            direction: [0, 1, 0],
            up: [0, 0, 1],
            horizontal: 60,
            vertical: 45,
        });
        let now = 0;
        navigator.lean(wish, now);
        for (let k = 0; k < 60; ++k) navigator.tick((now += 16));
        const [x, y] = navigator.view.position;
        navigator.lean([0, 0], now);
        for (let k = 0; k < 120; ++k) navigator.tick((now += 16));
        assert.equal(navigator.moving, false);
        return [x, y];
    };
    const full = went([0, 1]),
        half = went([0, 0.5]);
    assert.ok(Math.abs(half[1] / full[1] - 0.5) < 1e-6 && full[0] === 0);
    assert.ok(went([-1, 0])[0] < -0.5);
});
