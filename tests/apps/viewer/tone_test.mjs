import assert from "node:assert/strict";
import test from "node:test";
import { palette_colour, share_of } from "../../../apps/viewer/scale.js";
import { automatic_tone, HighlightCurve, Luminance, recolour } from "../../../apps/viewer/tone.js";

/** Luminance of a picture that is the same everywhere, or of each pixel: values row by row [cd/m2]. */
function luminance(width, height, values) {
    const greys = Uint8Array.from(values, (L) => (L > 0 ? Math.round(Math.log2(L) * 8) + 64 : 0));
    return new Luminance({ low: -8, step: 1 / 8, width, height, greys });
}
const fixed = (ev) => ({ mode: "tone", exposure: { auto: false, ev }, human: false });
const kFalse = {
    mode: "false",
    exposure: { auto: true, ev: 0 },
    scale: { low: 1, high: 10000, log: true },
};
/** The bytes of greys of radiance, from black, at a fixed exposure: what an empty picture of known luminance becomes. */
function bytes_of(radiances, ev) {
    const data = new Uint8ClampedArray(4 * radiances.length);
    const known = luminance(
        radiances.length,
        1,
        radiances.map((L) => 179 * L),
    );
    recolour(data, radiances.length, 1, { exposure: 1, white: 16 }, known, fixed(ev));
    return data;
}

test("the curve is the identity up to the knee, 1 at white, and its inverse turns it back", () => {
    for (const white of [1, 1.5, 16, 3000]) {
        const curve = new HighlightCurve(white);
        assert.equal(curve.shown(0.3), 0.3);
        assert.ok(Math.abs(curve.shown(white * (1 - 1e-9)) - 1) < 1e-6);
        assert.equal(curve.shown(2 * white), 1);
        for (const x of [0.1, 0.36, 0.5, 0.99])
            assert.ok(Math.abs(curve.shown(curve.exposed(x)) - x) < 1e-9, `${white} ${x}`);
    }
});

test("another exposure and back is the same picture but for what bytes cannot tell", () => {
    const radiances = Array.from({ length: 64 }, (_, k) => 0.02 * 1.1 ** k);
    const first = bytes_of(radiances, 0);
    const there = first.slice();
    const known = luminance(
        64,
        1,
        radiances.map((L) => 179 * L),
    );
    recolour(there, 64, 1, { exposure: 1, white: 16 }, known, fixed(-2));
    assert.ok(there.every((x, k) => k % 4 === 3 || x <= first[k]));
    recolour(there, 64, 1, { exposure: 0.25, white: 16 }, known, fixed(0));
    for (let k = 0; k < there.length; ++k)
        assert.ok(Math.abs(there[k] - first[k]) <= 6, `${k}: ${there[k]} ${first[k]}`);
});

test("hues stay when exposure changes", () => {
    const data = Uint8ClampedArray.from([120, 60, 30, 255]);
    recolour(data, 1, 1, { exposure: 1, white: 16 }, luminance(1, 1, [20]), fixed(-1));
    const linear = (x) => ((x / 255 + 0.055) / 1.055) ** 2.4;
    const ratio = (a, b) => linear(a) / linear(b);
    assert.ok(Math.abs(ratio(data[0], 120) - 0.5) < 0.02);
    assert.ok(Math.abs(ratio(data[0], data[1]) / ratio(120, 60) - 1) < 0.06);
});

test("what is white or black in the picture has its luminance from elsewhere", () => {
    const data = Uint8ClampedArray.from([255, 255, 255, 255, 0, 0, 0, 255]);
    const known = luminance(2, 1, [8192, 1 / 16]);
    recolour(data, 2, 1, { exposure: 1, white: 1 }, known, kFalse);
    const expected = palette_colour(share_of(kFalse.scale, 8192));
    for (let c = 0; c < 3; ++c) {
        assert.ok(Math.abs(data[c] - expected[c]) <= 4);
        assert.ok(Math.abs(data[4 + c] - palette_colour(0)[c]) <= 1);
    }
});

test("false colours of bytes are those of their luminance", () => {
    const radiances = Array.from({ length: 40 }, (_, k) => 0.01 * 1.15 ** k);
    const data = bytes_of(radiances, 0);
    // The plane is wrong by a factor of 1000: it counts only where bytes tell nothing.
    const wrong = luminance(
        40,
        1,
        radiances.map(() => 0.1),
    );
    recolour(data, 40, 1, { exposure: 1, white: 16 }, wrong, kFalse);
    radiances.forEach((L, k) => {
        const expected = palette_colour(share_of(kFalse.scale, 179 * L));
        const apart = Math.hypot(...expected.map((x, c) => x - data[4 * k + c]));
        assert.ok(apart < 14, `${L}: ${apart}`);
    });
});

test("a black picture has a tone, and stays black", () => {
    const black = luminance(2, 2, [0, 0, 0, 0]);
    assert.deepEqual(automatic_tone(black), { exposure: 1, white: 1 });
    const data = new Uint8ClampedArray(16);
    recolour(data, 2, 2, { exposure: 1, white: 1 }, black, {
        mode: "tone",
        exposure: { auto: true, ev: 0 },
    });
    assert.ok(data.every((x) => x === 0));
});

test("automatic exposure makes the mean of logarithms middle grey, and white what few exceed", () => {
    const values = [...Array(999).fill(179), 179 * 256];
    const { exposure, white } = automatic_tone(luminance(1000, 1, values));
    assert.ok(Math.abs(exposure - 0.18 / 2 ** 0.008) < 0.02);
    assert.equal(white, 1);
});

test("a place of the picture has the luminance of its square", () => {
    const known = luminance(2, 2, [1, 2, 4, 8]);
    assert.equal(known.at(0, 0), 1);
    assert.equal(known.at(0.99, 0.2), 2);
    assert.equal(known.at(0.2, 1), 4);
    assert.equal(known.at(7, 7), 8);
});
