// Steps of page_test.mjs: dimmers, presets of them, and what a page that watches sees.
import assert from "node:assert/strict";
import { saved_text, until } from "./page_helpers.mjs";

/** What the server knows of the lamps. */
const told = async (address) => (await fetch(`${address}lights`)).json();

/** Until it knows that. */
async function until_told(address, good) {
    for (let k = 0; k < 100; ++k) {
        if (good(await told(address))) return;
        await new Promise((resolve) => setTimeout(resolve, 50));
    }
    assert.fail(`the server was told ${JSON.stringify(await told(address))}`);
}

const lamp = (k, what) => `#lamps li:nth-child(${k}) ${what}`;

async function open_lamps(page) {
    await page.mouse.move(300, 300);
    if (await page.isHidden("#panel-lamps")) await page.click("#dock [data-panel=lamps]");
}

/** A state of the lamps that the other steps begin with. */
async function set_lamps(page) {
    await open_lamps(page);
    await page.click("#lamps-reset");
    await page.fill(lamp(3, ".percent"), "150");
    await page.press(lamp(3, ".percent"), "Enter");
    await page.uncheck(lamp(2, ".switch"));
    await page.fill(lamp(3, ".kelvin"), "2700");
}

export const lamp_steps = (address) => ({
    async "lamps are dimmed by pointer, keys and numbers, and coloured"(page) {
        await page.waitForSelector("#dock [data-panel=lamps]"); // once the scene is loaded
        await page.focus("#picture");
        await page.keyboard.press("u");
        await page.waitForSelector("#panel-lamps:not([hidden])");
        assert.equal(await page.textContent(lamp(3, "label")), "desk lamp");
        await page.fill(lamp(3, ".percent"), "150");
        await page.press(lamp(3, ".percent"), "Enter");
        await until_told(address, ([one]) => one?.name === "desk lamp" && one.level === 1.5);
        assert.equal(await page.inputValue(lamp(3, ".level")), "150");
        await page.focus(lamp(1, ".level"));
        await page.keyboard.press("ArrowLeft");
        await until_told(address, ([one]) => one?.name === "sun" && one.level === 0.99);
        await page.uncheck(lamp(2, ".switch"));
        await until_told(address, (all) => all[1]?.name === "sky" && all[1].level === 0);
        await page.fill(lamp(3, ".kelvin"), "2700");
        await until_told(address, (all) => all[2]?.rgb[0] > 1.3 && all[2].rgb[2] < 0.4);
        assert.equal(await page.textContent(lamp(3, ".colour")), "2700 K");
        // What is no level is not sent.
        await page.fill(lamp(3, ".percent"), "900");
        await page.press(lamp(3, ".percent"), "Enter");
        await page.waitForTimeout(100);
        assert.equal((await told(address))[2].level, 1.5);
    },

    async "presets are kept over a reload, and one is a file"(page) {
        await set_lamps(page);
        await page.fill("#lamps-name", "evening");
        await page.press("#lamps-name", "Enter");
        await page.click("#lamps-reset");
        await until_told(address, (all) => all.length === 0);
        await page.reload();
        await until(page, () => window.lightwalk?.frames > 0 && window.lightwalk.driving);
        await open_lamps(page);
        await page.fill(lamp(2, ".percent"), "70");
        await page.press(lamp(2, ".percent"), "Enter");
        await until_told(address, ([one]) => one?.name === "sky" && one.level === 0.7);
        await page.reload(); // what was dimmed stays so
        await until(page, () => window.lightwalk?.frames > 0 && window.lightwalk.driving);
        await open_lamps(page);
        assert.equal(await page.inputValue(lamp(2, ".percent")), "70");
        assert.equal((await told(address))[0].level, 0.7);
        await page.selectOption("#lamps-preset", "evening");
        await until_told(address, (all) => all.length === 2 && all[1].level === 1.5);
        const { bytes } = await saved_text(page, "#write-lamps");
        assert.match(String(bytes), /desk lamp/);
        await page.click("#lamps-forget");
        assert.deepEqual(await page.$$eval("#lamps-preset option", (all) => all.length), 1);
    },

    async "who watches sees the dimmers, and cannot move them"(page) {
        await set_lamps(page);
        await until_told(address, (all) => all.length === 2 && all[1].rgb[0] > 1.3);
        const other = await page.context().browser().newPage();
        await other.goto(address);
        await until(other, () => window.lightwalk?.frames > 0);
        await other.evaluate(() => document.querySelector("#dock [data-panel=lamps]").click());
        assert.equal(await other.inputValue(lamp(3, ".level")), "150");
        assert.equal(await other.textContent(lamp(3, ".colour")), "2700 K");
        assert.equal(await other.isChecked(lamp(2, ".switch")), false);
        assert.ok(await other.isDisabled(lamp(3, ".level")));
        await other.close();
        await page.bringToFront();
        await page.click("#lamps-reset");
        await until_told(address, (all) => all.length === 0);
        await page.keyboard.press("Escape");
    },
});
