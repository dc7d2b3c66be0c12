// Light as numbers and colours: the scale, the words, the table, what was measured.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Measurements } from "../../../apps/viewer/measurements.js";
import {
    palette_colour,
    scale_problem,
    scale_ticks,
    share_of,
} from "../../../apps/viewer/scale.js";
import { measurement_table } from "../../../apps/viewer/table.js";
import {
    glare_word,
    glare_words,
    lost_words,
    known,
    phase_words,
    pixel_shares,
    quantity,
    round_number,
    stops,
    within,
    within_hundredths,
} from "../../../apps/viewer/words.js";

const kView = {
    type: "v",
    position: [0, 0, 1.6],
    direction: [0, 1, 0],
    up: [0, 0, 1],
    horizontal: 60,
    vertical: 45,
};
const kPick = {
    position: [1, 2, 3],
    normal: [0, 0, 1],
    material: "oak",
    surface: "floor",
    illuminance: 500,
    illuminance_95: 12,
    luminance: 80,
    luminance_95: 0.5,
};

test("a scale begins at its low end and ends at its high one; the middle is the mean of its kind", () => {
    for (const log of [true, false]) {
        const scale = { low: 10, high: 1000, log };
        assert.ok(Math.abs(share_of(scale, 10)) < 1e-12);
        assert.ok(Math.abs(share_of(scale, 1000) - 1) < 1e-12);
        assert.ok(Math.abs(share_of(scale, log ? 100 : 505) - 0.5) < 1e-12);
    }
});

test("the colours are Turbo's: dark blue, green in the middle, dark red; the ends go on", () => {
    const [low, middle, high] = [0, 0.5, 1].map(palette_colour);
    assert.ok(low[2] > low[0] * 0.7 && Math.max(...low) < 60);
    assert.ok(middle[1] > 240 && middle[1] > middle[0] && middle[1] > middle[2]);
    assert.ok(high[0] > 100 && high[1] < 20 && high[2] < 20);
    assert.deepEqual(palette_colour(-3), low);
    assert.deepEqual(palette_colour(7), high);
});

test("ticks are round, rise, lie within the scale and are not too many", () => {
    for (const scale of [
        [1, 10000, true],
        [0.03, 2, true],
        [20, 60, true],
        [0, 5000, false],
        [100, 130, false],
        [1, 1e9, true],
    ]) {
        const [low, high, log] = scale,
            ticks = scale_ticks({ low, high, log }, 9);
        assert.ok(ticks.length >= 2 && ticks.length <= 11, `${scale}: ${ticks}`);
        ticks.forEach((tick, k) =>
            assert.ok(
                tick >= low && tick <= high && (k === 0 || tick > ticks[k - 1]),
                `${scale}: ${ticks}`,
            ),
        );
        for (const tick of ticks)
            assert.ok(String(Number(tick.toPrecision(3))) === String(tick), `${tick} is not round`);
    }
    assert.deepEqual(scale_ticks({ low: 1, high: 1000, log: true }, 4), [1, 10, 100, 1000]);
});

test("a scale that makes no sense is told so", () => {
    assert.equal(scale_problem({ low: 1, high: 10, log: true }), null);
    assert.equal(scale_problem({ low: 0, high: 10, log: false }), null);
    for (const bad of [
        { low: 0, high: 10, log: true },
        { low: 10, high: 10, log: false },
        { low: NaN, high: 1, log: true },
        { low: -1, high: 1, log: false },
        { low: 1, high: Infinity, log: true },
    ])
        assert.ok(scale_problem(bad));
});

test("quantities have three digits that matter", () => {
    const plain = (x) => quantity(x).replaceAll("\u202f", " ");
    assert.deepEqual([0, 0.01234, 4.567, 78.94, 123.4, 1234.5, 999999].map(plain), [
        "0",
        "0.0123",
        "4.57",
        "78.9",
        "123",
        "1 235",
        "999 999",
    ]);
    assert.equal(quantity(1.2e-5), "1.20·10^-5");
    for (const none of [null, undefined, NaN, Infinity]) assert.equal(quantity(none), "–");
    assert.equal(stops(-1.25), "−1.3");
    assert.deepEqual(
        [0.05, 30, 10000, 2.5].map((x) => round_number(x).replaceAll("\u202f", " ")),
        ["0.05", "30", "10 000", "2.5"],
    );
});

test("a lost connection is told, why, and when it is tried again", () => {
    assert.equal(lost_words("", true, 999), "The connection to the server is lost. Trying again…");
    assert.equal(lost_words("", false, 4400), "No answer from the server. Trying again in 4 s…");
    assert.equal(lost_words("It ends.", true, 1000), "It ends. Trying again in 1 s…");
});

test("how well a value is known is rounded up, and nothing is said where there is nothing to say", () => {
    const plain = (text) => text.replaceAll("\u202f", " ");
    const shares = [0.0004, 0.0099, 0.01, 0.0201, 0.03, 0.0999, 0.123, 0.99, 0.991, 7];
    assert.deepEqual(
        shares.map((share) => plain(within(430, share * 430))),
        ["<1", "<1", "1", "3", "3", "10", "13", "99", ">99", ">99"].map((x) => `± ${x} %`),
    );
    assert.equal(within(-10, 1), within(10, 1));
    for (const half of [0, 1e-9, undefined, null, NaN, Infinity])
        assert.equal(within(10, half), "");
    for (const value of [0, NaN, null, undefined]) assert.equal(within(value, 1), "");
    assert.equal(plain(known(430, 10, "lx")), "430 lx ± 3 %");
    assert.equal(known(430, 0, "lx"), "430 lx");
    assert.equal(plain(within_hundredths(0.0101)), "± 0.02");
    assert.equal(plain(within_hundredths(0.0001)), "± 0.01");
    for (const none of [0, undefined, null]) assert.equal(within_hundredths(none), "");
});

test("a probability that is not known well enough belongs to more than one class", () => {
    assert.equal(glare_words(0.37, 0.01), "perceptible");
    assert.equal(glare_words(0.37), "perceptible");
    assert.equal(glare_words(0.37, 0.03), "imperceptible to disturbing");
});

test("glare is felt by the classes of its authors", () => {
    assert.deepEqual([0.34, 0.35, 0.4, 0.45].map(glare_word), [
        "imperceptible",
        "perceptible",
        "disturbing",
        "intolerable",
    ]);
});

test("a table has a row for each measurement, all with the same cells", () => {
    const m = new Measurements(() => {});
    m.pin(kPick, "2026-01-31T12:00:00Z");
    const area = m.add_area([0.1, 0.2, 0.3, 0.4], kView);
    const mean = { id: area.id, luminance: 42.5, luminance_95: 0.25, pixels: 99 };
    m.update_area(mean, 1, "2026-01-31T12:01:00Z");
    const text = measurement_table(m.probes, m.areas, { ambient: "rest", scene: "a,b.oct" });
    const lines = text.trimEnd().split("\r\n");
    assert.equal(lines.length, 3);
    const cells = (line) =>
        line
            .match(/("([^"]|"")*"|[^,]*)(,|$)/g)
            .slice(0, -1)
            .map((c) => c.replace(/,$/, ""));
    const names = lines[0].split(",");
    const rows = lines
        .slice(1)
        .map((line) => Object.fromEntries(cells(line).map((c, k) => [names[k], c])));
    for (const line of lines.slice(1)) assert.equal(cells(line).length, names.length);
    assert.equal(rows[0].illuminance_lx, "500");
    assert.deepEqual([rows[0].illuminance_95_lx, rows[0].luminance_95_cd_m2], ["12", "0.5"]);
    assert.deepEqual([rows[1].illuminance_95_lx, rows[1].luminance_95_cd_m2], ["", "0.25"]);
    assert.deepEqual(
        [rows[0].x_m, rows[0].y_m, rows[0].z_m, rows[0].normal_z],
        ["1", "2", "3", "1"],
    );
    assert.equal(rows[0].scene, '"a,b.oct"');
    assert.equal(rows[1].luminance_cd_m2, "42.5");
    assert.equal(rows[1].ambient, "rest");
    assert.match(rows[1].view, /^VIEW= -vtv -vp 0 0 1\.6 /);
});

test("names in scenes are no formulas in spreadsheets", () => {
    const m = new Measurements(() => {});
    m.pin({ ...kPick, material: "=1+1", surface: 'a "b"' }, "");
    const text = measurement_table(m.probes, [], { ambient: "off", scene: "s" });
    assert.ok(text.includes(",'=1+1,"));
    assert.ok(text.includes(',"a ""b""",'));
});

test("pins follow the server's values; values of pins that are gone are nobody's", () => {
    const m = new Measurements(() => {});
    const first = m.pin(kPick, "").id,
        second = m.pin(kPick, "").id;
    assert.notEqual(first, second);
    m.remove(first);
    m.update_probes(
        {
            probes: [
                { id: first, illuminance: 1, luminance: 1 },
                { id: second, illuminance: 2, illuminance_95: 0.5, luminance: 3 },
            ],
            settled: 0.5,
        },
        "t",
    );
    assert.equal(m.probes.length, 1);
    assert.deepEqual(
        [m.probes[0].illuminance, m.probes[0].luminance, m.probes[0].settled],
        [2, 3, 0.5],
    );
    assert.deepEqual(
        [m.probes[0].illuminance_95, m.probes[0].luminance_95], // what is not told is not kept, either
        [0.5, undefined],
    );
});

test("numbers of measurements are not given twice, whatever was removed; names not while they are used", () => {
    const m = new Measurements(() => {});
    const ids = [m.pin(kPick, "").id, m.add_area([0, 0, 1, 1], kView).id, m.pin(kPick, "").id];
    m.remove(ids[0]);
    ids.push(m.pin(kPick, "").id);
    assert.deepEqual(
        m.probes.map((p) => p.name),
        ["P2", "P3"],
    );
    m.remove(ids[3]);
    ids.push(m.pin(kPick, "").id);
    assert.equal(new Set(ids).size, 5);
});

test("no more pins than the server keeps", () => {
    const m = new Measurements(() => {});
    for (let k = 0; k < 64; ++k) assert.ok(m.pin(kPick, ""));
    assert.equal(m.pin(kPick, ""), null);
});

test("whoever is told of changes learns whether pins came or went", () => {
    const told = [];
    const m = new Measurements((pins) => told.push(pins));
    const id = m.pin(kPick, "").id;
    const area = m.add_area([0, 0, 1, 1], kView);
    m.update_probes({ probes: [], settled: 1 }, "");
    m.remove(area.id);
    m.remove(id);
    assert.deepEqual(told, [true, false, false, false, true]);
});

test("a mean is asked for again while the light settles, in the same picture, once a second, until it has", () => {
    const m = new Measurements(() => {});
    const area = m.add_area([0, 0, 1, 1], kView);
    assert.equal(m.areas_to_ask(kView, 0, 5000).length, 1);
    assert.equal(m.areas_to_ask(kView, 0, 5500).length, 0);
    assert.equal(m.areas_to_ask(kView, 0, 6000).length, 1);
    assert.equal(m.areas_to_ask({ ...kView, position: [1, 0, 1.6] }, 0, 9000).length, 0);
    assert.equal(m.areas_to_ask(kView, 1, 6300).length, 1);
    m.update_area({ id: area.id, luminance: 1, pixels: 1 }, 1, "");
    assert.equal(m.areas_to_ask(kView, 1, 99999).length, 0);
});

test("what was kept is taken only as far as it is sound", () => {
    const m = new Measurements(() => {});
    m.restore({
        probes: [
            { id: 1, name: "P1", position: [1, 2, 3], normal: [0, 0, 1] },
            { id: 2, name: "P2", position: [1, null, 3], normal: [0, 0, 1] },
            {},
        ],
        areas: [{ rect: 1 }],
    });
    assert.equal(m.count, 1);
});

test("what is not done is never 100 %, and what is done has no number", () => {
    assert.equal(phase_words("refining", 0.999), "refining 99\u202f%");
    assert.equal(phase_words("ambient", 0), "ambient light 0\u202f%");
    assert.equal(phase_words("refining", 1), "refining");
    assert.equal(phase_words("done", 1), "done");
    assert.equal(phase_words("moving", 0.3), "");
    assert.equal(phase_words(undefined, undefined), "");
});

test("what is neither reused nor inferred nor guessed is traced", () => {
    const shares = Object.fromEntries(pixel_shares({ reuse: 0.7, inferred: 0.05, guessed: 0.1 }));
    assert.ok(Math.abs(shares.Traced - 0.15) < 1e-12 && shares.Guessed === 0.1);
    assert.equal(shares.Inferred, 0.05);
    assert.deepEqual(pixel_shares({ reuse: 1, guessed: 0.01 })[3], ["Traced", 0]);
    assert.deepEqual(pixel_shares({}), []);
});
