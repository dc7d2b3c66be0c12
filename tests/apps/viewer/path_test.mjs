// Paths of views: played, recorded, thinned.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
    film_command,
    path_problem,
    path_view,
    Playback,
    Recorder,
    thinned,
} from "../../../apps/viewer/path.js";
import { length, normalize, subtract } from "../../../apps/viewer/vector.js";
import { parse_keys, path_text } from "../../../apps/viewer/view_text.js";

const view_at = (position, direction = [0, 1, 0]) => ({
    type: "v",
    position,
    direction,
    up: [0, 0, 1],
    horizontal: 60,
    vertical: 40,
    fore: 0,
    aft: 0,
    shift: 0,
    lift: 0,
});
const key = (time, ...view) => ({ time, view: view_at(...view) });

test("a path goes through its keys, and stands still before and after", () => {
    const keys = [key(1, [0, 0, 0]), key(2, [1, 0, 0]), key(4, [1, 5, 0])];
    for (const { time, view } of keys) assert.deepEqual(path_view(keys, time), view);
    assert.deepEqual(path_view(keys, -9), keys[0].view);
    assert.deepEqual(path_view(keys, 9), keys[2].view);
});

test("keys on a line at an even pace are an even pace; halfway the spline is that of Catmull and Rom", () => {
    const line = [0, 1, 2, 5].map((t) => key(t, [t, 2 * t, 0]));
    for (const t of [0.3, 1.5, 4.2])
        assert.ok(length(subtract(path_view(line, t).position, [t, 2 * t, 0])) < 1e-12);
    const bent = [0, 1, 2, 3].map((t) => key(t, [0, [0, 0, 1, 1][t], 0]));
    assert.ok(Math.abs(path_view(bent, 1.5).position[1] - 0.5) < 1e-12);
    const bump = [0, 1, 2, 3].map((t) => key(t, [0, [0, 1, 1, 0][t], 0]));
    assert.ok(Math.abs(path_view(bump, 1.5).position[1] - 1.125) < 1e-12);
});

test("what cannot be played is said", () => {
    assert.match(path_problem([]), /needs a view/);
    assert.match(path_problem([key(1, [0, 0, 0]), key(1, [1, 0, 0])]), /must rise/);
    const round = { time: 2, view: { ...view_at([0, 0, 0]), type: "a" } };
    assert.match(path_problem([key(1, [0, 0, 0]), round]), /one type/);
    assert.equal(path_problem([key(1, [0, 0, 0])]), null);
});

/** A walk along x with a turn in the middle, 20 samples a second. */
const walk = Array.from({ length: 120 }, (_, k) => {
    const t = k / 20;
    const yaw = Math.max(0, Math.min(1, t - 2));
    return key(t, [1.4 * Math.min(t, 2), 0, 1.6], [Math.sin(yaw), Math.cos(yaw), 0]);
});

test("few keys are near all samples", () => {
    const keys = thinned(walk);
    assert.ok(keys.length < walk.length / 4, `${keys.length} keys`);
    assert.deepEqual([keys[0], keys.at(-1)], [walk[0], walk.at(-1)]);
    for (const { time, view } of walk) {
        const there = path_view(keys, time);
        assert.ok(length(subtract(there.position, view.position)) < 0.017);
        assert.ok(length(subtract(normalize(there.direction), view.direction)) < 0.006);
    }
});

test("a recording begins with the first step and ends with the last", () => {
    const recorder = new Recorder();
    let now = 5000;
    const note = (x) => assert.ok(recorder.note(view_at([x, 0, 0]), (now += 16)));
    for (let k = 0; k < 100; ++k) note(0);
    for (let k = 1; k <= 60; ++k) note(k / 60);
    for (let k = 0; k < 100; ++k) note(1);
    const keys = recorder.keys(1.6);
    assert.equal(keys[0].time, 0);
    assert.deepEqual([keys[0].view.position[0], keys.at(-1).view.position[0]], [0, 1]);
    assert.ok(Math.abs(keys.at(-1).time - 0.96) < 0.12, `${keys.at(-1).time} s`);
    assert.ok(!recorder.note({ ...view_at([0, 0, 0]), type: "a" }, now + 60), "another type");
});

test("nothing moved, nothing recorded", () => {
    const recorder = new Recorder();
    for (let k = 0; k < 50; ++k) recorder.note(view_at([0, 0, 0]), 60 * k);
    assert.equal(recorder.keys(1.6).length, 1);
});

test("playing goes on where it was, at the speed that is set, and from the start again at the end", () => {
    const playback = new Playback();
    playback.set_keys([key(10, [0, 0, 0]), key(14, [4, 0, 0])]);
    playback.time = 12;
    playback.speed = 2;
    const { time, at, end } = playback.start(1000);
    assert.equal(end, 2000);
    assert.equal(time(1500), 13);
    assert.deepEqual(at(2000).position, [4, 0, 0]);
    assert.equal(time(9000), 14);
    playback.time = 14;
    assert.equal(playback.start(0).time(0), 10);
});

test("the text of a path has its times; a line without one comes a second after the last", () => {
    const keys = [key(0.5, [1, 2, 3]), key(2.25, [4, 5, 6], [0.6, 0.8, 0])];
    assert.deepEqual(parse_keys(path_text(keys)), keys);
    const times = parse_keys("VIEW= -vp 1 2 3\n4 VIEW= -vp 2 2 3\nVIEW= -vp 3 2 3\n");
    assert.deepEqual(
        times.map(({ time }) => time),
        [0, 4, 5],
    );
});

test("the command for a film names path, film and scene, as a shell takes them", () => {
    assert.equal(
        film_command("room-1.path.vf", "a/room.rad"),
        "lightwalk animate --path room-1.path.vf -o room-1.mp4 a/room.rad",
    );
    assert.match(film_command("x.vf", "it's here.rad"), / -o x\.mp4 'it'\\''s here\.rad'$/);
    assert.match(film_command("x.vf", "-o.rad"), / '-o\.rad'$/);
    assert.match(film_command("x.vf", ""), / SCENE$/);
});
