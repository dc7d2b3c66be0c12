// Days and hours: what sliders, texts and messages make of them.
import assert from "node:assert/strict";
import { test } from "node:test";
import {
    clock_text,
    date_of,
    date_text,
    day_of_year,
    progress_text,
    sun_text,
    time_message,
} from "../../../apps/viewer/time.js";

test("each day of the year is a date, and back", () => {
    for (let day = 1; day <= 365; ++day) {
        const { month, day: of_month } = date_of(day);
        assert.equal(day_of_year(month, of_month), day);
    }
    assert.deepEqual(date_of(1), { month: 1, day: 1 });
    assert.deepEqual(date_of(365), { month: 12, day: 31 });
    assert.deepEqual(date_of(400), { month: 12, day: 31 });
    assert.equal(day_of_year(2, 31), 59); // which gensky takes, too
    assert.equal(date_text({ month: 9, day: 21 }), "21 September");
});

test("hours are told as a clock does", () => {
    assert.equal(clock_text(14.3), "14:18");
    assert.equal(clock_text(0), "0:00");
    assert.equal(clock_text(23.9999), "0:00");
    assert.equal(clock_text(9.05), "9:03");
});

test("the sun's day, and a day without rise or set", () => {
    assert.equal(
        sun_text({ rise: 6.2, set: 18.5, altitude: 35.4 }),
        "Sunrise 6:12, sunset 18:30; sun 35° high",
    );
    assert.equal(
        sun_text({ rise: null, set: null, altitude: -12 }),
        "The sun does not rise; sun 12° below",
    );
    assert.match(sun_text({ rise: null, set: null, altitude: 3 }), /does not set/);
});

test("what is not exact yet is said", () => {
    const text = (phase, share, ambient = "rest", inferred = 0) =>
        progress_text("14:30", { phase, share, inferred }, ambient);
    assert.match(text("moving", 0), /coarse/);
    assert.match(text("filling", 0.5), /50 %.*indirect light follows/);
    assert.doesNotMatch(text("filling", 0.5, "off"), /indirect/);
    assert.match(text("ambient", 0.25), /indirect light: 25 %$/);
    assert.match(text("filling", 0.5, "rest", 1), /50 %.*indirect light is a draft/);
    assert.match(text("ambient", 0.25, "rest", 0.75), /indirect light: 25 %, else a draft/);
    assert.equal(text("done", 1), "Light of 14:30");
});

test("the message is what the protocol says", () => {
    assert.deepEqual(time_message(null), { type: "time", time: null });
});
