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
//   detail     correlation of the gradients of both pictures, mean
//   refreshes  a second; input: from a key to the refresh that answers it, median and 95 % [ms]; script: the page's own time a refresh [ms]
//   frames     a second; Mbit/s: of messages from the server
import { mkdir, writeFile } from "node:fs/promises";
import path from "node:path";
import {
    command_line,
    delayed,
    mean_of,
    own_folder,
    quantile,
    row_printer,
    settled,
    start_browser,
    start_server,
} from "./walk_setup.mjs";
import { compare, kOff, renderer } from "./walk_truth.mjs";

const words = command_line({
    delay: "0,100",
    moves: "turn,walk",
    pages: "camera,plain",
    samples: "8",
    seconds: "3",
    pictures: undefined,
});
const { args, program, scene, size } = words;
const [width, height] = size;
const kMoves = { turn: ["ArrowRight"], walk: ["w"], both: ["w", "ArrowRight"], aside: ["d"] };
const kBegin = 500; // after which copies are made: the motion is at full speed [ms]

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
    return {
        ...found,
        figures: {
            refreshes: found.refreshes / seconds,
            input: quantile(found.latency, 0.5),
            "input 95 %": quantile(found.latency, 0.95),
            script: (1000 * spent) / (found.refreshes * (whole / seconds)),
            frames: (found.frames - before.frames) / whole,
            "Mbit/s": (8e-6 * (found.bytes - before.bytes)) / whole,
        },
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
    const rendered = renderer(program, scene, size, folder);
    const found = [];
    for (const [k, { url, view }] of copies.entries()) {
        const truth = await rendered(view, exposure);
        const pieces = [{ url, x: 0, y: 0 }];
        found.push(await judge.evaluate(compare, { pieces, truth, size, most: kOff }));
        if (!args.pictures) continue;
        const name = path.join(args.pictures, `${move}-${delay}-${k}`);
        await writeFile(`${name}-${kind}.png`, Buffer.from(url.split(",")[1], "base64"));
        await writeFile(`${name}-true-${kind}.png`, Buffer.from(truth.split(",")[1], "base64"));
    }
    await judge.close();
    const mean = (name) => mean_of(found.map((one) => one[name]));
    return {
        page: kind,
        move,
        delay,
        psnr: mean("psnr"),
        least: Math.min(...found.map(({ psnr }) => psnr)),
        off: mean("off"),
        most: Math.max(...found.map(({ off }) => off)),
        detail: mean("detail"),
        ...figures,
    };
}

const folder = await own_folder("page-truth");
if (args.pictures) await mkdir(args.pictures, { recursive: true });
const [server, url] = await start_server(program, scene);
const browser = await start_browser(words);
const print_row = row_printer();
try {
    for (const delay of args.delay.split(",").map(Number)) {
        const proxy = await delayed(Number(url.port), delay);
        const address = `http://127.0.0.1:${proxy.address().port}/`;
        for (const move of args.moves.split(","))
            for (const kind of args.pages.split(","))
                print_row(await measure(browser, address, kind, move, delay, folder));
        proxy.close();
    }
} finally {
    await browser.close();
    server.kill();
}
