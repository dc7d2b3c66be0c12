// Isolux: contours of grids, the figures of EN 12464-1, files of points, and what is seen of a contour.
import assert from "node:assert/strict";
import { test } from "node:test";
import { contour_lines } from "../../../apps/viewer/contours.js";
import { decode_depth } from "../../../apps/viewer/depth.js";
import {
    contours_of,
    grid_table,
    levels_of,
    place_on,
    read_grid,
    sensor_points,
    spacing_of,
    statistics,
    told_figures,
    trace_command,
} from "../../../apps/viewer/isolux.js";
import { Sight } from "../../../apps/viewer/sight.js";
import { label_place, path_of, strokes_of } from "../../../apps/viewer/strokes.js";
import { axes_of } from "../../../apps/viewer/view.js";
import { bands_of, depth_of_bands } from "./fake_depth.mjs";
import { isolux_messages, lamp_illuminance } from "./fake_isolux.mjs";

const field = (columns, rows, value) =>
    Float64Array.from({ length: columns * rows }, (_, k) =>
        value(k % columns, Math.floor(k / columns)),
    );
const lines_of = (columns, rows, value, level) =>
    contour_lines(field(columns, rows, value), columns, rows, level);
const closed = (line) => line[0][0] === line.at(-1)[0] && line[0][1] === line.at(-1)[1];
const near = (a, b, apart = 1e-9) =>
    a.forEach((x, k) => assert.ok(Math.abs(x - b[k]) <= apart, `${a} is not ${b}`));

test("the contours of a slope are one straight line, from border to border", () => {
    const lines = lines_of(7, 5, (x, y) => 3 * x + 2 * y, 10.5);
    assert.equal(lines.length, 1);
    for (const [x, y] of lines[0]) assert.ok(Math.abs(3 * x + 2 * y - 10.5) < 1e-9);
    // What is above lies to the left of the way, where y rises to the left of x.
    const [[x0, y0], [x1, y1]] = [lines[0][0], lines[0].at(-1)];
    assert.ok((x1 - x0) * 2 - (y1 - y0) * 3 > 0);
    assert.equal(Math.min(y0, y1), 0);
    assert.ok(y0 === 4 || y1 === 4);
    assert.deepEqual(
        lines_of(7, 5, (x) => x, 6.5),
        [],
    );
    assert.deepEqual(
        lines_of(7, 5, () => 3, 3),
        [],
    );
});

test("a hill's contours are closed, and as long as its circles", () => {
    const lines = lines_of(41, 41, (x, y) => Math.hypot(x - 20.3, y - 19.6), 12);
    assert.equal(lines.length, 1);
    assert.ok(closed(lines[0]));
    let length = 0;
    for (let k = 1; k < lines[0].length; ++k)
        length += Math.hypot(...lines[0][k].map((x, i) => x - lines[0][k - 1][i]));
    assert.ok(Math.abs(length / (24 * Math.PI) - 1) < 0.005, `${length}`);
    for (const [x, y] of lines[0]) assert.ok(Math.abs(Math.hypot(x - 20.3, y - 19.6) - 12) < 0.02);
});

test("a saddle is divided by its middle, and two hills stay two", () => {
    // The mean of these corners is .5: below it the ones are joined, above it they are apart.
    const saddle = (level) => contour_lines([1, 0, 0, 1], 2, 2, level);
    const one_side = (line, side) => new Set(line.map((at) => Math.sign(side(at)))).size === 1;
    for (const [level, side] of [
        [0.4, ([x, y]) => x - y],
        [0.6, ([x, y]) => x + y - 1],
    ]) {
        const lines = saddle(level);
        assert.equal(lines.length, 2);
        assert.ok(lines.every((line) => one_side(line, side)));
    }
    const hills = (x, y) => Math.max(5 - Math.hypot(x - 6, y - 6), 5 - Math.hypot(x - 20, y - 6));
    const lines = lines_of(27, 13, hills, 2);
    assert.equal(lines.length, 2);
    assert.ok(lines.every(closed));
});

test("lines end at what does not count, and never pass it", () => {
    const hole = (x, y) => (Math.abs(x - 5) <= 1 && Math.abs(y - 5) <= 1 ? NaN : x);
    const lines = lines_of(11, 11, hole, 5.5);
    assert.equal(lines.length, 2);
    for (const [, y] of lines.flat()) assert.ok(y <= 3 || y >= 7);
    assert.deepEqual(
        lines_of(5, 5, () => NaN, 1),
        [],
    );
    assert.deepEqual(
        lines_of(1, 5, (x, y) => y, 1.5),
        [],
    );
});

test("a grid of random numbers has lines that are all closed or end at its border", () => {
    let seed = 7;
    const chance = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
    const values = Float64Array.from({ length: 30 * 20 }, chance);
    const lines = contour_lines(values, 30, 20, 0.5);
    const border = ([x, y]) => x === 0 || y === 0 || x === 29 || y === 19;
    for (const line of lines)
        assert.ok(closed(line) || (border(line[0]) && border(line.at(-1))), `${line}`);
    // Each edge between a point above and one below is on just one line.
    let edges = 0;
    for (let y = 0; y < 20; ++y)
        for (let x = 0; x < 30; ++x) {
            const above = (u, v) => values[30 * v + u] >= 0.5;
            if (x < 29 && above(x, y) !== above(x + 1, y)) ++edges;
            if (y < 19 && above(x, y) !== above(x, y + 1)) ++edges;
        }
    assert.equal(
        lines.reduce((sum, line) => sum + line.length - (closed(line) ? 1 : 0), 0),
        edges,
    );
});

const kMessages = isolux_messages({ id: 3, position: [0, 0, 1.6], height: 0.8 }, 1);
const grid = read_grid(kMessages.at(-1));

test("a grid is read as it was written, and must have as many values as points", () => {
    assert.equal(read_grid(kMessages[0]), null);
    assert.equal(grid.values.length, 32 * 32);
    near(place_on(grid, [0, 0]), [-3.875, -2.90625, 0.8]);
    near(place_on(grid, [31, 31]), [3.875, 2.90625, 0.8]);
    near([grid.values[0]], [lamp_illuminance(place_on(grid, [0, 0]), [0, 0, 1])], 1e-3);
    assert.ok(grid.values.some(Number.isNaN));
    assert.equal(spacing_of(grid), 0.25);
    assert.throws(() => read_grid({ ...kMessages[1], rows: 9 }), /missing values/);
    assert.throws(() => read_grid({ ...kMessages[1], values: "%" }));
});

test("mean, uniformity and diversity are those of the points that count", () => {
    const figures = statistics({ values: Float32Array.of(100, NaN, 300, 200, Infinity) });
    assert.deepEqual(figures, {
        count: 3,
        mean: 200,
        min: 100,
        max: 300,
        uniformity: 0.5,
        diversity: 1 / 3,
    });
    assert.equal(statistics({ values: [NaN] }), null);
    assert.ok(Number.isNaN(statistics({ values: [0, 0] }).uniformity));
});

test("levels are round, and between the least and the largest illuminance", () => {
    assert.deepEqual(levels_of({ min: 312, max: 548 }), [350, 400, 450, 500]);
    assert.deepEqual(levels_of({ min: 3, max: 900 }), [5, 10, 20, 50, 100, 200, 500]);
    assert.deepEqual(levels_of({ min: 5, max: 5 }), []);
    assert.deepEqual(levels_of({ min: 0, max: 0 }), []);
    const dark = levels_of({ min: 0, max: 500 });
    assert.ok(dark.length > 2 && dark.every((x) => x > 0 && x < 500));
});

test("contours lie where the illuminance is theirs", () => {
    const contours = contours_of(grid);
    assert.ok(contours.length >= 4);
    for (const { level, share, lines } of contours) {
        assert.ok(share > 0 && share < 1);
        for (const place of lines.flat())
            assert.ok(Math.abs(lamp_illuminance(place, [0, 0, 1]) / level - 1) < 0.03, `${place}`);
    }
    assert.deepEqual(contours_of({ ...grid, values: grid.values.map(() => NaN) }), []);
});

test("the table and the points for rtrace have what counts, and no more", () => {
    const count = statistics(grid).count;
    const table = grid_table(grid, { settled: 1, scene: "=a,b.rad", time: "now" });
    const rows = table.trimEnd().split("\r\n");
    assert.equal(rows[0], "x_m,y_m,z_m,illuminance_lx,settled,scene,time");
    assert.equal(rows.length, count + 1);
    assert.match(rows[1], /^-3\.875,-2\.90625,0\.8,[\d.]+,1,"'=a,b\.rad",now$/);
    const points = sensor_points(grid).trimEnd().split("\n");
    assert.equal(points.length, count);
    assert.equal(points[0], "-3.875 -2.90625 0.8 0 0 1");
    assert.match(
        trace_command("a b.pts", "it's.rad"),
        /^lightwalk trace -h -I 'it'\\''s\.rad' < 'a b\.pts' \| rcalc -e /,
    );
});

const kView = {
    type: "v",
    position: [0, 0, 1],
    direction: [0, 1, 0],
    up: [0, 0, 1],
    horizontal: 90,
    vertical: 90,
};
const kScreen = [400, 400];
const nothing = () => false;

test("a line is drawn where it is ahead and not hidden", () => {
    const line = Array.from({ length: 41 }, (_, k) => [k * 0.1 - 2, 2, 1]);
    const [whole] = strokes_of(kView, line, kScreen, nothing);
    assert.equal(whole.length, 41);
    near(whole[0], [0, 200], 1e-6);
    near(whole[40], [400, 200], 1e-6);
    const parts = strokes_of(kView, line, kScreen, ([x]) => Math.abs(x) < 0.45);
    assert.equal(parts.length, 2);
    assert.ok(parts.every((part) => part.length === 16));
    // From before the eye to behind it.
    const through = Array.from({ length: 41 }, (_, k) => [0.5, 2 - 0.1 * k, 0.5]);
    const [ahead] = strokes_of(kView, through, kScreen, nothing);
    assert.ok(ahead.length >= 18 && ahead.length <= 20);
    const behind = line.map(([x, y, z]) => [x, -y, z]);
    assert.deepEqual(strokes_of(kView, behind, kScreen, nothing), []);
    const beside = line.map(([x, y, z]) => [x + 50, y, z]);
    assert.deepEqual(strokes_of(kView, beside, kScreen, nothing), []);
});

test("in a panorama no line crosses the picture from one side to the other", () => {
    const circle = Array.from({ length: 73 }, (_, k) => [
        Math.cos((k * Math.PI) / 36),
        Math.sin((k * Math.PI) / 36),
        1,
    ]);
    const view = { ...kView, type: "c", horizontal: 360, vertical: 60 };
    for (const stroke of strokes_of(view, circle, kScreen, nothing))
        for (let k = 1; k < stroke.length; ++k)
            assert.ok(Math.abs(stroke[k][0] - stroke[k - 1][0]) < 10);
});

test("a label stands on the longest stroke, where it is long enough", () => {
    const short = [
            [10, 10],
            [40, 10],
        ],
        long = [
            [10, 50],
            [100, 50],
            [200, 50],
        ];
    assert.deepEqual(label_place([short, long], kScreen, []), [100, 50]);
    assert.deepEqual(label_place([short, long], kScreen, [[90, 45]]), [10, 50]);
    assert.equal(
        label_place([short, long], kScreen, [
            [60, 45],
            [180, 55],
        ]),
        null,
    );
    assert.equal(label_place([short], kScreen, []), null);
    assert.equal(path_of([short, long]), "M10.0 10.0L40.0 10.0M10.0 50.0L100.0 50.0L200.0 50.0");
});

test("a place is hidden where the frame shows something nearer", async () => {
    const [width, height] = [96, 96];
    const step = 1e-4;
    // A wall 4 m ahead, and a column 2 m ahead in its middle third.
    const inverse = (x) => Math.round((x >= 32 && x < 64 ? 0.5 : 0.25) / step);
    const bytes = new Uint8Array(depth_of_bands(step, bands_of(inverse, width, height)));
    const sight = new Sight(await decode_depth({ bytes }, width, height), kView, width, height);
    const { forward } = axes_of(kView);
    assert.deepEqual(forward, [0, 1, 0]);
    assert.equal(sight.hides([0, 3, 1]), true); // behind the column
    assert.equal(sight.hides([0, 2, 1]), false); // on it
    assert.equal(sight.hides([0, 1.5, 1]), false); // before it
    assert.equal(sight.hides([2, 3, 1]), false); // beside it
    assert.equal(sight.hides([2.9, 4, 1]), false); // on the wall
    assert.equal(sight.hides([3, 4.5, 1]), true); // behind the wall
    assert.equal(sight.hides([30, 3, 1]), false); // beside the picture
});

test("figures of a final grid are those that are told, with half of their intervals; a ratio has that of both", () => {
    const messages = isolux_messages({ id: 1, position: [0, 0, 1.6], height: 0.75 }, 1);
    const final = messages.at(-1),
        grid = read_grid(final);
    const figures = told_figures(grid, final);
    assert.equal(figures.count, statistics(grid).count);
    assert.deepEqual(
        [figures.mean, figures.min, figures.max],
        [final.mean, final.least, final.most],
    );
    assert.equal(figures.half.mean, final.mean_95);
    assert.ok(Math.abs(figures.uniformity - final.least / final.mean) < 1e-12);
    const shares = [final.mean_95 / final.mean, final.least_95 / final.least];
    const wanted = Math.hypot(...shares) * figures.uniformity;
    assert.ok(Math.abs(figures.half.uniformity - wanted) < 1e-12 && wanted > 0);
    assert.deepEqual(told_figures(grid, messages[1]), statistics(grid));
});
