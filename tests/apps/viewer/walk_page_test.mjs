// The page as a designer uses it, in headless Chromium, against a server that runs already:
//
//     node walk_page_test.mjs --address URL --npm FOLDER --pictures FOLDER --luminance L
//         [--at X,Y] [--view N] [--chromium PROGRAM]
//
// Loads, waits for the first picture, turns, walks, clicks a surface of known luminance L [cd/m2] at
// X,Y (0..1 from the left and the bottom, seen from view N of the scene) and reads it within 2 %,
// switches false colour, saves a view, reloads and returns to it, records a path to path.vf, opens the plan, saves the isolux of the floor as isolux.csv and
// isolux.pts, changes the floor's material and saves it as materials.rad (what it reads then goes to edited.json), and where the walk has
// light groups dims them: what it reads then goes to dimmed.json, beside lights.rad. A screenshot of each
// step, and these files, go to --pictures. FOLDER has node_modules with playwright-core. Without --address there is nothing to do.
import assert from "node:assert/strict";
import { mkdir, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import { parseArgs } from "node:util";
import { axe_complaints } from "./axe.mjs";

const { values: args } = parseArgs({
    options: {
        address: { type: "string" },
        npm: { type: "string" },
        pictures: { type: "string", default: "pictures" },
        luminance: { type: "string" },
        at: { type: "string", default: "0.5,0.5" },
        view: { type: "string", default: "1" },
        chromium: { type: "string", default: "/usr/bin/chromium" },
        width: { type: "string", default: "960" },
        height: { type: "string", default: "600" },
        patience: { type: "string", default: "120" },
    },
});

const kPatience = Number(args.patience) * 1000; // for a picture to come [ms]
const kSettling = 20000; // for it to get no better [ms]
const width = Number(args.width),
    height = Number(args.height);

/** Values of window.lightwalk. */
const counters = (page, ...names) =>
    page.evaluate(
        (wanted) => Object.fromEntries(wanted.map((name) => [name, window.lightwalk[name]])),
        names,
    );

/** Until the screen shows the newest view, whole. */
const shown = (page) =>
    page.waitForFunction(
        () => {
            const l = window.lightwalk;
            return l.ready && !l.moving && l.frames > 0 && l.shown_view_id === l.view_id;
        },
        null,
        { timeout: kPatience },
    );

/** The same, and a while for the light to settle, which makes the screenshots better. */
async function settled(page) {
    await shown(page);
    await page
        .waitForFunction(() => window.lightwalk.final, null, { timeout: kSettling })
        .catch(() => {});
}

/** A number that tells one picture from another. */
const fingerprint = (page) =>
    page.evaluate(() => {
        const canvas = document.querySelector("#picture");
        const small = Object.assign(document.createElement("canvas"), { width: 64, height: 40 });
        const context = small.getContext("2d");
        context.drawImage(canvas, 0, 0, 64, 40);
        return Array.from(context.getImageData(0, 0, 64, 40).data);
    });

/** Mean difference of two fingerprints [0..255]. */
const difference = (a, b) => a.reduce((sum, x, k) => sum + Math.abs(x - b[k]), 0) / a.length;

/** How far two views' axes differ [degrees]. */
function turn_between(a, b) {
    const dot = (p, q) => p.reduce((sum, x, k) => sum + x * q[k], 0);
    const cosine =
        dot(a.direction, b.direction) /
        Math.sqrt(dot(a.direction, a.direction) * dot(b.direction, b.direction));
    return (Math.acos(Math.min(1, cosine)) * 180) / Math.PI;
}
/**
 * Hold a key until the eye has gone so far, however few frames a busy machine draws meanwhile. The views that are sent in motion
 * run ahead of the eye, the farther the slower frames come.
 */
async function hold(page, key, { metres = 0, degrees = 0 }) {
    const { eye: before } = await counters(page, "eye");
    await page.keyboard.down(key);
    const deadline = Date.now() + kPatience;
    let now = before;
    while (distance_between(before, now) < metres || turn_between(before, now) < degrees) {
        assert.ok(Date.now() < deadline, `${key} does not move the eye`);
        await page.waitForTimeout(50);
        now = (await counters(page, "eye")).eye;
    }
    await page.keyboard.up(key);
    await shown(page);
}

const distance_between = (a, b) => Math.hypot(...a.position.map((x, k) => x - b.position[k]));

const steps = {
    async "the first picture"(page) {
        await page.goto(args.address);
        await shown(page);
        const { frames, connected, driving } = await counters(
            page,
            "frames",
            "connected",
            "driving",
        );
        assert.ok(frames > 0 && connected && driving);
        await page.waitForSelector("#cover.gone", { state: "attached", timeout: 5000 });
        const picture = await fingerprint(page);
        assert.ok(Math.max(...picture.filter((_, k) => k % 4 !== 3)) > 30, "the picture is black");
    },

    async turn(page) {
        const [before, view] = [await fingerprint(page), (await counters(page, "view")).view];
        await page.mouse.move(width / 2, height / 2);
        await page.mouse.down();
        for (let k = 1; k <= 12; ++k) await page.mouse.move(width / 2 + 20 * k, height / 2 + 2 * k);
        await page.mouse.up();
        await shown(page);
        const turned = (await counters(page, "view")).view;
        assert.ok(turn_between(view, turned) > 5, "the drag did not turn");
        assert.ok(distance_between(view, turned) < 0.05, "the drag moved the eye");
        assert.ok(difference(before, await fingerprint(page)) > 1, "the picture did not follow");
    },

    async walk(page) {
        const [before, view] = [await fingerprint(page), (await counters(page, "view")).view];
        await page.focus("#picture");
        await hold(page, "w", { metres: 0.6 });
        const { view: walked, latency } = await counters(page, "view", "latency");
        assert.ok(distance_between(view, walked) < 20, "W does not stop");
        assert.ok(turn_between(view, walked) < 0.01, "W turned the eye");
        assert.ok(difference(before, await fingerprint(page)) > 1, "the picture did not follow");
        assert.ok(latency.length > 5 && latency.every((ms) => ms >= 0));
    },

    async "read a known luminance"(page) {
        await page.keyboard.press(args.view);
        await page.waitForTimeout(300);
        await shown(page);
        const [x, y] = args.at.split(",").map(Number);
        await page.mouse.click(x * width, (1 - y) * height);
        await page.waitForFunction(() => window.lightwalk.last_pick, null, { timeout: 10000 });
        const { last_pick: pick } = await counters(page, "last_pick");
        const expected = Number(args.luminance);
        assert.ok(pick.hit, "nothing there");
        assert.ok(
            Math.abs(pick.luminance / expected - 1) < 0.02,
            `${pick.luminance} cd/m2 instead of ${expected}`,
        );
        const words = await page.textContent("#reading");
        assert.match(words, /cd\/m²/);
        assert.ok(words.includes(pick.material) && words.includes(pick.surface));
    },

    async "false colour"(page) {
        const before = await fingerprint(page);
        await page.keyboard.press("f");
        await page.waitForFunction(() => !document.querySelector("#legend").hidden);
        await page.waitForTimeout(500);
        await settled(page);
        assert.ok(difference(before, await fingerprint(page)) > 10, "the colours did not change");
        assert.ok(
            (await page.locator("#legend-bar text").count()) >= 2,
            "the scale has no numbers",
        );
    },

    async "save a view"(page) {
        await hold(page, "ArrowRight", { degrees: 5 });
        await page.keyboard.press("v");
        await page.click("#save-view");
        await page.keyboard.type("where I was");
        await page.keyboard.press("Enter");
        await page.waitForSelector("text=where I was");
    },

    async "reload and return"(page) {
        const { view: saved } = await counters(page, "view");
        await page.focus("#picture");
        await page.keyboard.press("h");
        await page.waitForTimeout(200);
        await shown(page);
        assert.ok(
            turn_between(saved, (await counters(page, "view")).view) > 2,
            "home is where we were",
        );
        await page.reload();
        await shown(page);
        await page.keyboard.press("v");
        await page.click("text=where I was");
        await page.waitForTimeout(200);
        await shown(page);
        const { view: back } = await counters(page, "view");
        assert.ok(
            turn_between(saved, back) < 0.01 && distance_between(saved, back) < 0.01,
            "not where we were",
        );
    },

    async "axe finds nothing wrong"(page) {
        const complaints = await axe_complaints(page, args.npm);
        if (complaints === null) return console.log("skipped: no axe-core");
        assert.deepEqual(complaints, []);
    },

    async "record a path and save it"(page) {
        await page.focus("#picture");
        await page.keyboard.press("j");
        await hold(page, "ArrowLeft", { degrees: 3 });
        await hold(page, "s", { metres: 0.2 });
        await page.keyboard.press("j");
        const [file] = await Promise.all([
            page.waitForEvent("download"),
            page.click("#write-path"),
        ]);
        await file.saveAs(path.join(args.pictures, "path.vf"));
    },

    async "the plan shows something, and the eye in it"(page) {
        await page.focus("#picture");
        await page.keyboard.press("n");
        await page.waitForSelector("#plan-marks .eye", { timeout: kPatience });
        const inks = await page.evaluate(() => {
            const canvas = document.querySelector("#plan-picture");
            const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            return new Set(new Uint32Array(pixels.data.buffer)).size;
        });
        assert.ok(inks > 1, "the plan is empty");
        assert.match(await page.getAttribute("#plan", "aria-label"), /^The eye is .* facing /);
    },

    async "isolux on the floor, and their files"(page) {
        await page.focus("#picture");
        await page.keyboard.press("h");
        await page.waitForTimeout(200);
        await shown(page);
        await page.keyboard.press("m");
        await page.click("#isolux-surface");
        await page.mouse.click(0.3 * width, 0.85 * height);
        await page.waitForFunction(() => window.lightwalk.last_isolux?.done === 1, null, {
            timeout: kPatience,
        });
        await page.waitForSelector("#overlay .contour", { state: "attached" });
        assert.match(await page.textContent("#isolux-text"), /Final\.$/);
        assert.match(await page.textContent("#isolux-figures"), /Mean[\d. \u202f]+ lx/);
        for (const [button, name] of [
            ["#write-isolux", "isolux.csv"],
            ["#write-points", "isolux.pts"],
        ]) {
            const [file] = await Promise.all([page.waitForEvent("download"), page.click(button)]);
            await file.saveAs(path.join(args.pictures, name));
        }
    },

    async "change the floor's material, and read its light"(page) {
        await page.focus("#picture");
        await page.keyboard.press("h");
        await page.waitForTimeout(200);
        await settled(page);
        const [x, y] = [0.5 * width, 0.85 * height];
        await page.keyboard.press("y");
        await page.mouse.click(x, y);
        await page.waitForFunction(() => window.lightwalk.last_material, null, { timeout: 10000 });
        const { last_material: material } = await counters(page, "last_material");
        assert.equal(material.layers[0].kind, "plastic");
        const before = await fingerprint(page);
        for (const [k, value] of [0.7, 0.2, 0.1].entries()) {
            const box = page.locator(`#material-layers .layer:first-child [data-number="${k}"]`);
            await box.fill(String(value));
            await box.press("Enter");
        }
        await page.waitForFunction(
            () => window.lightwalk.last_edited?.materials[0]?.reals[2] === 0.1,
            null,
            { timeout: 10000 },
        );
        await page.waitForTimeout(300);
        await settled(page);
        assert.ok(difference(before, await fingerprint(page)) > 3, "the colours did not change");
        await page.evaluate(() => (window.lightwalk.last_pick = null));
        await page.mouse.click(x, y);
        await page.waitForFunction(() => window.lightwalk.last_pick, null, { timeout: 10000 });
        const { last_pick, shown_view } = await counters(page, "last_pick", "shown_view");
        const [file] = await Promise.all([
            page.waitForEvent("download"),
            page.click("#write-materials"),
        ]);
        await file.saveAs(path.join(args.pictures, "materials.rad"));
        const read = { ...last_pick, eye: shown_view.position };
        await writeFile(path.join(args.pictures, "edited.json"), JSON.stringify(read));
        await page.click("#material-reset");
        await page.waitForFunction(
            () => window.lightwalk.last_edited?.materials.length === 0,
            null,
            { timeout: 10000 },
        );
    },

    async "dim a lamp, and read what is left of it"(page) {
        if (await page.isHidden("#dock [data-panel=lamps]")) return console.log("no light groups");
        await page.focus("#picture");
        await page.keyboard.press("u");
        await page.waitForSelector("#lamps .lamp");
        const [x, y] = args.at.split(",").map(Number);
        const read = async () => {
            await page.evaluate(() => (window.lightwalk.last_pick = null));
            await page.mouse.click(x * width, (1 - y) * height);
            await page.waitForFunction(() => window.lightwalk.last_pick, null, { timeout: 10000 });
            return (await counters(page, "last_pick")).last_pick;
        };
        await page.focus("#picture");
        await page.keyboard.press(args.view);
        await page.waitForTimeout(300);
        await shown(page);
        const before = await read();
        for (const row of await page.locator("#lamps .lamp").all()) {
            await row.locator(".percent").fill("40");
            await row.locator(".percent").press("Enter");
        }
        await page.locator("#lamps .lamp .kelvin").last().fill("3000");
        await page.waitForTimeout(500);
        const after = await read();
        assert.ok(after.illuminance < 0.7 * before.illuminance);
        const [file] = await Promise.all([
            page.waitForEvent("download"),
            page.click("#write-lamps"),
        ]);
        await file.saveAs(path.join(args.pictures, "lights.rad"));
        await writeFile(path.join(args.pictures, "dimmed.json"), JSON.stringify(after));
    },
};

async function run() {
    const { chromium } = createRequire(path.resolve(args.npm, "none.js"))("playwright-core");
    await mkdir(args.pictures, { recursive: true });
    const browser = await chromium.launch({
        executablePath: args.chromium,
        args: ["--no-sandbox"],
    });
    const page = await browser.newPage({ viewport: { width, height } });
    const complaints = [];
    page.on("pageerror", (error) => complaints.push(String(error)));
    page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
    try {
        for (const [k, [name, step]] of Object.entries(steps).entries()) {
            const file = path.join(args.pictures, `${k + 1}-${name.replaceAll(" ", "-")}.png`);
            try {
                await step(page);
            } catch (error) {
                error.message = `${name}: ${error.message}`;
                throw error;
            } finally {
                await page.screenshot({ path: file });
            }
            console.log(`ok: ${name}`);
        }
        assert.deepEqual(complaints, [], "the browser complained");
    } finally {
        await browser.close();
    }
}

if (args.address) await run();
else console.log("walk_page_test: no --address, nothing to test");
