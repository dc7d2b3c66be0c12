// Measures what the frames of a walk show while the eye moves: a client that needs no browser asks the real server for views as a page does,
// and each of some frames is compared with `lightwalk render` of its view, at the size that was asked for.
//
//     node perf/frame_truth.mjs --npm FOLDER --folder SCENE --view FILE [--words "a.rad b.rad"] [--programs lightwalk,other]
//         [--moves turn,walk] [--size 1280x720] [--seconds 6] [--samples 12] [--pictures FOLDER]
//
// FOLDER has node_modules with ws and playwright-core; the browser starts when the walk is over, and only compares. A move is a turn of
// 40 degrees a second, a look that way and back, a walk of 1.3 m/s (of an eye 1.6 m high) and back, or both. One line for each program and move:
//
//   psnr       of the frames, enlarged to the size asked for, against the rendered pictures, mean and least [dB]
//   off        pixels of which a channel is off by more than a tenth of white: mean and most [%]
//   floor      both of two rendered pictures with other random numbers, and so other places in their pixels: what no frame can better
//   detail     correlation of the gradients of both pictures, mean: 1 where all edges and textures are there
//   frames     a second; width: of the frames, share of what was asked for [%]; reused, inferred, guessed: as the server tells [%]
//   Mbit/s     of messages from the server
import { mkdir, readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { fit_view } from "../apps/viewer/view.js";
import { parse_views } from "../apps/viewer/view_text.js";
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
    programs: "build/release/lightwalk",
    moves: "turn,walk",
    seconds: "6",
    samples: "12",
    pictures: undefined,
});
const { args, load, scene, size } = words;
const [width, height] = size;
const kBegin = 1; // after which frames are judged [s]
const WebSocket = load("ws");

/** Drive a walk; returns the frames to be judged and what was counted. */
async function drive(program, move) {
    const [server, address] = await start_server(program, scene);
    try {
        const client = new Client(WebSocket, address, size);
        const { eye_height } = await client.loaded;
        const first = fit_view(
            parse_views(await readFile(path.join(args.folder, args.view), "utf8"))[0],
            width,
            height,
        );
        await stand(client, first);
        Object.assign(client, { frames: [], states: [], bytes: 0 });
        const begin = performance.now();
        const seconds = Number(args.seconds);
        for (let t = 0; t < seconds; t = (performance.now() - begin) / 1000) {
            client.look(moved(first, move, t, eye_height), true);
            await wait(1000 / 60);
        }
        client.socket.close();
        return { client, begin, seconds };
    } finally {
        server.kill();
    }
}

/** Of the frames of a walk those that are judged: evenly spaced, whole. */
function chosen({ frames }, begin) {
    const whole = frames.filter(
        ({ complete, at, pieces }) => complete && pieces.length > 0 && at > begin + 1000 * kBegin,
    );
    const count = Math.min(Number(args.samples), whole.length);
    return Array.from({ length: count }, (_, k) => whole[Math.floor((k * whole.length) / count)]);
}

async function measure(program, kind, move, folder) {
    const { client, begin, seconds } = await drive(program, move);
    const browser = await start_browser(words);
    const page = await browser.newPage();
    const rendered = renderer(program, scene, size, folder);
    const found = [];
    for (const [k, frame] of chosen(client, begin).entries()) {
        const view = client.views.get(frame.view_id);
        const truth = await rendered(view, frame.exposure);
        const pieces = frame.pieces.map(({ x, y, type, bytes }) => ({
            x,
            y,
            url: `data:${type};base64,${Buffer.from(bytes).toString("base64")}`,
        }));
        const one = await page.evaluate(compare, {
            pieces,
            size: [frame.width, frame.height],
            truth,
            most: kOff,
        });
        const other = await rendered(view, frame.exposure, 1);
        const whole = [{ x: 0, y: 0, url: other }];
        const floor = await page.evaluate(compare, {
            pieces: whole,
            size,
            truth,
            most: kOff,
        });
        found.push({ ...one, floor: floor.psnr, floor_off: floor.off });
        if (!args.pictures) continue;
        const name = path.join(args.pictures, `${kind}-${move}-${k}`);
        await writeFile(`${name}.png`, Buffer.from(one.picture, "base64"));
        await writeFile(`${name}-true.png`, Buffer.from(truth.split(",")[1], "base64"));
    }
    await browser.close();
    const of = (name) => found.map((one) => one[name]);
    const told = (name) => 100 * mean(client.states.map((state) => state[name]));
    return {
        program: kind,
        move,
        psnr: mean(of("psnr")),
        least: Math.min(...of("psnr")),
        off: mean(of("off")),
        most: Math.max(...of("off")),
        floor: mean(of("floor")),
        "floor off": mean(of("floor_off")),
        detail: mean(of("detail")),
        frames: client.frames.length / seconds,
        width: (100 * mean(client.frames.map((frame) => frame.width))) / width,
        reused: told("reuse"),
        inferred: told("inferred"),
        guessed: told("guessed"),
        "Mbit/s": (8e-6 * client.bytes) / seconds,
    };
}

const folder = await own_folder("frame-truth");
if (args.pictures) await mkdir(args.pictures, { recursive: true });
const print_row = row_printer();
for (const move of args.moves.split(","))
    for (const [k, program] of args.programs.split(",").entries())
        print_row(await measure(path.resolve(program), String(k), move, folder));
