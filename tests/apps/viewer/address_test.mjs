// Views in the page's address, and when an address becomes an entry of the browser's history.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Address, fragment_view, view_fragment } from "../../../apps/viewer/address.js";
import { fit_view } from "../../../apps/viewer/view.js";

const kView = {
    type: "v",
    position: [3, -2.2, 1.6],
    direction: [0, 2, 0],
    up: [0, 0, 1],
    horizontal: 70,
    vertical: 50,
    fore: 0,
    aft: 0,
    shift: 0,
    lift: 0,
};

test("a view is a short, readable fragment", () => {
    assert.equal(view_fragment(kView), "#vp=3,-2.2,1.6&vd=0,1,0&vh=70");
});

test("what is written is read again; the vertical size comes from the window", () => {
    const odd = {
        ...kView,
        type: "h",
        position: [-1234.56, 0.001, 0],
        direction: [0.6, 0.8, 0],
        up: [0, 1, 0],
        horizontal: 179.5,
        fore: 0.1,
        aft: 20,
        shift: -0.5,
        lift: 0.25,
    };
    for (const view of [{ ...kView, direction: [0, 1, 0] }, odd]) {
        const read = fragment_view(view_fragment(view));
        assert.deepEqual(fit_view(read, 8, 5), fit_view(view, 8, 5));
        assert.equal(view_fragment(read), view_fragment(view));
    }
});

test("a fragment that names no view that can be drawn is none", () => {
    for (const text of [
        "",
        "#",
        "#top",
        "#vp=1,2,3",
        "#vd=0,1,0&vh=60",
        "#vp=1,2&vd=0,1,0",
        "#vp=1,2,x&vd=0,1,0",
        "#vp=1,2,&vd=0,1,0",
        "#vp=1,2,3&vd=0,0,0",
        "#vp=1,2,3&vd=0,0,1",
        "#vp=1,2,1e99&vd=0,1,0",
        "#vp=1,2,3&vd=0,1,0&vt=q",
        "#vp=1,2,3&vd=0,1,0&vh=-3",
    ])
        assert.equal(fragment_view(text), null, text);
});

/** An address whose writes are noted, and a function that lets the eye stand at x for a time. */
function watched() {
    const written = [];
    const address = new Address((text, fresh) =>
        written.push([fragment_view(text).position[0], fresh]),
    );
    let now = 0;
    const stay = (x, ms, moving = false) => {
        for (const end = now + ms; now < end; now += 100)
            address.follow({ ...kView, position: [x, 0, 0] }, moving, now);
    };
    return { address, stay, written };
}

test("the address follows the eye when it rests, not while it moves", () => {
    const { address, stay, written } = watched();
    address.read("");
    stay(1, 1000);
    for (let x = 2; x < 20; ++x) stay(x, 100, true);
    stay(20, 3000, true);
    assert.deepEqual(written, [[1, false]]);
    stay(20, 1000);
    assert.deepEqual(written, [
        [1, false],
        [20, false],
    ]);
});

test("a view that was chosen is a new entry where the eye comes to rest; one from the history is none", () => {
    const { address, stay, written } = watched();
    address.read("");
    stay(1, 1000);
    address.choose();
    stay(2, 500, true);
    stay(3, 1000);
    stay(4, 1000);
    address.read(view_fragment({ ...kView, position: [1, 0, 0] }));
    stay(2, 300, true);
    stay(1, 1000);
    assert.deepEqual(written, [
        [1, false],
        [3, true],
        [4, false],
    ]);
});
