// Steps of page_test.mjs: exposure and colours, which the page changes by itself until the server's frames have them.
import assert from "node:assert/strict";
import { saved_text, shown, until, value } from "./page_helpers.mjs";

/** Small bytes r, g, b of what is on the picture. */
const bytes_of = (page) =>
    page.evaluate(() => {
        const canvas = document.createElement("canvas");
        const [w, h] = [(canvas.width = 80), (canvas.height = 50)];
        const context = canvas.getContext("2d");
        context.drawImage(document.querySelector("#picture"), 0, 0, w, h);
        return Array.from(context.getImageData(0, 0, w, h).data).filter((_, k) => k % 4 < 3);
    });
const mean = (bytes) => bytes.reduce((sum, x) => sum + x, 0) / bytes.length;
const apart = (a, b) => mean(a.map((x, k) => Math.abs(x - b[k])));

/** Bytes of the picture while the server sends nothing, and when it sends again, after an act. */
async function before_and_after(page, prank, act) {
    const frames = await value(page, "frames");
    await prank("dumb");
    await act();
    await page.waitForTimeout(150);
    const own = await bytes_of(page);
    assert.equal(await value(page, "frames"), frames, "the server is dumb");
    await prank("speak");
    await until(page, (n) => window.lightwalk.frames > n && window.lightwalk.final, frames);
    return [own, await bytes_of(page)];
}

export const colour_steps = (address, prank) => ({
    async "exposure and false colours change at once, and then are the server's"(page) {
        await page.focus("#picture");
        await page.keyboard.press("2");
        await page.waitForTimeout(100);
        await shown(page);
        await page.keyboard.press("x"); // a fixed exposure
        await until(page, () => window.lightwalk.final);
        const first = await bytes_of(page);
        const press = (key) => () => page.keyboard.press(key);
        const [dark, darker] = await before_and_after(page, prank, async () => {
            for (let k = 0; k < 4; ++k) await page.keyboard.press("-");
        });
        assert.ok(mean(dark) < 0.8 * mean(first), `${mean(dark)} after ${mean(first)}`);
        assert.ok(apart(dark, darker) < 4, `${apart(dark, darker)} apart from the server's`);
        const [map, served] = await before_and_after(page, prank, press("f"));
        assert.ok(apart(map, darker) > 30, "no false colours");
        assert.ok(apart(map, served) < 5, `${apart(map, served)} apart from the server's`);
        const [back, again] = await before_and_after(page, prank, press("f"));
        assert.ok(apart(back, darker) < 2 && apart(back, again) < 2, "not the picture of before");
        await page.keyboard.press("x");
        await until(page, () => window.lightwalk.final);
    },

    async "false colours have the luminance under the pointer, at once"(page) {
        await page.keyboard.press("3"); // the wall of known luminance
        await page.waitForTimeout(100);
        await shown(page);
        await page.mouse.move(300, 200);
        assert.ok(await page.isHidden("#under"));
        await page.keyboard.press("f");
        await page.mouse.move(402, 250);
        await page.waitForSelector("#under:not([hidden])");
        const text = await page.textContent("#under");
        assert.match(text, /^≈ 1[12]0 cd\/m²$/);
        await page.keyboard.down("ArrowLeft");
        await page.waitForSelector("#under", { state: "hidden" });
        await page.keyboard.up("ArrowLeft");
        await page.keyboard.press("f");
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
    },

    async "clean pictures are for the eye: a choice of the driver, told under what is saved"(page) {
        await page.focus("#picture");
        const denoised = (wanted) =>
            until(page, (w) => window.lightwalk.final && window.lightwalk.denoised === w, wanted);
        await denoised(false);
        const toggle = async (panel) => {
            await page.mouse.move(300, 300); // or the buttons may have faded
            await page.click(`#dock [data-panel=${panel}]`);
        };
        const height = async () => {
            await toggle("save");
            return (await saved_text(page, "#write-png")).bytes.readUInt32BE(20);
        };
        assert.equal(await height(), 500);
        await toggle("light");
        assert.ok(await page.isVisible("#clean-line"));
        assert.ok(!(await page.isChecked("#clean")));
        await page.click("#clean-line");
        await denoised(true);
        const other = await page.context().browser().newPage();
        await other.goto(address);
        await until(other, () => window.lightwalk?.denoised && !window.lightwalk.driving);
        assert.ok(await other.isChecked("#clean"));
        await other.close();
        assert.ok((await height()) > 500, "the picture does not say that it is clean");
        await toggle("light");
        await page.focus("#picture");
        await page.keyboard.press("f"); // luminance is of what was traced
        await page.waitForSelector("#clean-line", { state: "hidden" });
        await page.keyboard.press("f");
        await page.click("#clean-line");
        await denoised(false);
        await toggle("light");
    },

    async "a watcher has the driver's colours, and their scale"(page) {
        const other = await page.context().browser().newPage();
        await other.goto(address);
        await until(other, () => window.lightwalk?.frames > 0 && !window.lightwalk.driving);
        await page.focus("#picture");
        await page.keyboard.press("f");
        await other.waitForSelector("#legend:not([hidden])");
        await page.keyboard.press("f");
        await other.waitForSelector("#legend", { state: "hidden" });
        await other.close();
    },
});
