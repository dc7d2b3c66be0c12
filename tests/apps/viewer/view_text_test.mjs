// View files: what is written is read again, by Radiance's programs and by us.
import assert from "node:assert/strict";
import { test } from "node:test";
import { parse_views, path_text, view_line } from "../../../apps/viewer/view_text.js";

const kView = {
    type: "v",
    position: [9.2, 6.3, 1.7],
    direction: [-0.86, -0.5, -0.06],
    up: [0, 0, 1],
    horizontal: 62,
    vertical: 48,
    fore: 0,
    aft: 0,
    shift: 0,
    lift: 0,
};

test("a view is written as Radiance's options, after VIEW=", () => {
    assert.equal(
        view_line(kView),
        "VIEW= -vtv -vp 9.2 6.3 1.7 -vd -0.86 -0.5 -0.06 -vu 0 0 1 -vh 62 -vv 48 -vo 0 -va 0 -vs 0 -vl 0\n",
    );
});

test("what is written is read again", () => {
    const odd = {
        ...kView,
        type: "h",
        position: [-1234.5678, 1e-3, 0],
        horizontal: 179.5,
        fore: 0.1,
        aft: 20,
        shift: -0.5,
        lift: 0.25,
    };
    assert.deepEqual(parse_views(view_line(odd)), [odd]);
});

test("numbers of up to eight digits survive; small ones are not written as nothing", () => {
    const [view] = parse_views(
        view_line({ ...kView, position: [12345.678, -0.00012345678, 3e-9] }),
    );
    assert.deepEqual(view.position, [12345.678, -0.00012345678, 3e-9]);
});

test("a path is a time and a view a line", () => {
    const text = path_text([
        { time: 0, view: kView },
        { time: 2.5, view: { ...kView, position: [0, 0, 0] } },
    ]);
    const lines = text.trimEnd().split("\n");
    assert.equal(lines.length, 2);
    assert.match(lines[0], /^0 VIEW= -vtv -vp 9\.2 /);
    assert.match(lines[1], /^2\.5 VIEW= -vtv -vp 0 0 0 /);
    assert.equal(parse_views(text).length, 2);
});

test("lines of programs count, comments and pictures' other lines do not", () => {
    const views = parse_views(
        "# a walk\nrvu -vp 1 2 3 -vd 0 1 0\n\nEXPOSURE=2\n  rpict -vp 4 5 6\r\nVIEW= -vh 30\n",
    );
    assert.deepEqual(
        views.map((v) => v.position),
        [
            [1, 2, 3],
            [4, 5, 6],
            [4, 5, 6],
        ],
    );
    assert.deepEqual(views[1].direction, [0, 1, 0]); // as the line before
    assert.equal(views[2].horizontal, 30);
});

test("options that are no view options, and malformed ones, are skipped", () => {
    const [view] = parse_views("rview -w -vp 1 2 x -ab 2 -vtq -vta -vh 100 scene.oct");
    assert.deepEqual(view.position, [0, 0, 0]);
    assert.equal(view.type, "a");
    assert.equal(view.horizontal, 100);
});

test("a file without views is an error", () => {
    for (const text of ["", "hello", "VIEW=", "preview -vp 1 2 3", "rvu.log -vp 1 2 3"])
        assert.throws(() => parse_views(text), /no line like "VIEW= /);
});

test("a view that cannot be drawn is an error with its line; angles that are too large are limited later", () => {
    const down = "VIEW= -vp 0 0 2 -vd 0 1 0 -vu 0 0 1\nVIEW= -vd 0 0 -1\n";
    assert.throws(() => parse_views(down), /^Error: line 2: view up parallel to view direction$/);
    assert.throws(() => parse_views("VIEW= -vp 3e9 0 0"), /line 1: a number is missing or larger/);
    assert.throws(() => parse_views("VIEW= -vd 0 0 0"), /zero view direction/);
    assert.throws(() => parse_views("VIEW= -vu 0 0 0"), /zero view up vector/);
    assert.throws(() => parse_views("VIEW= -vh 0"), /illegal horizontal view size/);
    assert.throws(() => parse_views("VIEW= -vo 2 -va 1"), /illegal fore.aft clipping plane/);
    assert.equal(parse_views("VIEW= -vh 200")[0].horizontal, 200);
});
