// Frames: the binary layout, byte by byte, and everything that is no frame.
import assert from "node:assert/strict";
import { test } from "node:test";
import { parse_frame } from "../../../apps/viewer/frame.js";
import { parse_luminance } from "../../../apps/viewer/decoding.js";

/** A frame written by offsets alone, as the protocol's table has them. */
function frame({
    flags = 5,
    pieces = [
        [0, 0, 4, 2, 1, [0xff, 0xd8]],
        [4, 2, 4, 4, 2, [1, 2, 3]],
    ],
    width = 8,
    height = 6,
} = {}) {
    const bytes = new Uint8Array(48 + pieces.reduce((sum, p) => sum + 16 + p[5].length, 0));
    const data = new DataView(bytes.buffer);
    bytes.set([0x4c, 0x57, 0x46, 0x31]);
    data.setUint32(4, 0xfffffffe, true);
    data.setUint32(8, 77, true);
    data.setUint16(12, width, true);
    data.setUint16(14, height, true);
    data.setUint8(16, flags);
    data.setUint8(17, 200);
    data.setUint16(18, pieces.length, true);
    data.setFloat32(20, 0.5, true);
    [1.25, -2.5, 1e-7].forEach((x, k) => data.setFloat64(24 + 8 * k, x, true));
    let at = 48;
    for (const [x, y, w, h, codec, content] of pieces) {
        [x, y, w, h].forEach((v, k) => data.setUint16(at + 2 * k, v, true));
        data.setUint8(at + 8, codec);
        data.setUint32(at + 12, content.length, true);
        bytes.set(content, at + 16);
        at += 16 + content.length;
    }
    return bytes.buffer;
}

test("the header's numbers stand where the protocol has them", () => {
    const { pieces, ...head } = parse_frame(frame());
    assert.deepEqual(head, {
        frame: 0xfffffffe,
        view_id: 77,
        width: 8,
        height: 6,
        complete: true,
        at_rest: false,
        final: true,
        denoised: false,
        display: 200,
        exposure: 0.5,
        eye: [1.25, -2.5, 1e-7],
        depth: null,
        luminance: null,
    });
    assert.equal(pieces.length, 2);
});

test("each flag is one bit", () => {
    for (const [flags, name] of [
        [1, "complete"],
        [2, "at_rest"],
        [4, "final"],
        [8, "denoised"],
    ]) {
        const head = parse_frame(frame({ flags }));
        for (const other of ["complete", "at_rest", "final", "denoised"])
            assert.equal(head[other], other === name);
    }
});

test("pieces follow each other without padding", () => {
    const { pieces } = parse_frame(frame());
    assert.deepEqual(
        pieces.map(({ x, y, width, height, type }) => [x, y, width, height, type]),
        [
            [0, 0, 4, 2, "image/jpeg"],
            [4, 2, 4, 4, "image/png"],
        ],
    );
    assert.deepEqual(
        pieces.map(({ bytes }) => [...bytes]),
        [
            [0xff, 0xd8],
            [1, 2, 3],
        ],
    );
});

test("a frame without pieces is one: nothing has changed", () => {
    assert.deepEqual(parse_frame(frame({ pieces: [] })).pieces, []);
});

test("a frame that is cut off anywhere is refused", () => {
    const whole = frame();
    for (let size = 0; size < whole.byteLength; ++size)
        assert.throws(() => parse_frame(whole.slice(0, size)), /^Error: frame: /, `${size} bytes`);
});

test("what is too long, outside, of an unknown codec or no frame at all is refused", () => {
    const longer = new Uint8Array(frame().byteLength + 1);
    longer.set(new Uint8Array(frame()));
    assert.throws(() => parse_frame(longer.buffer), /after the last piece/);
    assert.throws(() => parse_frame(frame({ pieces: [[5, 0, 4, 2, 1, [1]]] })), /outside/);
    assert.throws(() => parse_frame(frame({ pieces: [[0, 5, 4, 2, 1, [1]]] })), /outside/);
    assert.throws(() => parse_frame(frame({ pieces: [[0, 0, 4, 2, 5, [1]]] })), /codec/);
    for (const [codec, name] of [
        [3, "depth"],
        [4, "luminance"],
    ]) {
        assert.throws(() => parse_frame(frame({ pieces: [[0, 0, 4, 2, codec, [1]]] })), /size/);
        const piece = [0, 0, 8, 6, codec, [1]];
        assert.throws(() => parse_frame(frame({ pieces: [piece, piece] })), RegExp(name));
        assert.deepEqual([...parse_frame(frame({ pieces: [piece] }))[name].bytes], [1]);
    }
    const other = new Uint8Array(frame());
    other[3] = 0x32;
    assert.throws(() => parse_frame(other.buffer), /not a frame/);
});

test("a luminance piece has three numbers and a picture; none, and none that make sense, are told apart", () => {
    const bytes = new Uint8Array(15);
    const data = new DataView(bytes.buffer);
    [-3, 0.125, 16].forEach((x, k) => data.setFloat32(4 * k, x, true));
    bytes.set([0xff, 0xd8, 1], 12);
    const { jpeg, ...numbers } = parse_luminance({ bytes });
    assert.deepEqual(numbers, { low: -3, step: 0.125, white: 16 });
    assert.deepEqual([...jpeg], [0xff, 0xd8, 1]);
    assert.equal(parse_luminance({ bytes: new Uint8Array(0) }), null);
    assert.throws(() => parse_luminance({ bytes: bytes.subarray(0, 11) }), /cut off/);
    for (const [k, wrong] of [
        [0, NaN],
        [0, Infinity],
        [1, 0],
        [1, -1],
        [2, -1],
        [2, NaN],
    ]) {
        const other = bytes.slice();
        new DataView(other.buffer).setFloat32(4 * k, wrong, true);
        assert.throws(() => parse_luminance({ bytes: other }), /sense/);
    }
});
