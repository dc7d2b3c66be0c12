// Depth: what is written is decoded again, and everything that is no depth is refused.
import assert from "node:assert/strict";
import { test } from "node:test";
import { background_of, grid_triangles } from "../../../apps/viewer/background.js";
import { decode_depth, kNumbers } from "../../../apps/viewer/depth.js";
import { bands_of, depth_of_bands } from "./fake_depth.mjs";

const kWidth = 70,
    kHeight = 100;
/** A wall that comes nearer to the right, and a column before it. */
const room = (x, y) => (x >= 30 && x < 37 && y > 20 ? 9000 : 1000 + 5 * x + 2 * y);
const bytes_of = (bands) => new Uint8Array(depth_of_bands(0.001, bands));
const decode = (bytes) => decode_depth({ bytes }, kWidth, kHeight);

test("patches come back as they were, the sign of their slopes included", async () => {
    const bands = bands_of(
        (x, y) => room(x, y) + (x > 50 ? 700 - 14 * (x - 50) : 0),
        kWidth,
        kHeight,
    );
    bands[0][3].guessed = true;
    bands[1][2].edges = 9;
    const { step, count, patches } = await decode(bytes_of(bands));
    assert.equal(step, Math.fround(0.001));
    const wanted = bands.flat();
    assert.equal(count, wanted.length);
    assert.ok(wanted.some(({ slope_x }) => slope_x < 0));
    const signed = (number) => (number << 16) >> 16;
    wanted.forEach(({ x, y, level, guessed, edges, value, slope_x, slope_y }, k) => {
        const [a, b, shape, v, s, t] = patches.subarray(kNumbers * k, kNumbers * (k + 1));
        assert.deepEqual([a, b, shape, v], [x, y, level + (guessed ? 8 : 0) + 16 * edges, value]);
        assert.deepEqual([signed(s), signed(t)], [slope_x, slope_y]);
    });
});

test("a piece without bytes is no depth, and one that is cut off or altered is refused or decoded, never more", async () => {
    assert.equal(await decode(new Uint8Array()), null);
    const whole = bytes_of(bands_of(room, kWidth, kHeight));
    for (let size = 1; size < whole.length; ++size)
        await assert.rejects(decode(whole.slice(0, size)), `${size} bytes`);
    for (let k = 0; k < whole.length; ++k) {
        const other = whole.slice();
        other[k] ^= 0x55;
        await decode(other).then(
            ({ count, patches }) =>
                assert.ok(count <= kWidth * kHeight && patches.length >= kNumbers * count),
            () => {},
        );
    }
});

test("more than a picture holds is refused before it takes memory", async () => {
    const bands = bands_of(room, kWidth, kHeight);
    const many = bytes_of(bands);
    new DataView(many.buffer).setUint32(4, kWidth * kHeight + 1, true);
    await assert.rejects(decode(many), /sense/);
    await assert.rejects(
        decode(bytes_of([...bands, Array(50000).fill(bands[0][0])])),
        /large|sense/,
    );
});

test("patches that overlap, leave holes or lie outside are refused", async () => {
    const bands = bands_of(room, kWidth, kHeight);
    const altered = (change) => {
        const other = bands.map((patches) => patches.map((patch) => ({ ...patch })));
        change(other[0]);
        return decode(bytes_of(other));
    };
    await assert.rejects(
        altered((patches) => patches.pop()),
        /holes/,
    );
    await assert.rejects(
        altered((patches) => patches.push(patches[0])),
        /many/,
    );
    await assert.rejects(
        altered((patches) => (patches.at(-1).level = 5)),
        /outside|level|holes/,
    );
    await assert.rejects(
        altered((patches) => (patches[0].level = 9)),
        /level|holes/,
    );
});

test("behind what is near the sheet goes on with what is far", async () => {
    const depth = await decode(bytes_of(bands_of(room, kWidth, kHeight)));
    const { columns, rows, places } = background_of(depth, kWidth, kHeight);
    assert.equal(places.length, 5 * columns * rows);
    for (let k = 2; k < places.length; k += 5) assert.ok(places[k] < 2000, `${places[k]}`);
    const corners = grid_triangles(columns, rows);
    assert.equal(corners.length, 6 * (columns - 1) * (rows - 1));
    assert.equal(Math.max(...corners), columns * rows - 1);
    // It reaches beyond the picture, so that nothing is black where the eye turns farther than the frame.
    assert.ok(places[0] < -kWidth / 2 && places.at(-5) > 1.5 * kWidth);
});
