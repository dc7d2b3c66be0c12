// Two sides of a comparison: whose messages the panels hear, and the scale of differences.
import assert from "node:assert/strict";
import test from "node:test";
import {
    difference_colour,
    difference_place,
    share_text,
} from "../../../apps/viewer/difference.js";
import { Sides } from "../../../apps/viewer/sides.js";

function heard() {
    const messages = [];
    const hear = (message) => messages.push(message);
    const sides = new Sides({ time: hear, edited: hear, loaded: hear, state: hear, lights: hear });
    return { messages, sides };
}

const time = (hour) => ({ type: "time", time: { hour } });

test("panels hear the side that they show, and of the other one the newest once they show it", () => {
    const { messages, sides } = heard();
    sides.take("A", time(9));
    sides.take("B", time(10));
    sides.take("B", { type: "edited", materials: [1, 2] });
    sides.take("B", time(11));
    assert.deepEqual(messages, [time(9)]);
    sides.show("B");
    assert.deepEqual(
        messages.slice(1).map(({ type }) => type),
        ["edited", "time"],
    );
    assert.equal(messages.at(-1).time.hour, 11);
    sides.take("A", time(8));
    sides.show("B"); // nothing waits any more
    assert.equal(messages.length, 3);
    sides.show("A");
    assert.equal(messages.at(-1).time.hour, 8);
});

test("what is known of a side follows its messages", () => {
    const { sides } = heard();
    sides.take("B", { type: "loaded", time: { time: { hour: 14.3 } } });
    assert.equal(sides.about.B.hour, 14.3);
    sides.take("B", time(10));
    assert.equal(sides.about.B.hour, 10);
    sides.take("B", { type: "time", time: null });
    assert.equal(sides.about.B.hour, 14.3);
    sides.take("B", { type: "edited", materials: [1] });
    sides.note("B", { type: "lights", levels: [1, 2] });
    sides.take("B", { type: "state", phase: "ambient" });
    const { materials, lamps, settled } = sides.about.B;
    assert.deepEqual([materials, lamps, settled], [1, 2, false]);
    assert.deepEqual(sides.about.A, {});
    sides.forget("B");
    assert.deepEqual(sides.about.B, {});
});

test("the scale of differences is the server's", () => {
    assert.equal(difference_place(3, 3), 0);
    assert.equal(difference_place(0, 0), 0);
    assert.equal(difference_place(0, 1), 1);
    assert.equal(difference_place(1, 0), -1);
    assert.ok(Math.abs(difference_place(1, 16) - 1) < 1e-12);
    assert.ok(Math.abs(difference_place(1, 2) - Math.log1p(10) / Math.log1p(40)) < 1e-12);
    assert.ok(Math.abs(difference_place(2, 1) + difference_place(1, 2)) < 1e-12);
    assert.deepEqual(difference_colour(0), [62, 62, 64]);
    assert.deepEqual(difference_colour(-1), [103, 169, 255]);
    assert.deepEqual(difference_colour(7), [255, 201, 74]);
});

test("shares are told with their sign, to what can be seen of them", () => {
    const texts = [0, 0.0001, 0.05, 0.051, 0.25, 3, -0.2, -0.75, Infinity, NaN].map(share_text);
    assert.deepEqual(texts, [
        "0 %",
        "0 %",
        "+5 %",
        "+5.1 %",
        "+25 %",
        "+300 %",
        "−20 %",
        "−75 %",
        "+∞",
        "–",
    ]);
});
