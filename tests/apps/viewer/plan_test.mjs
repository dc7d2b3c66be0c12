// Where a plan's cells are in the scene, what they look like, and where a click on them leads.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
    cell_at,
    heading_of,
    inflate,
    is_elsewhere,
    place_to_go,
    place_words,
    plan_pixels,
    plan_place,
    read_plan,
    scale_length,
    scene_place,
    shows,
    way_words,
    wind,
} from "../../../apps/viewer/plan.js";
import { plan_message } from "./fake_plan.mjs";

const kHeight = 1.6;
const kEye = [0, 0, kHeight];
const plan = await read_plan(plan_message(1, kHeight, kHeight));
const at = (x, y) => plan_place(plan, [x, y]);
const go = (x, y, walk = true, eye = kEye) => place_to_go(plan, at(x, y), eye, kHeight, walk);
const near = (a, b) =>
    a.forEach((x, k) => assert.ok(Math.abs(x - b[k]) < 1e-9, `${a} is not ${b}`));
const view = (direction, position = kEye) => ({ position, direction, up: [0, 0, 1] });

test("cells are read as they were written, and must be as many as the plan has", async () => {
    assert.equal(plan.cells.length, 200 * 160);
    assert.deepEqual([...(await inflate("eJxjZGIGAAANAAc="))], [1, 2, 3]);
    await assert.rejects(read_plan({ ...plan_message(1, 1.6, 1.6), width: 3 }), /missing cells/);
    await assert.rejects(read_plan({ ...plan_message(1, 1.6, 1.6), cells: "AAAA" }));
});

test("places of the scene and of the plan are each other's inverse, y being up", () => {
    near(at(-5, 4), [0, 0]);
    near(at(5, -4), [200, 160]);
    for (const place of [
        [0, 0],
        [1.5, -2],
        [-4, 3],
    ])
        near(scene_place(plan, plan_place(plan, place)), place);
    assert.equal(cell_at(plan, at(-3.98, 0)), 255);
    assert.equal(cell_at(plan, at(-2, 2.98)), 254);
    for (const beside of [at(-5.1, 0), at(5.1, 0), at(0, 4.1), at(0, -4.1)])
        assert.equal(cell_at(plan, beside), 0);
});

test("a plan shows its own storey, and what is over its cells", () => {
    assert.ok(shows(plan, kEye, kHeight));
    assert.ok(shows(plan, [4.9, -3.9, 2.3], kHeight));
    assert.ok(!shows(plan, [0, 0, 2.5], kHeight));
    assert.ok(!shows(plan, [0, 0, 0.7], kHeight));
    assert.ok(!shows(plan, [5.2, 0, 1.6], kHeight));
    assert.ok(!is_elsewhere([0.5, 0, 1.6], kEye, kHeight));
    assert.ok(is_elsewhere([0.5, 0.7, 1.6], kEye, kHeight));
});

test("one goes onto floors, keeps the height, and does not go into walls", () => {
    near(go(1, -2).position, [1, -2, 1.6]);
    near(go(1, -2, true, [0, 0, 1.7]).position, [1, -2, 1.7]);
    near(go(-1.5, 0).position, [-1.5, 0, 1.6]); // over the table
    assert.match(go(-3.98, 0).problem, /wall/);
    assert.match(go(-2, 2.98).problem, /pane/);
    assert.match(go(4.8, 0).problem, /stand/);
    assert.match(go(80, 0).problem, /stand/);
});

test("who walks goes down to a floor that lies a storey lower, who flies does not", () => {
    const stairs = { ...plan, cells: plan.cells.map((value) => (value === 99 ? 199 : value)) };
    const to = (walk) => place_to_go(stairs, at(1, -2), kEye, kHeight, walk).position;
    near(to(true), [1, -2, plan.z - 1.99 * kHeight + kHeight]);
    near(to(false), [1, -2, 1.6]);
});

test("a heading is that of the view, and of one that looks down what is up in it", () => {
    near(heading_of(view([3, 4, -2])), [0.6, 0.8]);
    near(heading_of({ direction: [0, 0, -1], up: [1, 0, 0] }), [1, 0]);
    near(heading_of(view([0, 0, 1])), [0, 1]);
    assert.equal(wind([0, 1]), "north");
    assert.equal(wind([1, 0.9]), "north-east");
    assert.equal(wind([-1, -0.1]), "west");
    assert.equal(wind([-0.01, -1]), "south");
});

test("words tell where the eye is, and where a place is from there", () => {
    assert.equal(
        place_words(plan, view([1, 0, 0])),
        "The eye is 5.00 m from the left and 4.00 m from the lower side, facing east.",
    );
    assert.equal(way_words(plan, at(0, -2), kEye), "2.00 m south");
    assert.equal(way_words(plan, at(-3.98, 0), kEye), "3.98 m west: a wall");
    assert.equal(way_words(plan, at(0.001, 0), kEye), "where you are");
});

test("a scale is a round length that has room", () => {
    assert.equal(scale_length(plan, 0.3), 2);
    assert.equal(scale_length(plan, 0.5), 5);
    assert.equal(scale_length({ width: 100, cell: 1e-4 }, 0.3), 2e-3);
});

test("walls are dark, floors light, what is empty is transparent; with more contrast more so", () => {
    const cells = Uint8Array.from([0, 255, 99, 50, 253, 254]);
    for (const strong of [false, true]) {
        const pixels = plan_pixels({ width: 3, height: 2, cells }, strong);
        const light = (k) => pixels[4 * k] + pixels[4 * k + 1] + pixels[4 * k + 2];
        assert.equal(pixels[3], 0);
        for (let k = 1; k < 6; ++k) assert.equal(pixels[4 * k + 3], 255);
        assert.ok(light(1) < light(4) && light(4) < light(3) && light(3) < light(2));
        assert.ok(pixels[4 * 5 + 2] > pixels[4 * 5]); // panes are blue
        assert.ok(light(2) > (strong ? 750 : 550));
    }
});
