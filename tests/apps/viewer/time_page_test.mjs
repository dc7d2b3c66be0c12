// The time panel of a walk that runs, in headless Chromium: another hour, read at a pin.
//
//     node time_page_test.mjs --address URL --npm FOLDER --pictures FOLDER [--chromium PROGRAM]
//
// Writes read.json: the light at a point at each of some hours, [{hour, illuminance, position, normal}], and sky.rad.
import assert from "node:assert/strict";
import { mkdir, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import { parseArgs } from "node:util";

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

const { chromium } = createRequire(path.resolve(args.npm, "none.js"))("playwright-core");
await mkdir(args.pictures, { recursive: true });
const browser = await chromium.launch({ executablePath: args.chromium, args: ["--no-sandbox"] });
try {
    const page = await browser.newPage({ viewport: { width, height } });
    const wait = (test, argument) => page.waitForFunction(test, argument, { timeout: kPatience });
    await page.goto(args.address);
    await wait(() => window.lightwalk?.ready && window.lightwalk.frames > 0);
    await page.focus("#picture");
    await page.keyboard.press("0");
    await page.waitForSelector("#panel-time:not([hidden])");
    const read = [];
    for (const minutes of [null, 600, 1020, 120, 720]) {
        if (minutes !== null) {
            await page.fill("#time-hour", String(minutes));
            await wait((hour) => window.lightwalk.last_time?.time?.hour === hour, minutes / 60);
        }
        await wait(() =>
            /^Light of [\d:]+$/.test(document.querySelector("#time-state").textContent),
        );
        await page.evaluate(() => (window.lightwalk.last_pick = null));
        await page.focus("#picture");
        await page.keyboard.press("Enter"); // reads the middle
        await wait(() => window.lightwalk.last_pick);
        const { hit, illuminance, position, normal } = await page.evaluate(
            () => window.lightwalk.last_pick,
        );
        assert.ok(hit);
        read.push({ hour: minutes === null ? null : minutes / 60, illuminance, position, normal });
        await page.screenshot({ path: path.join(args.pictures, `at-${minutes ?? "file"}.png`) });
    }
    const [file] = await Promise.all([page.waitForEvent("download"), page.click("#write-sky")]);
    await file.saveAs(path.join(args.pictures, "sky.rad"));
    await writeFile(path.join(args.pictures, "read.json"), JSON.stringify(read));
} finally {
    await browser.close();
}
