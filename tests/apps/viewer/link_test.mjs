// The line to the server: addresses, waiting, latency, and frames on their way to the screen.
import assert from "node:assert/strict";
import { test } from "node:test";
import { socket_address, token_query, wait_before } from "../../../apps/viewer/connection.js";
import { Latency } from "../../../apps/viewer/latency.js";
import { picture_size, Screen } from "../../../apps/viewer/screen.js";

test("the WebSocket is beside the page, with its token and nothing else of its address", () => {
    assert.equal(socket_address("http://127.0.0.1:8080/"), "ws://127.0.0.1:8080/walk");
    assert.equal(
        socket_address("http://host:8080/?x=1&token=ab12#top"),
        "ws://host:8080/walk?token=ab12",
    );
    assert.equal(socket_address("https://host/light/"), "wss://host/light/walk");
    assert.equal(token_query("http://host/?token=a%26b"), "?token=a%26b");
    assert.equal(token_query("http://host/"), "");
});

test("each try waits twice as long, and never for ever", () => {
    assert.deepEqual([0, 1, 2, 3].map(wait_before), [250, 500, 1000, 2000]);
    assert.equal(wait_before(1000), 5000);
});

test("the picture has the window's own pixels, and its shape where the server draws fewer", () => {
    assert.deepEqual(picture_size(1280, 800, 1, [4096, 4096]), { width: 1280, height: 800 });
    assert.deepEqual(picture_size(390, 844, 3, [4096, 4096]), { width: 1170, height: 2532 });
    assert.deepEqual(picture_size(1920, 1080, 2, [1920, 1600]), { width: 1920, height: 1080 });
    assert.deepEqual(picture_size(1000, 10, 0.01, [100, 100]), { width: 10, height: 1 });
});

test("latency runs from the input to the first frame that shows it, also when views were skipped", () => {
    const latency = new Latency();
    latency.sent(1, 100);
    latency.sent(2, 110);
    latency.sent(3, 130);
    latency.shown(2, 150);
    assert.deepEqual(latency.samples, [50, 40]);
    latency.shown(2, 999);
    assert.equal(latency.samples.length, 2);
    latency.shown(3, 160);
    assert.deepEqual(latency.samples, [50, 40, 30]);
    assert.equal(latency.quantile(0.5), 40);
    assert.equal(latency.quantile(0.95), 50);
});

test("latency keeps the newest samples, and forgets what a broken line will not bring", () => {
    const latency = new Latency();
    assert.equal(latency.quantile(0.5), null);
    for (let id = 1; id <= 1000; ++id) {
        latency.sent(id, 0);
        latency.shown(id, id);
    }
    assert.ok(latency.samples.length < 500);
    assert.equal(latency.samples.at(-1), 1000);
    latency.sent(1001, 0);
    latency.forget();
    latency.shown(1001, 5000);
    assert.equal(latency.samples.at(-1), 1000);
});

/** A frame of one piece whose decoding the test ends when it likes. */
function frame(number, flags) {
    const bytes = new Uint8Array(48 + 16 + 1),
        data = new DataView(bytes.buffer);
    bytes.set([0x4c, 0x57, 0x46, 0x31]);
    data.setUint32(4, number, true);
    [8, 8].forEach((size, k) => data.setUint16(12 + 2 * k, size, true));
    data.setUint8(16, flags);
    data.setUint16(18, 1, true);
    [0, 0, 8, 8].forEach((v, k) => data.setUint16(48 + 2 * k, v, true));
    data.setUint8(56, 1);
    data.setUint32(60, 1, true);
    return bytes.buffer;
}

/** A screen without a browser: what happens is told in `log`; decoders end by hand. */
function dry_screen() {
    const log = [],
        decoders = [];
    globalThis.createImageBitmap = () =>
        new Promise((resolve, reject) =>
            decoders.push({ resolve: () => resolve({ close() {} }), reject }),
        );
    const context = { drawImage: () => log.push("draw") };
    const canvas = { width: 300, height: 150, getContext: () => context };
    const screen = new Screen(canvas, {
        drawn: (f) => log.push(`drawn ${f.frame}`),
        skipped: (f) => log.push(`skipped ${f.frame}`),
        failed: (error, f) => log.push(`failed ${f ? f.frame : "-"}`),
    });
    const settle = () => new Promise((resolve) => setTimeout(resolve, 0));
    return { screen, canvas, log, decoders, settle };
}

test("frames are drawn in their order whichever is decoded first", async () => {
    const { screen, canvas, log, decoders, settle } = dry_screen();
    screen.receive(frame(1, 1));
    screen.receive(frame(2, 0));
    decoders[1].resolve();
    await settle();
    assert.deepEqual(log, []);
    decoders[0].resolve();
    await settle();
    assert.deepEqual(log, ["draw", "drawn 1", "draw", "drawn 2"]);
    assert.deepEqual([canvas.width, canvas.height], [8, 8]);
});

test("a whole frame makes those before it needless; a partial one does not, as it builds on them", async () => {
    const { screen, log, decoders, settle } = dry_screen();
    screen.receive(frame(1, 1));
    screen.receive(frame(2, 1));
    decoders.forEach((d) => d.resolve());
    await settle();
    assert.deepEqual(log, ["skipped 1", "draw", "drawn 2"]);
});

test("a piece that cannot be decoded fails its frame alone", async () => {
    const { screen, log, decoders, settle } = dry_screen();
    screen.receive(frame(1, 1));
    screen.receive(frame(2, 0));
    decoders[0].reject(new Error("bad"));
    decoders[1].resolve();
    await settle();
    assert.deepEqual(log, ["failed 1", "draw", "drawn 2"]);
    screen.receive(new ArrayBuffer(3));
    assert.equal(log.at(-1), "failed -");
});
