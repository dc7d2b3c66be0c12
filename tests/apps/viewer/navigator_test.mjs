// The navigator: what the server is told, and when.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Navigator } from "../../../apps/viewer/navigator.js";

const kView = {
    type: "v",
    position: [0, 0, 1.6],
    direction: [0, 1, 0],
    up: [0, 0, 1],
    horizontal: 60,
    vertical: 45,
};
const kThere = { ...kView, position: [3, 4, 1.2], direction: [1, 0, 0] };

/** A navigator that stands at kView, has said so, and its clock. */
function standing() {
    const navigator = new Navigator();
    navigator.place(kView);
    let now = 1000;
    const tick = (ms = 16) => navigator.tick((now += ms));
    tick();
    return { navigator, tick, now: () => now };
}

/** All that is said until nothing is. */
function until_rest(tick) {
    const said = [];
    for (let step = tick(); step; step = tick()) {
        said.push(step);
        assert.ok(said.length < 1000, "never rests");
    }
    return said;
}

test("before it knows a view it says nothing; standing still neither", () => {
    assert.equal(new Navigator().tick(0), null);
    const { tick } = standing();
    assert.equal(tick(), null);
});

test("a key moves from its first tick to its release, and the last word is that nothing moves", () => {
    const { navigator, tick, now } = standing();
    navigator.press("KeyW", now());
    for (let k = 0; k < 30; ++k) {
        const step = tick();
        assert.ok(step.moving);
        assert.ok(step.view.position[1] > 0);
    }
    navigator.release("KeyW", now());
    const last = until_rest(tick).at(-1);
    assert.equal(last.moving, false);
    assert.equal(last.view.position[2], 1.6);
});

test("the input that a view answers is the oldest since the one before", () => {
    const { navigator, tick, now } = standing();
    const first = now() + 3;
    navigator.look(0.1, 0, first);
    navigator.look(0.1, 0, first + 5);
    assert.equal(tick().input, first);
    navigator.look(0.1, 0, first + 20);
    assert.equal(tick().input, first + 20);
});

test("a drag that is held still rests, and goes on when the pointer moves again", () => {
    const { navigator, tick, now } = standing();
    navigator.dragging = true;
    navigator.look(0.1, 0, now());
    assert.ok(tick().moving);
    const last = until_rest(() => tick(80)); // nothing is said until it rests
    assert.deepEqual(last, []);
    assert.equal(tick(80).moving, false);
    assert.ok(!navigator.moving && navigator.dragging);
    assert.equal(tick(500), null);
    navigator.look(0.1, 0, now() + 16);
    assert.ok(navigator.moving);
    assert.ok(tick().moving);
    navigator.shift(0, 1, now());
    assert.ok(tick(100).moving);
});

test("what waits to be said is known", () => {
    const { navigator, tick } = standing();
    assert.ok(!navigator.has_news);
    navigator.touch();
    assert.ok(navigator.has_news);
    tick();
    assert.ok(!navigator.has_news);
    assert.ok(!new Navigator().has_news);
});

test("a drag that is held is motion though nothing changes; its end is said once", () => {
    const { navigator, tick, now } = standing();
    navigator.dragging = true;
    navigator.look(0.1, 0, now());
    assert.equal(tick().moving, true);
    assert.equal(tick(), null);
    navigator.dragging = false;
    assert.equal(tick().moving, false);
    assert.equal(tick(), null);
});

test("a jump travels, arrives exactly, and undo comes back exactly", () => {
    const { navigator, tick, now } = standing();
    navigator.jump(kThere, now());
    const way = until_rest(tick);
    assert.ok(way.length > 10);
    assert.ok(way.slice(0, -1).every((step) => !step.walk || !step.moving));
    assert.deepEqual(way.at(-1).view, kThere);
    assert.equal(way.at(-1).moving, false);
    assert.ok(navigator.undo(now()));
    assert.deepEqual(until_rest(tick).at(-1).view, kView);
    assert.equal(navigator.undo(now()), false);
});

test("two clicks on one view are one jump", () => {
    const { navigator, tick, now } = standing();
    navigator.jump(kThere, now());
    tick();
    navigator.jump(kThere, now());
    until_rest(tick);
    navigator.jump(kThere, now());
    assert.ok(navigator.undo(now()));
    assert.deepEqual(until_rest(tick).at(-1).view, kView);
    assert.equal(navigator.can_undo, false);
});

test("a jump without duration is there at once", () => {
    const { navigator, tick, now } = standing();
    navigator.jump(kThere, now(), 0);
    assert.deepEqual(tick().view, kThere);
    assert.equal(tick(), null);
});

test("any motion stops a transition where it is", () => {
    const { navigator, tick, now } = standing();
    navigator.jump(kThere, now());
    tick(200);
    navigator.look(0, 0, now());
    assert.equal(navigator.travelling, false);
    until_rest(tick);
    assert.ok(navigator.view.position[0] > 0 && navigator.view.position[0] < 3);
});

test("the server's height counts only while walking, not on the way of a jump", () => {
    const { navigator, now } = standing();
    navigator.take_height([9, 9, 2]);
    assert.deepEqual(navigator.view.position, [0, 0, 2]);
    navigator.set_walk(false);
    navigator.take_height([9, 9, 3]);
    assert.equal(navigator.view.position[2], 2);
    navigator.set_walk(true);
    navigator.jump(kThere, now());
    navigator.take_height([9, 9, 3]);
    assert.equal(navigator.view.position[2], 2);
});

test("what puts the eye elsewhere begins an epoch: older pictures tell no height any more", () => {
    const { navigator, now } = standing();
    const epochs = [navigator.epoch];
    for (const act of [
        () => navigator.jump(kThere, now()),
        () => navigator.undo(now()),
        () => navigator.set_walk(false),
        () => navigator.place(kView),
    ]) {
        act();
        assert.ok(navigator.epoch > epochs.at(-1));
        epochs.push(navigator.epoch);
    }
    navigator.look(1, 0, now());
    assert.equal(navigator.epoch, epochs.at(-1));
});

test("rising leaves the floor: walking becomes flying", () => {
    const { navigator, tick, now } = standing();
    navigator.press("KeyE", now());
    tick();
    assert.equal(navigator.walk, false);
    assert.ok(navigator.view.position[2] > 1.6);
});

test("who goes down to the floor walks, though the eye has not come to rest from rising", () => {
    const { navigator, tick, now } = standing();
    navigator.press("KeyE", now());
    for (let k = 0; k < 30; ++k) tick();
    navigator.release("KeyE", now());
    assert.ok(tick().moving);
    navigator.set_walk(true);
    until_rest(tick);
    assert.equal(navigator.walk, true);
});

test("Shift is faster and Alt slower by their factors", () => {
    const distance = (modifier) => {
        const { navigator, tick, now } = standing();
        navigator.modifier = modifier;
        navigator.press("KeyW", now());
        tick();
        return navigator.view.position[1];
    };
    assert.ok(Math.abs(distance("faster") / distance("none") - 3) < 1e-9);
    assert.ok(Math.abs(distance("slower") / distance("none") - 0.25) < 1e-9);
});

test("a page that hung for a minute does not leap", () => {
    const { navigator, tick, now } = standing();
    navigator.press("KeyW", now());
    tick(60000);
    assert.ok(navigator.view.position[1] <= 0.1 * navigator.speed + 1e-9);
});

test("a window that loses the focus lets go of all keys", () => {
    const { navigator, tick, now } = standing();
    navigator.press("KeyW", now());
    navigator.press("ArrowLeft", now());
    navigator.release_all();
    until_rest(tick);
    assert.equal(navigator.moving, false);
});
