// Steps of page_test.mjs: the hour and the day, a day that runs, and what a page that watches sees.
import assert from "node:assert/strict";
import { saved_text, until, value } from "./page_helpers.mjs";

/** What the server knows of the time. */
const told = async (address) => (await fetch(`${address}time`)).json();

async function until_told(address, good) {
    for (let k = 0; k < 100; ++k) {
        if (good(await told(address))) return;
        await new Promise((resolve) => setTimeout(resolve, 50));
    }
    assert.fail(`the server was told ${JSON.stringify(await told(address))}`);
}

async function open_time(page) {
    await page.waitForSelector("#dock [data-panel=time]"); // once the scene is loaded
    await page.mouse.move(300, 300);
    if (await page.isHidden("#panel-time")) await page.click("#dock [data-panel=time]");
}

export const time_steps = (address) => ({
    async "the hour and the day are chosen by pointer and keys, and mean it at rest"(page) {
        await page.waitForSelector("#dock [data-panel=time]");
        await page.focus("#picture");
        await page.keyboard.press("0");
        await page.waitForSelector("#panel-time:not([hidden])");
        assert.equal(await page.textContent("#time-clock"), "14:18");
        assert.equal(await page.textContent("#time-date"), "21 September");
        assert.match(await page.textContent("#time-sun"), /Sunrise 6:30, sunset 18:15/);
        assert.equal(await page.isVisible("#time-rise"), true);
        await page.fill("#time-hour", "600");
        await until_told(address, ({ time }) => time?.hour === 10);
        await page.focus("#time-hour");
        await page.keyboard.press("ArrowRight");
        await until_told(address, ({ time }) => Math.abs(time?.hour - 605 / 60) < 1e-9);
        await page.focus("#time-day");
        await page.keyboard.press("ArrowLeft");
        await until_told(address, ({ time }) => time?.month === 9 && time.day === 20);
        await page.selectOption("#time-sky", "-c");
        await until_told(address, ({ time }) => time?.sky === "-c");
        await page.click("#time-reset");
        await until_told(address, ({ time }) => time === null);
        assert.equal(await page.textContent("#time-clock"), "14:18");
        assert.ok(await page.isDisabled("#time-reset"));
    },

    async "a day runs, and stops"(page) {
        await open_time(page);
        await page.click("#time-play");
        assert.equal(await page.getAttribute("#time-play", "aria-pressed"), "true");
        await until_told(address, ({ time }) => time?.hour > 14.4);
        await page.click("#time-play");
        assert.equal(await page.getAttribute("#time-play", "aria-pressed"), "false");
        const stopped = (await value(page, "time")).hour;
        await until_told(address, ({ time }) => time.hour === stopped);
        await page.waitForTimeout(400);
        assert.equal((await told(address)).time.hour, stopped);
        await page.click("#time-reset");
        const { bytes } = await saved_text(page, "#write-sky");
        assert.match(String(bytes), /null/);
    },

    async "the time stays over a reload, and who watches sees it"(page) {
        await open_time(page);
        await page.fill("#time-hour", "420");
        await until_told(address, ({ time }) => time?.hour === 7);
        const other = await page.context().browser().newPage();
        await other.goto(address);
        await until(other, () => window.lightwalk?.frames > 0);
        await other.evaluate(() => document.querySelector("#dock [data-panel=time]").click());
        await other.waitForFunction(
            () => document.querySelector("#time-clock").textContent === "7:00",
        );
        assert.ok(await other.isDisabled("#time-hour"));
        assert.ok(await other.isDisabled("#time-play"));
        await other.close();
        await page.bringToFront();
        await page.reload();
        await until(page, () => window.lightwalk?.frames > 0 && window.lightwalk.driving);
        await open_time(page);
        await until(page, () => document.querySelector("#time-clock").textContent === "7:00");
        await page.click("#time-reset");
        await until_told(address, ({ time }) => time === null);
        await page.keyboard.press("Escape");
    },
});
