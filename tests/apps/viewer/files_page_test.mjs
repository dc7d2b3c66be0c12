// A walk whose scene's file is edited, in headless Chromium.
//
//     node files_page_test.mjs --address URL --npm FOLDER --pictures FOLDER --folder FOLDER [--chromium PROGRAM]
//
// --folder has room.rad, which the server shows, and what it is to be: state0.rad (as it is), state1.rad (with an error),
// state2.rad (a material), state3.rad (a surface). Writes read.json: the light in the middle of the picture in each state,
// [{state, luminance, position, eye, seconds, kept}]; seconds: from the edit to the page's being told.
import assert from "node:assert/strict";
import { copyFile, mkdir, rename, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import { parseArgs } from "node:util";

const { values: args } = parseArgs({
    options: {
        address: { type: "string" },
        npm: { type: "string" },
        pictures: { type: "string", default: "pictures" },
        folder: { type: "string" },
        chromium: { type: "string", default: "/usr/bin/chromium" },
    },
});
const kPatience = 60000;
const [width, height] = [640, 400];

/** As editors do: another file takes its place. */
async function edit(state) {
    const next = path.join(args.folder, "next.rad");
    await copyFile(path.join(args.folder, `state${state}.rad`), next);
    await rename(next, path.join(args.folder, "room.rad"));
}

const { chromium } = createRequire(path.resolve(args.npm, "none.js"))("playwright-core");
await mkdir(args.pictures, { recursive: true });
const browser = await chromium.launch({ executablePath: args.chromium, args: ["--no-sandbox"] });
try {
    const page = await browser.newPage({ viewport: { width, height } });
    const wait = (test, argument) => page.waitForFunction(test, argument, { timeout: kPatience });
    await page.goto(args.address);
    await wait(() => window.lightwalk?.ready && window.lightwalk.final);
    const read = [];
    for (const state of [0, 1, 2, 3]) {
        let seconds = 0,
            kept = 1;
        if (state > 0) {
            await page.evaluate(() => (window.lightwalk.last_followed = null));
            const begin = Date.now();
            await edit(state);
            await wait(() => window.lightwalk.last_followed);
            seconds = (Date.now() - begin) / 1000;
            const told = await page.evaluate(() => window.lightwalk.last_followed);
            kept = told.kept;
            const trouble = await page.textContent("#troubles");
            if (state === 1) {
                assert.match(trouble, /room\.rad:7: .*painted/);
                assert.ok(await page.isVisible("#trouble"));
            } else {
                assert.deepEqual(told.problems, []);
                assert.ok(await page.isHidden("#trouble"));
                assert.match(
                    await page.textContent("#notice"),
                    state === 2
                        ? /^room\.rad changed: 1 material$/
                        : /^room\.rad changed: 1 surface$/,
                );
            }
            assert.equal(await page.getAttribute("#cover", "class"), "gone");
        }
        await page.waitForTimeout(500);
        await wait(() => window.lightwalk.final);
        await page.evaluate(() => (window.lightwalk.last_pick = null));
        await page.focus("#picture");
        await page.keyboard.press("Enter"); // reads the middle
        await wait(() => window.lightwalk.last_pick);
        const { hit, luminance, position } = await page.evaluate(() => window.lightwalk.last_pick);
        assert.ok(hit);
        const eye = await page.evaluate(() => window.lightwalk.frame_view.position);
        const shown = state === 1 ? 0 : state; // with an error all stays as it was
        read.push({ state: shown, luminance, position, eye, seconds, kept });
        await page.screenshot({ path: path.join(args.pictures, `state-${state}.png`) });
    }
    await writeFile(path.join(args.pictures, "read.json"), JSON.stringify(read));
} finally {
    await browser.close();
}
