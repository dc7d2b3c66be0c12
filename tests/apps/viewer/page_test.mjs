// The page in headless Chromium against the fake server, which can be told to misbehave:
//
//     node page_test.mjs --npm FOLDER [--pictures FOLDER] [--chromium PROGRAM] [--port N]
//         [--only WORDS]
//
// FOLDER has node_modules with ws, jpeg-js and playwright-core. --only: the steps whose names have these words. Without
// --npm there is nothing to do.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdir, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { parse_views } from "../../../apps/viewer/view_text.js";
import { access_steps } from "./page_access.mjs";
import { colour_steps } from "./page_colours.mjs";
import { compare_steps } from "./page_compare.mjs";
import {
    gone,
    heading,
    hold,
    kSize,
    mean_over_area,
    saved_text,
    shown,
    speed_of,
    touch,
    until,
    value,
} from "./page_helpers.mjs";
import { camera_steps } from "./page_camera.mjs";
import { eye_steps } from "./page_eye.mjs";
import { file_steps } from "./page_files.mjs";
import { interruption_steps } from "./page_interrupted.mjs";
import { isolux_steps } from "./page_isolux.mjs";
import { lamp_steps } from "./page_lamps.mjs";
import { material_steps } from "./page_materials.mjs";
import { place_steps } from "./page_places.mjs";
import { time_steps } from "./page_time.mjs";

const { values: args } = parseArgs({
    options: {
        npm: { type: "string" },
        pictures: { type: "string" },
        only: { type: "string", default: "" },
        chromium: { type: "string", default: "/usr/bin/chromium" },
        port: { type: "string", default: "0" },
    },
});
const [server, address] = args.npm ? await start_server() : [];

const prank = (name) => fetch(`${address}fake/${name}`);
const steps = {
    ...camera_steps(),
    ...place_steps(address),
    ...colour_steps(address, prank),
    ...isolux_steps(prank, args.npm),
    ...lamp_steps(address),
    ...material_steps(address, args.npm),
    ...time_steps(address),
    ...file_steps(prank, args.npm),
    ...interruption_steps(address, prank),
    async "all keys move as the help says"(page) {
        await page.keyboard.press("2");
        await page.waitForTimeout(100);
        await shown(page);
        assert.ok((await hold(page, "w")) > 0.2);
        assert.ok((await hold(page, "a")) > 0.2);
        const plain = await speed_of(page, ["d"]);
        assert.ok((await speed_of(page, ["Shift", "a"])) > 1.5 * plain);
        const before = heading(await value(page, "view"));
        assert.ok((await hold(page, "ArrowRight")) < 1e-9);
        assert.ok(heading(await value(page, "view")) > before + 5);
        assert.ok((await value(page, "view")).position[2] === 1.6);
        assert.ok((await hold(page, "e")) > 0.2);
        assert.equal(await value(page, "walking"), false);
        assert.equal(await page.textContent("#walk span"), "Fly");
        await page.keyboard.press("g");
        await until(page, () => Math.abs(window.lightwalk.shown_view?.position[2] - 1.6) < 1e-9);
    },

    async "a jump is undone"(page) {
        const before = await value(page, "shown_view");
        await page.keyboard.press("3");
        await page.waitForTimeout(100);
        await shown(page);
        assert.ok(gone(before, await value(page, "shown_view")) > 0.5);
        await page.keyboard.press("Backspace");
        await page.waitForTimeout(100);
        await shown(page);
        assert.ok(gone(before, await value(page, "shown_view")) < 1e-6);
    },

    async "the wheel changes the speed, with Ctrl the lens"(page) {
        await page.mouse.move(400, 250);
        await page.mouse.wheel(0, -300);
        await page.waitForSelector("#notice >> text=m/s");
        const before = (await value(page, "view")).horizontal;
        await page.keyboard.down("Control");
        await page.mouse.wheel(0, 120);
        await page.keyboard.up("Control");
        await until(page, (h) => window.lightwalk.view.horizontal > h + 1, before);
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
    },

    async "one finger looks, two move and zoom, a tap reads"(page) {
        const start = await value(page, "view");
        await touch(page, [[[400, 250]], [[430, 250]], [[520, 250]]]);
        const looked = await value(page, "view");
        assert.ok(heading(looked) < heading(start) - 5 && gone(start, looked) < 1e-6);
        const two = (y, d) => [
            [400 - d, y],
            [400 + d, y],
        ];
        await touch(page, [two(250, 60), two(200, 60), two(150, 60)]);
        const moved = await value(page, "view");
        assert.ok(gone(looked, moved) > 0.1);
        await touch(page, [two(250, 60), two(250, 80), two(250, 120)]);
        assert.ok((await value(page, "view")).horizontal < moved.horizontal - 5);
        await page.evaluate(() => (window.lightwalk.last_pick = null));
        await touch(page, [[[300, 200]]]);
        await until(page, () => window.lightwalk.last_pick?.hit);
        await page.keyboard.press("Escape");
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
    },

    async "pins stand where they were put, and follow the light"(page) {
        await page.mouse.click(240, 250);
        await page.waitForSelector("#pin");
        const reading = (await page.textContent("#reading")).replaceAll("\u202f", " ");
        assert.match(reading, /cd\/m² ± <1 %/);
        assert.match(reading, /Illuminance[\d. ]+ lx ± 3 %/);
        await page.keyboard.press("p");
        await page.keyboard.press("m");
        const height = () => document.querySelector("#measured tr")?.offsetHeight;
        const first = await (await until(page, height)).jsonValue();
        await until(page, () => window.lightwalk.last_probes?.settled === 1);
        const pin = (await page.textContent("#measured tr")).replaceAll("\u202f", " ");
        assert.match(pin, /± 3 %\d/, pin); // of illuminance, and none of luminance
        assert.equal(await page.evaluate(height), first);
        await page.keyboard.press("m");
        await until(page, () =>
            /^P1 .* lx ±.3.%$/.test(document.querySelector("#overlay text")?.textContent),
        );
        // Marks are made anew at refreshes: asked for and measured in one.
        const place = await until(page, () => {
            const mark = document.querySelector("#overlay .pin");
            return mark && mark.getBoundingClientRect().toJSON();
        });
        const at = await place.jsonValue();
        assert.ok(
            Math.abs(at.x + at.width / 2 - 240) < 2 && Math.abs(at.y + at.height / 2 - 250) < 2,
        );
        // A drag turns by as many pixels on any machine; a key held on a busy one turns the pin out of sight.
        await page.mouse.move(400, 400);
        await page.mouse.down();
        await page.mouse.move(460, 400, { steps: 3 });
        await page.mouse.up();
        await shown(page);
        // Marks are drawn in the refresh after: one that sticks to the screen never comes there.
        await until(
            page,
            (x) => document.querySelector("#overlay .pin")?.getBoundingClientRect().x > x + 10,
            at.x,
        );
    },

    async "a mean over an area is listed"(page) {
        const before = await page.locator("#measured tr").count();
        await mean_over_area(page);
        await until(
            page,
            (n) => document.querySelectorAll("#measured tr").length === n + 1,
            before,
        );
        assert.equal(await page.getAttribute("#area", "aria-pressed"), "false");
        const area = (await page.textContent("#measured tr:last-child")).replaceAll("\u202f", " ");
        assert.match(area, /[\d.]+± 2 %/);
    },

    async "files hold what is seen"(page) {
        if ((await page.locator("#measured tr").count()) < 2) {
            await page.mouse.click(240, 250);
            await page.waitForSelector("#pin");
            await page.keyboard.press("p");
            await mean_over_area(page);
        }
        if (!(await page.isVisible("#write-table"))) await page.keyboard.press("m");
        const table = String((await saved_text(page, "#write-table")).bytes)
            .trimEnd()
            .split("\r\n");
        assert.equal(table.length, 3);
        assert.match(table[1], /^probe,P1,/);
        assert.match(table[2], /^mean,A1,/);
        await page.click("[data-panel=save]");
        const png = await saved_text(page, "#write-png");
        assert.equal(png.bytes.readUInt32BE(0), 0x89504e47);
        assert.deepEqual([png.bytes.readUInt32BE(16), png.bytes.readUInt32BE(20)], [800, 500]);
        await page.check("#caption");
        const captioned = (await saved_text(page, "#write-png")).bytes;
        assert.equal(captioned.readUInt32BE(16), 800);
        assert.ok(captioned.readUInt32BE(20) > 530 && captioned.readUInt32BE(20) < 620);
        if (args.pictures) await writeFile(path.join(args.pictures, "captioned.png"), captioned);
        await page.uncheck("#caption");
        assert.match(String((await saved_text(page, "#write-hdr")).bytes), /^#\?RADIANCE\n/);
        const [view] = parse_views(String((await saved_text(page, "#write-view-too")).bytes));
        const sent = await value(page, "view");
        assert.ok(gone(view, sent) < 1e-6 && Math.abs(view.vertical - sent.vertical) < 1e-3);
        await page.keyboard.press("k");
        await hold(page, "ArrowLeft");
        await page.keyboard.press("k");
        const keys = parse_views(String((await saved_text(page, "#write-path-too")).bytes));
        assert.equal(keys.length, 2);
        await page.keyboard.press("Escape");
    },

    async "exposure is fixed where it stood, and steps by half a stop"(page) {
        await page.keyboard.press("x");
        await until(page, () => window.lightwalk.frames > 0);
        await page.waitForTimeout(300);
        const before = await value(page, "exposure");
        await page.keyboard.press("+");
        await until(
            page,
            (x) => Math.abs(window.lightwalk.exposure / x - Math.SQRT2) < 0.05,
            before,
        );
        await page.keyboard.press("x");
    },

    async "a scale that makes no sense is not sent"(page) {
        await page.keyboard.press("f");
        await page.keyboard.press("l");
        await page.fill("#low", "0");
        await page.keyboard.press("Tab");
        await page.waitForSelector("#scale-problem:not([hidden])");
        await page.fill("#low", "0,5");
        await page.keyboard.press("Tab");
        await page.waitForSelector("#scale-problem", { state: "hidden" });
        assert.match(await page.getAttribute("#legend-bar", "aria-label"), /from 0.5 to/);
        await page.keyboard.press("Escape");
        await page.keyboard.press("f");
    },

    async "glare is outlined until the eye moves"(page) {
        await page.keyboard.press("l");
        await page.click("#ask-glare");
        await page.waitForSelector("#overlay .source");
        assert.match(await page.textContent("#glare"), /DGP 0\.37±\u202f0\.01 · perceptible/);
        await page.focus("#picture");
        await page.keyboard.press("ArrowLeft", { delay: 100 });
        await page.waitForSelector("#overlay .source", { state: "detached" });
        await page.keyboard.press("l");
    },

    async "a scene's errors are shown, and go when it can be read"(page) {
        await prank("fail");
        await page.waitForSelector("text=room/materials.rad:12:");
        await prank("reload");
        await page.waitForSelector("#failure", { state: "hidden" });
        await shown(page);
    },

    async "a watcher watches, and takes over when nobody drives"(page) {
        await begin_anew(page); // one whose line broke within half a minute takes over by itself
        await prank("steal");
        await page.waitForSelector("text=Watching");
        const before = await value(page, "view_id"); // one may still have been on its way
        await page.focus("#picture");
        await page.keyboard.press("w", { delay: 200 });
        assert.equal(await value(page, "view_id"), before);
        await page.mouse.move(300, 300);
        await page.click("[data-panel=save]");
        const png = (await saved_text(page, "#write-png")).bytes;
        assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [800, 500]);
        assert.match(String((await saved_text(page, "#write-hdr")).bytes), /^#\?RADIANCE\n/);
        await page.click("[data-panel=save]");
        assert.ok(await page.isDisabled("#take"));
        await prank("leave");
        await page.click("#take");
        await until(page, () => window.lightwalk.driving);
        await page.focus("#picture");
        assert.ok((await hold(page, "s")) > 0.1);
    },

    async "the driver hands over to who is chosen"(page) {
        await prank("join");
        await page.selectOption("#hand-to", { label: "Viewer 77" });
        await until(page, () => !window.lightwalk.driving);
        await prank("leave");
        await page.click("#take");
        await until(page, () => window.lightwalk.driving);
    },

    async "a line that breaks is made again, and the walk goes on where it stood"(page) {
        const before = await value(page, "view");
        await prank("drop");
        await until(page, () => !window.lightwalk.connected);
        assert.match(await page.textContent("#cover"), /lost/);
        await until(page, () => window.lightwalk.connected && window.lightwalk.driving);
        await shown(page);
        assert.ok(gone(before, await value(page, "view")) < 1e-6);
        assert.ok((await hold(page, "w")) > 0.1);
    },

    async "what lies over the picture fades, and comes back for the keyboard"(page) {
        const opacity = () =>
            page.evaluate(() => getComputedStyle(document.querySelector("#dock")).opacity);
        await page.mouse.move(400, 100);
        await page.focus("#picture");
        await until(page, () => getComputedStyle(document.querySelector("#dock")).opacity === "0");
        await page.keyboard.press("Tab");
        await page.waitForTimeout(500);
        assert.equal(await opacity(), "1");
    },

    async "the window's size is the picture's"(page) {
        await page.setViewportSize({ width: 640, height: 700 });
        await until(page, () => {
            const canvas = document.querySelector("#picture");
            return canvas.width === 640 && canvas.height === 700;
        });
        await shown(page);
        await page.setViewportSize(kSize);
        // The frame that is there is narrower than the window: turning would show its borders.
        await until(page, () => document.querySelector("#picture").width === 800);
        await shown(page);
    },

    ...eye_steps(address),

    ...compare_steps(address, args.npm, prank),

    ...access_steps(address, args.npm),
};

async function start_server() {
    const program = path.join(path.dirname(fileURLToPath(import.meta.url)), "fake_server.mjs");
    const server = spawn(process.execPath, [program, "--npm", args.npm, "--port", args.port], {
        stdio: ["ignore", "pipe", "inherit"],
    });
    const said = await new Promise((resolve) => server.stdout.once("data", resolve));
    return [server, String(said).trim()];
}

/** What a step that failed leaves behind must not spoil the next: nothing is held, and a new page has the drive. */
async function begin_anew(page) {
    for (const key of ["w", "a", "s", "d", "e", "ArrowLeft", "ArrowRight", "PageDown", "Shift"])
        await page.keyboard.up(key);
    await page.mouse.up();
    for (const name of ["speak", "leave"]) await prank(name);
    await page.evaluate(() => localStorage.clear());
    await page.goto("about:blank"); // another hash alone would not load the page
    await page.goto(address);
    await shown(page);
}

async function passes(page, name, step) {
    const start = Date.now();
    try {
        await step(page);
        console.log(`ok: ${name} (${((Date.now() - start) / 1000).toFixed(1)} s)`);
        return true;
    } catch (error) {
        console.log(`FAILED: ${name}\n${error.stack}`);
        if (args.pictures) {
            const file = `failed-${name.replaceAll(/\W+/g, "-")}.png`;
            await page.screenshot({ path: path.join(args.pictures, file) });
        }
        await begin_anew(page);
        return false;
    }
}

async function run() {
    const { chromium } = createRequire(path.resolve(args.npm, "none.js"))("playwright-core");
    if (args.pictures) await mkdir(args.pictures, { recursive: true });
    const browser = await chromium.launch({
        executablePath: args.chromium,
        args: ["--no-sandbox"],
    });
    const page = await browser.newPage({
        viewport: kSize,
        hasTouch: true,
        reducedMotion: "reduce", // what fades takes its time, which no step is about
    });
    // Every other refresh: here it is the processor that runs the page's shaders.
    await page.addInitScript(() => {
        const refreshed = window.requestAnimationFrame.bind(window);
        window.requestAnimationFrame = (draw) => refreshed(() => refreshed(draw));
    });
    page.setDefaultTimeout(20000);
    const complaints = [];
    page.on("pageerror", (error) => complaints.push(String(error.stack)));
    page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
    let failed = 0;
    try {
        await page.goto(address);
        await shown(page);
        for (const [name, step] of Object.entries(steps)) {
            if (!name.includes(args.only)) continue;
            // Once more where it failed: a machine that stands still for a second is no fault of the page.
            const good = (await passes(page, name, step)) || (await passes(page, name, step));
            if (!good) ++failed;
        }
    } finally {
        await browser.close();
        server.kill();
    }
    assert.deepEqual(complaints, [], "the browser complained");
    assert.equal(failed, 0, `${failed} steps failed`);
}

if (args.npm) await run();
else console.log("page_test: no --npm, nothing to test");
