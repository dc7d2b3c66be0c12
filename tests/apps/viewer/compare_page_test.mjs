// Two states of a walk that runs, side by side, in headless Chromium: other hours, another material, and their difference.
//
//     node compare_page_test.mjs --address URL --npm FOLDER --pictures FOLDER [--chromium PROGRAM]
//
// Writes compared.json: the light at points of both sides, [{side, hour, colour, luminance, illuminance, position, normal, eye}].
import assert from "node:assert/strict";
import { mkdir, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import { parseArgs } from "node:util";
import { difference_colour, difference_place } from "../../../apps/viewer/difference.js";

const { values: args } = parseArgs({
    options: {
        address: { type: "string" },
        npm: { type: "string" },
        pictures: { type: "string", default: "pictures" },
        chromium: { type: "string", default: "/usr/bin/chromium" },
    },
});
const kPatience = 60000;
const [width, height] = [640, 400];
const kJpeg = 6; // how far a byte of a picture may be off
const kFile = 14.3; // the hour of the scene's file

const { chromium } = createRequire(path.resolve(args.npm, "none.js"))("playwright-core");
await mkdir(args.pictures, { recursive: true });
const browser = await chromium.launch({ executablePath: args.chromium, args: ["--no-sandbox"] });
const page = await browser.newPage({ viewport: { width, height }, reducedMotion: "reduce" });
const wait = (test, argument) => page.waitForFunction(test, argument, { timeout: kPatience });
const save = (name) => page.screenshot({ path: path.join(args.pictures, `${name}.png`) });

/** Until both pictures are as good as they get; after a change that is some frames from now. */
async function both_final() {
    await page.waitForTimeout(500);
    await wait(() => window.lightwalk.final && window.lightwalk.beside.final);
    await page.waitForTimeout(1500); // exposure adapts
}

/** Bytes r, g, b at a place of a canvas, or of the screen; shares from the left and the top. */
async function colour_at(where, x, y) {
    const clip = { x: Math.round(x * width), y: Math.round(y * height), width: 1, height: 1 };
    const url =
        where === "screen"
            ? `data:image/png;base64,${(await page.screenshot({ clip })).toString("base64")}`
            : "";
    return page.evaluate(
        async ([selector, place, source]) => {
            let from = document.querySelector(selector);
            if (source) {
                from = new Image();
                from.src = source;
                await from.decode();
            }
            const canvas = document.createElement("canvas");
            const context = canvas.getContext("2d");
            context.drawImage(from, source ? 0 : place.x, source ? 0 : place.y, 1, 1, 0, 0, 1, 1);
            return Array.from(context.getImageData(0, 0, 1, 1).data).slice(0, 3);
        },
        [where === "screen" ? "#stage" : where, clip, url],
    );
}
const near = (a, b) => a.every((value, k) => Math.abs(value - b[k]) <= kJpeg);

const kRead = [];
/** Read the light where a side is seen. */
async function read(side, hour, colour, x, y) {
    await page.waitForTimeout(500); // else two clicks may be a double click
    await page.evaluate(() => (window.lightwalk.last_pick = null));
    await page.mouse.click(x * width, y * height);
    await wait(() => window.lightwalk.last_pick);
    const { last_pick: pick, shown_view } = await page.evaluate(() => {
        const { last_pick, shown_view } = window.lightwalk;
        return { last_pick, shown_view };
    });
    assert.ok(pick.hit);
    assert.match(await page.textContent("#reading"), new RegExp(`cd/m².* · ${side}`));
    const { luminance, illuminance, position, normal } = pick;
    const one = { side, hour, colour, luminance, illuminance, position, normal };
    kRead.push({ ...one, eye: shown_view.position });
    await page.keyboard.press("Escape");
    return one;
}

async function set_hour(side, hour) {
    await page.check(`[name=side][value=${side}]`, { force: true });
    await page.focus("#picture");
    if (await page.isHidden("#panel-time")) await page.keyboard.press("0");
    await page.fill("#time-hour", String(60 * hour));
    await wait(
        ([s, words]) => document.querySelector(s).textContent.startsWith(words),
        [`#side-${side.toLowerCase()}`, `${side} · ${hour}:00`],
    );
    await page.keyboard.press("Escape");
    await page.focus("#picture");
    await both_final();
}

const kGrey = [0.5, 0.5, 0.5],
    kGreen = [0.2, 0.6, 0.3];
const steps = {
    async "what has just been opened is the same on both sides"() {
        await page.goto(args.address);
        await wait(() => window.lightwalk?.ready && window.lightwalk.frames > 0);
        await page.focus("#picture");
        await page.keyboard.press(".");
        await wait(() => window.lightwalk.beside?.frames > 0);
        await both_final();
        await page.keyboard.press(",");
        await page.waitForSelector("#difference-legend:not([hidden])");
        await page.waitForTimeout(1500);
        const none = difference_colour(0);
        for (const [x, y] of [
            [0.6, 0.7],
            [0.8, 0.45],
            [0.95, 0.9],
        ])
            assert.ok(near(await colour_at("screen", x, y), none), `a difference at ${x}, ${y}`);
        await page.keyboard.press(",");
        await both_final();
    },

    async "each side has its own hour"() {
        await set_hour("B", 10);
        await read("A", kFile, kGrey, 0.2, 0.8);
        await read("B", 10, kGrey, 0.8, 0.8);
        await set_hour("A", 17);
        await read("A", 17, kGrey, 0.2, 0.8);
        await read("B", 10, kGrey, 0.8, 0.8);
    },

    async "what is left of the divider is A's picture, what is right of it B's"() {
        await page.mouse.move(0.5 * width, 0.3 * height);
        await page.mouse.down();
        await page.mouse.move(0.3 * width, 0.3 * height, { steps: 5 });
        await page.mouse.up();
        assert.equal(await page.getAttribute("#divider", "aria-valuenow"), "30");
        for (const [x, y] of [
            [0.1, 0.85],
            [0.22, 0.75],
            [0.4, 0.85],
            [0.75, 0.75],
        ]) {
            const seen = await colour_at("screen", x, y);
            const of = [await colour_at("#picture", x, y), await colour_at("#picture-b", x, y)];
            assert.ok(!near(of[0], of[1]), `both sides are the same at ${x}, ${y}`);
            assert.ok(
                near(seen, of[x < 0.3 ? 0 : 1]),
                `${seen} at ${x}, ${y}, of ${of.join("; ")}`,
            );
        }
    },

    async "a surface that is clicked on the right changes there"() {
        await page.focus("#picture");
        await page.keyboard.press("y");
        await page.waitForTimeout(500); // else it may be the second one of a double click
        await page.mouse.click(0.8 * width, 0.8 * height);
        await page.waitForSelector("#material-layers .layer");
        assert.equal(await page.isChecked("[name=side][value=B]"), true);
        for (const [k, number] of kGreen.entries()) {
            const box = page.locator(`#material-layers .layer:first-child [data-number="${k}"]`);
            await box.fill(String(number));
            await box.press("Enter");
        }
        await wait(() => document.querySelector("#side-b").textContent.includes("1 material"));
        await page.focus("#picture"); // the panel's rows are made anew, and the focus goes with them
        await page.keyboard.press("Escape");
        await wait(() => document.querySelector("#panel-materials").hidden);
        await both_final();
        await read("B", 10, kGreen, 0.8, 0.8);
        await read("A", 17, kGrey, 0.2, 0.8);
    },

    async "the difference is that of the luminances"() {
        const b = await read("B", 10, kGreen, 0.6, 0.85);
        await page.focus("#divider");
        await page.keyboard.press("End");
        const a = await read("A", 17, kGrey, 0.6, 0.85);
        assert.deepEqual(a.position, b.position);
        await page.focus("#divider");
        await page.keyboard.press("Home");
        await page.keyboard.press(",");
        await both_final();
        const expected = difference_colour(difference_place(a.luminance, b.luminance));
        const seen = await colour_at("screen", 0.6, 0.85);
        assert.ok(near(seen, expected), `${seen} in place of ${expected}`);
        await save("difference");
        await page.keyboard.press(",");
    },

    async "while the eye moves both sides do, and then the walk is alone again"() {
        for (let k = 0; k < 10; ++k) await page.keyboard.press("ArrowRight", { shift: true });
        await page.focus("#picture");
        const before = await page.evaluate(() => [
            window.lightwalk.frames,
            window.lightwalk.beside.frames,
        ]);
        await page.keyboard.down("ArrowRight");
        await page.waitForTimeout(1500);
        await save("moving");
        await page.keyboard.up("ArrowRight");
        await both_final();
        const [a, b] = await page.evaluate(() => [
            window.lightwalk.frames,
            window.lightwalk.beside.frames,
        ]);
        console.log(`frames while the eye turned: ${a - before[0]} and ${b - before[1]}`);
        assert.ok(a > before[0] + 3 && b > before[1] + 3);
        await page.keyboard.press(".");
        await wait(() => window.lightwalk.beside === null);
        assert.ok(await page.isHidden("#divider"));
    },
};

const complaints = [];
page.on("pageerror", (error) => complaints.push(String(error)));
page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
try {
    for (const [name, step] of Object.entries(steps)) {
        try {
            await step();
        } catch (error) {
            error.message = `${name}: ${error.message}`;
            throw error;
        } finally {
            await save(name.replaceAll(/\W+/g, "-"));
        }
        console.log(`ok: ${name}`);
    }
    assert.deepEqual(complaints, [], "the browser complained");
    await writeFile(path.join(args.pictures, "compared.json"), JSON.stringify(kRead));
} finally {
    await browser.close();
}
