// Measures what the page of a walk shows while the eye moves: the real page in headless Chromium, the real server, on this machine
// or behind a delay, against `lightwalk render` of the very view that is to be seen.
//
//     node perf/page_truth.mjs --npm FOLDER --folder SCENE --view FILE [--words "a.rad b.rad"] [--program lightwalk]
//         [--delay 0,100] [--moves turn,walk] [--pages camera,plain] [--size 1280x720] [--samples 8] [--pictures FOLDER]
//
// FOLDER has node_modules with playwright-core. A move holds keys for some seconds: `turn` an arrow key (69 degrees a second), `walk`
// W, `both` both. At some refreshes of the screen what the page shows is copied, with the view that is to be seen at that moment. One
// line for each page, move and delay (of a round trip [ms]):
//
//   psnr       of the copies against the rendered pictures, mean and least [dB]
//   off        pixels of which a channel is off by more than a tenth of white: mean and most [%]
//   refreshes  a second; input: from a key to the refresh that answers it, median and 95 % [ms]; script: the page's own time a refresh [ms]
//   frames     a second; Mbit/s: of messages from the server
import { spawn, spawnSync } from "node:child_process";
import { mkdir, mkdtemp, readFile, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import { parseArgs } from "node:util";
import { fit_view } from "../apps/viewer/view.js";
import { view_line } from "../apps/viewer/view_text.js";

const { values: args } = parseArgs({
    options: {
        npm: { type: "string" },
        program: { type: "string", default: "build/release/lightwalk" },
        folder: { type: "string" },
        words: { type: "string" },
        view: { type: "string" },
        options: { type: "string", default: "-av .02 .02 .02" },
        delay: { type: "string", default: "0,100" },
        moves: { type: "string", default: "turn,walk" },
        pages: { type: "string", default: "camera,plain" },
        size: { type: "string", default: "1280x720" },
        samples: { type: "string", default: "8" },
        seconds: { type: "string", default: "3" },
        pictures: { type: "string" },
        chromium: { type: "string", default: "/usr/bin/chromium" },
    },
});
const kMoves = { turn: ["ArrowRight"], walk: ["w"], both: ["w", "ArrowRight"], aside: ["d"] };
const kBegin = 500; // after which copies are made: the motion is at full speed [ms]
const kOff = 0.1 * 255;
const [width, height] = args.size.split("x").map(Number);
const program = path.resolve(args.program);
const scene_words = args.words.split(" ");
const options = args.options.split(" ");
const environment = { ...process.env, RAYPATH: ".:../lib" };

/** Start the server; returns its process and its address. */
function start_server() {
    const words = ["walk", "--port", "0", "--quiet", "-vf", args.view, ...options, ...scene_words];
    const server = spawn(program, words, {
        cwd: args.folder,
        env: environment,
        stdio: ["ignore", "pipe", "inherit"],
    });
    return new Promise((resolve, reject) => {
        server.stdout.once("data", (text) => resolve([server, new URL(String(text).trim())]));
        server.once("exit", () => reject(new Error("the server does not start")));
    });
}

/** A port of this machine at which the server is half a round trip away. */
function delayed(port, ms) {
    const pass = (from, to) => {
        from.on("data", (data) => setTimeout(() => to.writable && to.write(data), ms / 2));
        from.on("close", () => setTimeout(() => to.destroy(), ms / 2));
        from.on("error", () => to.destroy());
    };
    const proxy = net.createServer((client) => {
        const server = net.connect(port, "127.0.0.1");
        client.setNoDelay();
        server.setNoDelay();
        pass(client, server);
        pass(server, client);
    });
    return new Promise((resolve) => proxy.listen(0, "127.0.0.1", () => resolve(proxy)));
}

/** In the page: copy what is shown at some refreshes from `begin` to `end` [ms], and the view that the eye has then. */
function watch({ begin, end, samples }) {
    const [picture, camera] = ["#picture", "#camera"].map((id) => document.querySelector(id));
    const start = performance.now();
    const found = (window.watched = { copies: [], refreshes: 0, done: false });
    const look = () => {
        const now = performance.now() - start;
        if (now > end) return void (found.done = true);
        requestAnimationFrame(look);
        if (now < begin) return;
        ++found.refreshes;
        if (now < begin + (found.copies.length * (end - begin)) / samples) return;
        const canvas = document.createElement("canvas");
        canvas.width = innerWidth;
        canvas.height = innerHeight;
        const shown = camera && !camera.hidden ? camera : picture;
        canvas.getContext("2d").drawImage(shown, 0, 0, innerWidth, innerHeight);
        found.copies.push({ canvas, view: window.lightwalk.eye });
    };
    requestAnimationFrame(look);
}

/** Until the picture is of the present view, and a moment more. */
async function settled(page) {
    const there = () => {
        const { ready, shown_view_id, view_id, at_rest } = window.lightwalk;
        return ready && at_rest && shown_view_id === view_id;
    };
    await page.waitForFunction(there, null, { timeout: 60000 });
    await page.waitForTimeout(2000);
}

async function task_seconds(line) {
    const { metrics } = await line.send("Performance.getMetrics");
    const of = (name) => metrics.find((metric) => metric.name === name).value;
    return of("ScriptDuration");
}

/** Drive the page; returns copies as data URLs and what was counted. */
async function drive(page, address, move) {
    await page.goto(address);
    await settled(page);
    await page.focus("#picture");
    // The exposure stays as it is: this key switches, and the server remembers what an earlier page wished.
    if (await page.isChecked("#auto")) await page.keyboard.press("x");
    await settled(page);
    const line = await page.context().newCDPSession(page);
    await line.send("Performance.enable");
    const seconds = Number(args.seconds);
    const before = await page.evaluate(() => ({
        frames: window.lightwalk.frames,
        bytes: window.lightwalk.bytes,
    }));
    const script = await task_seconds(line);
    await page.evaluate(watch, {
        begin: kBegin,
        end: kBegin + 1000 * seconds,
        samples: Number(args.samples),
    });
    for (const key of kMoves[move]) await page.keyboard.down(key);
    await page.waitForFunction(() => window.watched.done);
    const spent = (await task_seconds(line)) - script;
    const found = await page.evaluate(() => {
        const { frames, bytes, latency, exposure, errors } = window.lightwalk;
        const copies = window.watched.copies.map(({ canvas, view }) => ({
            url: canvas.toDataURL(),
            view,
        }));
        return {
            frames,
            bytes,
            latency: [...latency].slice(-100),
            exposure,
            errors,
            refreshes: window.watched.refreshes,
            copies,
        };
    });
    for (const key of kMoves[move]) await page.keyboard.up(key);
    if (found.errors.length > 0) console.error(found.errors.join("\n"));
    const whole = seconds + kBegin / 1000;
    const waits = found.latency.sort((a, b) => a - b);
    return {
        ...found,
        figures: {
            refreshes: found.refreshes / seconds,
            input: waits[waits.length >> 1],
            "input 95 %": waits[Math.floor(0.95 * (waits.length - 1))],
            script: (1000 * spent) / (found.refreshes * (whole / seconds)),
            frames: (found.frames - before.frames) / whole,
            "Mbit/s": (8e-6 * (found.bytes - before.bytes)) / whole,
        },
    };
}

/** The true picture of a view, as a data URL. */
async function rendered(view, exposure, folder) {
    const file = path.join(folder, "true");
    await writeFile(`${file}.vf`, `${view_line(fit_view(view, width, height))}\n`);
    const size = ["-x", String(width), "-y", String(height), "-ps", "1", "-pa", "0"];
    const words = [
        "render",
        "--quiet",
        "-vf",
        `${file}.vf`,
        ...size,
        ...options,
        "--exposure",
        String(Math.log2(exposure)),
    ];
    const made = spawnSync(program, [...words, "-o", `${file}.png`, ...scene_words], {
        cwd: args.folder,
        env: environment,
    });
    if (made.status !== 0) throw new Error(String(made.stderr));
    return `data:image/png;base64,${(await readFile(`${file}.png`)).toString("base64")}`;
}

/** In a page: how far two pictures are apart, and one of both and their difference. */
async function compare({ shown, truth, most }) {
    const pixels = async (url) => {
        const bitmap = await createImageBitmap(await (await fetch(url)).blob());
        const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
        canvas.getContext("2d").drawImage(bitmap, 0, 0);
        return canvas.getContext("2d").getImageData(0, 0, bitmap.width, bitmap.height).data;
    };
    const [a, b] = [await pixels(shown), await pixels(truth)];
    let squares = 0,
        off = 0;
    for (let k = 0; k < a.length; k += 4) {
        let worst = 0;
        for (let c = 0; c < 3; ++c) {
            const apart = Math.abs(a[k + c] - b[k + c]);
            squares += apart * apart;
            worst = Math.max(worst, apart);
        }
        if (worst > most) ++off;
    }
    return {
        psnr: 10 * Math.log10((255 * 255) / (squares / (0.75 * a.length))),
        off: (400 * off) / a.length,
    };
}

async function measure(browser, address, kind, move, delay, folder) {
    const context = await browser.newContext({ viewport: { width, height } });
    const page = await context.newPage();
    const { copies, exposure, figures } = await drive(
        page,
        address + (kind === "plain" ? "?plain" : ""),
        move,
    );
    await context.close();
    const judge = await browser.newPage();
    const found = [];
    for (const [k, { url, view }] of copies.entries()) {
        const truth = await rendered(view, exposure, folder);
        found.push(await judge.evaluate(compare, { shown: url, truth, most: kOff }));
        if (!args.pictures) continue;
        const name = path.join(args.pictures, `${move}-${delay}-${k}`);
        await writeFile(`${name}-${kind}.png`, Buffer.from(url.split(",")[1], "base64"));
        await writeFile(`${name}-true-${kind}.png`, Buffer.from(truth.split(",")[1], "base64"));
    }
    await judge.close();
    const mean = (name) => found.reduce((sum, one) => sum + one[name], 0) / found.length;
    return {
        page: kind,
        move,
        delay,
        psnr: mean("psnr"),
        least: Math.min(...found.map(({ psnr }) => psnr)),
        off: mean("off"),
        most: Math.max(...found.map(({ off }) => off)),
        ...figures,
    };
}

const { chromium } = createRequire(path.resolve(args.npm, "none.js"))("playwright-core");
const folder = await mkdtemp(path.join(os.tmpdir(), "page-truth-"));
if (args.pictures) await mkdir(args.pictures, { recursive: true });
const [server, url] = await start_server();
const browser = await chromium.launch({
    executablePath: args.chromium,
    args: [
        "--no-sandbox",
        "--use-gl=angle",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
    ],
});
try {
    let titled = false;
    for (const delay of args.delay.split(",").map(Number)) {
        const proxy = await delayed(Number(url.port), delay);
        for (const move of args.moves.split(","))
            for (const kind of args.pages.split(",")) {
                const row = await measure(
                    browser,
                    `http://127.0.0.1:${proxy.address().port}/`,
                    kind,
                    move,
                    delay,
                    folder,
                );
                if (!titled) console.log(Object.keys(row).join("\t"));
                titled = true;
                console.log(
                    Object.values(row)
                        .map((x) => (typeof x === "number" ? x.toPrecision(3) : x))
                        .join("\t"),
                );
            }
        proxy.close();
    }
} finally {
    await browser.close();
    server.kill();
}
