// Steps of page_test.mjs: those who draw the walk are lost, and others begin anew; the connection stays.
import assert from "node:assert/strict";
import { gone, hold, shown, until, value } from "./page_helpers.mjs";

const kSaid = "Rank 2 was killed: the walk begins anew with 4 ranks";

/** Who opens the page while nobody draws sees what was drawn last, under the reason. */
async function come_meanwhile(page, address) {
    const other = await page.context().browser().newPage();
    await other.goto(address);
    await until(other, () => window.lightwalk.frames > 0);
    await until(
        other,
        (said) => document.querySelector("#cover-text").textContent === said,
        kSaid.replace("Rank", "rank"),
    );
    assert.ok(!(await other.evaluate(() => document.querySelector("#cover").matches(".gone"))));
    const colours = await other.evaluate(() => {
        const { width, height } = document.querySelector("#picture");
        const context = document.querySelector("#picture").getContext("2d");
        return new Set(new Uint32Array(context.getImageData(0, 0, width, height).data.buffer)).size;
    });
    assert.ok(colours > 100, `${colours} colours`);
    assert.equal(await value(other, "ready"), false);
    await other.close();
}

async function dim_lamp(page, percent) {
    const place = "#lamps li:nth-child(2) .percent";
    await page.mouse.move(300, 300);
    if (await page.isHidden("#panel-lamps")) await page.click("#dock [data-panel=lamps]");
    await page.fill(place, String(percent));
    await page.press(place, "Enter");
    await page.click("#dock [data-panel=lamps]");
}

export const interruption_steps = (address, prank) => ({
    async "who drew is lost: the page says so, and tells those who begin anew what it wants to see"(
        page,
    ) {
        const told = async () => (await fetch(`${address}lights`)).text();
        await dim_lamp(page, 62);
        while (!(await told()).includes("0.62")) await page.waitForTimeout(20);
        const [before, lights] = [await value(page, "view"), await told()];
        await prank("interrupt");
        await page.waitForSelector("#cover:not(.gone)");
        assert.equal(await page.textContent("#cover-text"), kSaid);
        assert.equal(await told(), "[]");
        const number = await value(page, "view_id");
        await page.focus("#picture");
        await page.keyboard.press("d", { delay: 100 });
        assert.equal(await value(page, "view_id"), number); // nobody would draw it
        await page.keyboard.press("a", { delay: 100 });
        assert.ok(await value(page, "connected"));
        await come_meanwhile(page, address);
        await prank("resume");
        await shown(page);
        await page.waitForSelector("#cover.gone", { state: "attached" });
        await until(page, (said) => document.querySelector("#notice").textContent === said, kSaid);
        assert.equal(await told(), lights);
        assert.ok(gone(before, await value(page, "view")) < 1);
        assert.ok(await value(page, "driving"));
        assert.ok((await hold(page, "w")) > 0.1);
    },
});
