// Dimmers: colour temperatures against published chromaticities, and the message of the lamps.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
    as_built,
    kelvin_of,
    lamps_of,
    lights_message,
    planckian_xy,
    sound_lamp,
    temperature_rgb,
} from "../../../apps/viewer/lamps.js";

test("the black body's chromaticities are those of tables", () => {
    // CIE 15: illuminant A, and the Planckian locus at 4000 K, 6500 K and 10000 K (Wyszecki & Stiles, table 1(3.11)).
    for (const [kelvin, x, y] of [
        [2856, 0.4476, 0.4074],
        [2000, 0.5267, 0.4133],
        [4000, 0.3805, 0.3768],
        [6500, 0.3135, 0.3237],
        [10000, 0.2807, 0.2884],
    ]) {
        const [own_x, own_y] = planckian_xy(kelvin);
        assert.ok(Math.abs(own_x - x) < 2e-3, `x at ${kelvin}: ${own_x}`);
        assert.ok(Math.abs(own_y - y) < 2e-3, `y at ${kelvin}: ${own_y}`);
    }
});

test("a colour leaves the luminance as it is, and has no channel below 0", () => {
    for (let kelvin = 1800; kelvin <= 10000; kelvin += 100) {
        const rgb = temperature_rgb(kelvin);
        const light = 0.26510582 * rgb[0] + 0.67010582 * rgb[1] + 0.06478836 * rgb[2];
        assert.ok(Math.abs(light - 1) < 1e-9);
        assert.ok(rgb.every((value) => value >= 0));
    }
    const [red, , blue] = temperature_rgb(2700);
    assert.ok(red > 1.3 && blue < 0.4);
    const cold = temperature_rgb(9000);
    assert.ok(cold[0] < 1 && cold[2] > 1.2);
    // Near the white of equal energy all channels are about 1.
    assert.ok(temperature_rgb(5450).every((value) => Math.abs(value - 1) < 0.1));
});

test("the message holds what is not as the scene has it, and says it all", () => {
    const lamps = [
        as_built("sun"),
        { ...as_built("desk"), percent: 150 },
        { ...as_built("spots"), on: false, percent: 30, kelvin: 3000 },
    ];
    const message = lights_message(lamps);
    assert.deepEqual(message, {
        type: "lights",
        levels: [
            { name: "desk", level: 1.5, rgb: [1, 1, 1] },
            { name: "spots", level: 0, rgb: temperature_rgb(3000) },
        ],
    });
    const back = lamps_of(["sun", "desk", "spots"], message.levels);
    assert.deepEqual(back.slice(0, 2), lamps.slice(0, 2));
    assert.deepEqual(back[2], { name: "spots", on: false, percent: 100, kelvin: 3000 });
    for (const kelvin of [1800, 2700, 4000, 6500, 9900])
        assert.equal(kelvin_of(temperature_rgb(kelvin)), kelvin);
});

test("what is not sound in a preset is as the scene has it", () => {
    assert.deepEqual(sound_lamp("a", { on: "x", percent: NaN, kelvin: "warm" }), as_built("a"));
    assert.deepEqual(sound_lamp("a", { percent: 1e9, kelvin: 5 }), {
        name: "a",
        on: true,
        percent: 200,
        kelvin: 1800,
    });
    assert.deepEqual(sound_lamp("a", undefined), as_built("a"));
});
