// Walks about for minutes in the real page, in headless Chromium, and tells whether the memory of page and server stays level.
//
//     node perf/soak_page.mjs --npm FOLDER --folder SCENE --view FILE --words "a.rad b.rad" [--program lightwalk]
//         [--minutes 10] [--every 20] [--size 480x270] [--seed 1]
//
// FOLDER has node_modules with playwright-core. Keys are held at random, so that the eye never rests for long; every so many seconds one line:
//
//   s         since the walk began
//   heap      of the page's scripts, what is left after the garbage is collected [MB]; nodes: of its document
//   textures  in WebGL that have not been deleted, with the bytes that they were given [MB]; buffers: the same
//   renderer  share of the system's memory of the process that has the page (and decodes frames) [MB]; gpu: of the process that draws
//   server    memory of the server [MB]
//   frames    that the page has drawn since the line before
//
// It ends with a verdict, and status 1 where a figure's median in the last third of the time is by a tenth above that in the second third.
import { readFile } from "node:fs/promises";
import {
    command_line,
    quantile,
    row_printer,
    settled,
    start_browser,
    start_server,
} from "./walk_setup.mjs";

const words = command_line({ minutes: "10", every: "20", size: "480x270", seed: "1" });
const { args, program, scene, size } = words;
const kKeys = ["ArrowLeft", "ArrowRight", "w", "s", "a", "d"];
const kHold = 1500; // of a key, at most [ms]
const kGrowth = 1.1;
const kLevel = ["heap", "nodes", "textures", "texture MB", "buffers", "buffer MB", "renderer"];
kLevel.push("gpu", "server");
const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** In the page, before its scripts: count what WebGL2 holds. */
function count_graphics() {
    const kinds = { Texture: new Map(), Buffer: new Map() }; // bytes by object
    window.graphics = () =>
        Object.values(kinds).flatMap((all) => [
            all.size,
            [...all.values()].reduce((sum, bytes) => sum + bytes, 0),
        ]);
    const own = WebGL2RenderingContext.prototype;
    const after = (name, act) => {
        const before = own[name];
        own[name] = function (...words) {
            const result = before.apply(this, words);
            act(this, words, result);
            return result;
        };
    };
    for (const [kind, all] of Object.entries(kinds)) {
        after(`create${kind}`, (gl, _, made) => all.set(made, 0));
        after(`delete${kind}`, (gl, [gone]) => all.delete(gone));
    }
    after("texImage2D", (gl, given) => {
        const source = given.at(-1); // a canvas or an array
        const bytes = source?.byteLength ?? 4 * source.width * source.height;
        kinds.Texture.set(gl.getParameter(gl.TEXTURE_BINDING_2D), bytes);
    });
    after("bufferData", (gl, [target, data]) => {
        const corners = target === gl.ELEMENT_ARRAY_BUFFER;
        const bound = corners ? gl.ELEMENT_ARRAY_BUFFER_BINDING : gl.ARRAY_BUFFER_BINDING;
        kinds.Buffer.set(gl.getParameter(bound), data.byteLength);
    });
}

/** Hold keys at random until `until` [ms]. A generator after Marsaglia (2003), so that a seed gives the same way again. */
async function walk_about(page, until) {
    let state = Number(args.seed) || 1;
    const chance = () => {
        for (const [left, by] of [
            [true, 13],
            [false, 17],
            [true, 5],
        ])
            state ^= left ? state << by : state >>> by;
        return (state >>> 0) / 2 ** 32;
    };
    while (performance.now() < until) {
        const keys = kKeys.filter(() => chance() < 0.3);
        for (const key of keys) await page.keyboard.down(key);
        await wait(200 + chance() * kHold);
        for (const key of keys) await page.keyboard.up(key);
    }
}

/** A line of /proc/PID/FILE [MB]; 0 where it is not there. */
async function memory_of(pid, file, name) {
    const text = await readFile(`/proc/${pid}/${file}`, "utf8").catch(() => "");
    return Number(text.match(RegExp(`^${name}:\\s+(\\d+) kB`, "m"))?.[1] ?? 0) / 1024;
}

async function figures_now(page, line, whole, server) {
    await line.send("HeapProfiler.collectGarbage");
    const { metrics } = await line.send("Performance.getMetrics");
    const of = (name) => metrics.find((metric) => metric.name === name).value;
    const [textures, texture_bytes, buffers, buffer_bytes] = await page.evaluate(() =>
        window.graphics(),
    );
    const { processInfo } = await whole.send("SystemInfo.getProcessInfo");
    const shares = { renderer: 0, GPU: 0 };
    for (const { type, id } of processInfo)
        if (type in shares) shares[type] += await memory_of(id, "smaps_rollup", "Pss");
    return {
        heap: of("JSHeapUsedSize") / 1e6,
        nodes: of("Nodes"),
        textures,
        "texture MB": texture_bytes / 1e6,
        buffers,
        "buffer MB": buffer_bytes / 1e6,
        renderer: shares.renderer,
        gpu: shares.GPU,
        server: await memory_of(server.pid, "status", "VmRSS"),
    };
}

/** The figures that have grown, as text. */
function grown(rows) {
    const third = Math.floor(rows.length / 3);
    const median = (part, name) =>
        quantile(
            part.map((row) => row[name]),
            0.5,
        );
    return kLevel.flatMap((name) => {
        const before = median(rows.slice(third, 2 * third), name);
        const after = median(rows.slice(2 * third), name);
        return after > kGrowth * before ? [`${name} grows: ${before} to ${after}`] : [];
    });
}

const [server, url] = await start_server(program, scene);
const browser = await start_browser(words);
const rows = [];
let errors = [];
try {
    const page = await browser.newPage({ viewport: { width: size[0], height: size[1] } });
    await page.addInitScript(count_graphics);
    await page.goto(url.href);
    await settled(page);
    await page.focus("#picture");
    const line = await page.context().newCDPSession(page);
    await line.send("Performance.enable");
    const whole = await browser.newBrowserCDPSession();
    const print_row = row_printer();
    const begin = performance.now();
    let before = 0;
    while (performance.now() < begin + 60000 * Number(args.minutes)) {
        await walk_about(page, performance.now() + 1000 * Number(args.every));
        const found = await figures_now(page, line, whole, server);
        const seen = await page.evaluate(() => window.lightwalk.frames);
        rows.push(found);
        print_row({ s: (performance.now() - begin) / 1000, ...found, frames: seen - before });
        before = seen;
    }
    errors = await page.evaluate(() => window.lightwalk.errors);
} finally {
    await browser.close();
    server.kill();
}
const faults = [...grown(rows), ...errors.map((text) => `the page says: ${text}`)];
console.log(faults.length === 0 ? "memory stays level" : faults.join("\n"));
process.exitCode = faults.length === 0 ? 0 : 1;
