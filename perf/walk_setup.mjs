// What the measurements of a walk by Node.js begin with: the words of their command line, the server, a browser, a delay, rows of figures.
import { spawn } from "node:child_process";
import { mkdtemp } from "node:fs/promises";
import { createRequire } from "node:module";
import net from "node:net";
import os from "node:os";
import path from "node:path";
import { parseArgs } from "node:util";

/** For a scene's programs: where its files are found. */
export const environment = { ...process.env, RAYPATH: ".:../lib" };

const kWords = {
    npm: undefined,
    program: "build/release/lightwalk",
    folder: undefined,
    words: undefined,
    view: undefined,
    options: "-av .02 .02 .02",
    size: "1280x720",
    chromium: "/usr/bin/chromium",
};

/**
 * Read the command line: --npm FOLDER --folder SCENE --view FILE --words "a.rad b.rad" [--program lightwalk] [--options WORDS] [--size 1280x720]
 * [--chromium PROGRAM], and a measurement's own words.
 * @param own  their defaults by name, all text; undefined: there is none
 * @returns {{args, load, program, scene, size}}: args: all words; load: a package of --npm, by name; program: of --program;
 *     scene: {folder, view, options: [words], words: [scene's]}; size: [width, height]
 */
export function command_line(own) {
    const words = Object.entries({ ...kWords, ...own });
    const options = words.map(([name, value]) => [name, { type: "string", default: value }]);
    const { values: args } = parseArgs({ options: Object.fromEntries(options) });
    for (const name of ["npm", "folder", "words", "view"])
        if (args[name] === undefined) throw new Error(`--${name} is missing`);
    const { folder, view } = args;
    return {
        args,
        load: createRequire(path.resolve(args.npm, "none.js")),
        program: path.resolve(args.program),
        scene: { folder, view, options: args.options.split(" "), words: args.words.split(" ") },
        size: args.size.split("x").map(Number),
    };
}

/** Start a walk's server; returns its process and its address. */
export function start_server(program, { folder, view, options, words }) {
    const line = ["walk", "--port", "0", "--quiet", "-vf", view, ...options, ...words];
    const server = spawn(program, line, {
        cwd: folder,
        env: environment,
        stdio: ["ignore", "pipe", "inherit"],
    });
    return new Promise((resolve, reject) => {
        server.stdout.once("data", (text) => resolve([server, new URL(String(text).trim())]));
        server.once("error", reject);
        server.once("exit", () => reject(new Error("the server does not start")));
    });
}

/** Start headless Chromium, where WebGL2 is drawn by the processor. */
export const start_browser = ({ args, load }) =>
    load("playwright-core").chromium.launch({
        executablePath: args.chromium,
        args: [
            "--no-sandbox",
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
        ],
    });

/** Opens a port of this machine at which that of the server is a round trip of `ms` away; returns what close() ends. */
export function delayed(port, ms) {
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

/** Wait in a walk's page until its picture is of the present view and whole, and a moment more. */
export async function settled(page, moment = 2000) {
    const there = () => {
        const { ready, at_rest, shown_view_id, view_id } = window.lightwalk;
        return ready && at_rest && shown_view_id === view_id;
    };
    await page.waitForFunction(there, null, { timeout: 60000 });
    await page.waitForTimeout(moment);
}

/** A new folder for files of one run. */
export const own_folder = (name) => mkdtemp(path.join(os.tmpdir(), `${name}-`));

export const mean_of = (list) => list.reduce((sum, x) => sum + x, 0) / list.length;

/** The quantile `share` (0 to 1) of numbers; NaN of none. */
export const quantile = (list, share) =>
    list.toSorted((a, b) => a - b)[Math.floor(share * (list.length - 1))] ?? NaN;

/** Prints rows of figures, under their names before the first. */
export function row_printer() {
    let first = true;
    const text = (x) => (typeof x === "number" ? x.toPrecision(3) : x);
    return (row) => {
        if (first) console.log(Object.keys(row).join("\t"));
        first = false;
        console.log(Object.values(row).map(text).join("\t"));
    };
}
