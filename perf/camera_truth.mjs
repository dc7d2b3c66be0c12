// Measures what the page of a walk shows at refreshes of the screen while the eye moves, where drawing takes it no time: a client without
// a browser drives the real server, alone on this machine, and keeps the frames with the moments at which they came; afterwards
// the page's own modules draw the camera of some moments from what had come by then, in Chromium, against `lightwalk render`.
//
//     node perf/camera_truth.mjs --npm FOLDER --folder SCENE --view FILE [--words "a.rad b.rad"] [--program lightwalk]
//         [--moves turn,walk] [--size 1280x720] [--seconds 6] [--samples 12] [--delay 0] [--pictures FOLDER] [--plain FOLDER]
//
// FOLDER has node_modules with ws and playwright-core. The moves are those of frame_truth.mjs. --delay: of a round trip [ms]. --plain: of a program
// whose page shows frames as they come, the newest one enlarged; FOLDER: its sources. One line for each move:
//
//   psnr     of what is drawn against the rendered picture of that very view, mean and least [dB]
//   off      pixels of which a channel is off by more than a tenth of white: mean and most [%]; floor: as frame_truth.mjs has it
//   detail   correlation of the gradients of both pictures
//   frames   a second; width: of the frames, share of the size asked for [%]; Mbit/s: of messages from the server
import { mkdir, readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { FrameTimes } from "../apps/viewer/prediction.js";
import { fit_view } from "../apps/viewer/view.js";
import { parse_views } from "../apps/viewer/view_text.js";
import { margin_for, turn_between, widened } from "../apps/viewer/warp.js";
import { Client, moved, stand, wait } from "./walk_client.mjs";
import {
    command_line,
    mean_of as mean,
    own_folder,
    row_printer,
    start_browser,
    start_server,
} from "./walk_setup.mjs";
import { compare, kOff, renderer } from "./walk_truth.mjs";

const words = command_line({
    moves: "turn,walk",
    seconds: "6",
    samples: "12",
    delay: "0",
    pictures: undefined,
    plain: undefined,
});
const { args, load, program, scene, size } = words;
const [width, height] = size;
const kBegin = 1; // after which refreshes are judged [s]

/** What the page sends while the eye moves: where it will be when the frame is there, and wider than the window. */
function sent_view(eye_at, t, times) {
    const now = fit_view(eye_at(t), width, height);
    if (args.plain) return now;
    const { ahead, apart } = times;
    const then = fit_view(eye_at(t + ahead), width, height);
    const turn = turn_between(then, now) * Math.min(1, (apart + 0.3 * ahead) / ahead || 0);
    return widened(then, margin_for(now, turn));
}

/** Drive a walk; returns {frames: as they came, with the views that they show, eye_at(t), began, ...}. */
async function drive(address, move) {
    const source = args.plain ? path.resolve(args.plain, "apps/viewer/frame.js") : undefined;
    const parse = source && (await import(source)).parse_frame;
    const client = new Client(load("ws"), address, size, Number(args.delay) / 2, parse);
    const { eye_height } = await client.loaded;
    const text = await readFile(path.join(args.folder, args.view), "utf8");
    const first = fit_view(parse_views(text)[0], width, height);
    const eye_at = (t) => moved(first, move, t, eye_height);
    await stand(client, first);
    const times = new FrameTimes();
    const sent = new Map();
    let shown = 0;
    client.on_frame = ({ view_id }) => {
        if (view_id !== shown && sent.has(view_id))
            times.shown(sent.get(view_id), performance.now());
        shown = view_id;
    };
    Object.assign(client, { frames: client.frames.slice(-1), states: [], bytes: 0 });
    const began = performance.now();
    const seconds = Number(args.seconds);
    for (let t = 0; t < seconds; t = (performance.now() - began) / 1000) {
        client.look(sent_view(eye_at, t, times), true);
        sent.set(client.id, performance.now());
        await wait(1000 / 60);
    }
    client.socket.close();
    const frames = client.frames.map((frame) => ({
        ...frame,
        at: (frame.at - began) / 1000,
        shows: { ...client.views.get(frame.view_id), position: frame.eye },
    }));
    return { frames, eye_at, seconds, bytes: client.bytes };
}

/** In a page that has the server's modules: what takes frames, and draws the camera or shows them as they come. */
async function start_camera([width, height, plain]) {
    const { Reprojection } = plain ? {} : await import("/page/reprojection.js");
    const { decode_depth } = plain ? {} : await import("/page/depth.js");
    const canvas = document.createElement("canvas");
    const picture = document.createElement("canvas");
    Object.assign(canvas, { width, height });
    const reprojection = plain ? null : new Reprojection(canvas);
    let known = null;
    window.take = async ({ pieces, depth, size, view }) => {
        if (pieces.length > 0) Object.assign(picture, { width: size[0], height: size[1] });
        const context = picture.getContext("2d", { alpha: false });
        for (const { url, x, y } of pieces)
            context.drawImage(await createImageBitmap(await (await fetch(url)).blob()), x, y);
        if (plain) return;
        if (depth) {
            const bytes = Uint8Array.from(atob(depth), (c) => c.charCodeAt(0));
            known = await decode_depth({ bytes }, ...size);
        }
        if (known) reprojection.keep({ picture, depth: known, view }, false, [width, height]);
    };
    window.draw = (view) => {
        if (plain) return picture.toDataURL();
        reprojection.draw(view, width, height);
        return canvas.toDataURL();
    };
}

const base64 = (bytes) => Buffer.from(bytes).toString("base64");
const portable = ({ pieces, depth, width, height, shows }) => ({
    pieces: pieces.map(({ x, y, type, bytes }) => ({
        url: `data:${type};base64,${base64(bytes)}`,
        x,
        y,
    })),
    depth: depth && base64(depth.bytes),
    size: [width, height],
    view: shows,
});

/** Draw what the page showed at some moments, with {shown, view, exposure, size}. */
async function draw_moments(page, { frames, eye_at, seconds }) {
    const count = Number(args.samples);
    const moments = Array.from(
        { length: count },
        (_, k) => kBegin + ((k + 0.5) * (seconds - kBegin)) / count,
    );
    const found = [];
    let next = 0;
    for (const t of moments) {
        for (; next < frames.length && frames[next].at <= t; ++next)
            await page.evaluate((frame) => window.take(frame), portable(frames[next]));
        const view = fit_view(eye_at(t), width, height);
        const newest = frames[next - 1];
        const shown = await page.evaluate((of) => window.draw(of), view);
        const size = args.plain ? [newest.width, newest.height] : [width, height];
        found.push({ shown, view, exposure: newest.exposure, size });
    }
    return found;
}

async function measure(browser, address, move, folder) {
    const walk = await drive(address, move);
    const context = await browser.newContext({ bypassCSP: true }); // for pieces as data URLs
    const page = await context.newPage();
    await page.goto(`${address.origin}/page/${args.plain ? "view" : "warp"}.js`);
    await page.evaluate(start_camera, [...size, args.plain !== undefined]);
    const moments = await draw_moments(page, walk);
    const judge = await browser.newPage();
    const rendered = renderer(program, scene, size, folder);
    const found = [];
    for (const [k, { shown, view, exposure, size: own }] of moments.entries()) {
        const truth = await rendered(view, exposure);
        const against = (url, of) =>
            judge.evaluate(compare, {
                pieces: [{ url, x: 0, y: 0 }],
                size: of,
                truth,
                most: kOff,
            });
        const one = await against(shown, own);
        const other = await against(await rendered(view, exposure, 1), size);
        found.push({ ...one, floor_off: other.off });
        if (!args.pictures) continue;
        const name = path.join(args.pictures, `${move}-${k}`);
        await writeFile(`${name}.png`, Buffer.from(one.picture, "base64"));
        await writeFile(`${name}-true.png`, Buffer.from(truth.split(",")[1], "base64"));
    }
    const of = (name) => found.map((one) => one[name]);
    const moving = walk.frames.slice(1);
    return {
        move,
        psnr: mean(of("psnr")),
        least: Math.min(...of("psnr")),
        off: mean(of("off")),
        most: Math.max(...of("off")),
        floor: mean(of("floor_off")),
        detail: mean(of("detail")),
        frames: moving.length / walk.seconds,
        width: (100 * mean(moving.map((frame) => frame.width))) / width,
        "Mbit/s": (8e-6 * walk.bytes) / walk.seconds,
    };
}

const folder = await own_folder("camera-truth");
if (args.pictures) await mkdir(args.pictures, { recursive: true });
const print_row = row_printer();
for (const move of args.moves.split(",")) {
    const [server, address] = await start_server(program, scene);
    const browser = await start_browser(words);
    try {
        print_row(await measure(browser, address, move, folder));
    } finally {
        await browser.close();
        server.kill();
    }
}
