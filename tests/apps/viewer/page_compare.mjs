// Steps of page_test.mjs: two states of the scene side by side.
import assert from "node:assert/strict";
import { axe_complaints } from "./axe.mjs";
import { kSize, saved_text, shown, until, value } from "./page_helpers.mjs";

/** What the server was told about the scene beside. */
const told = async (address) => (await fetch(`${address}beside`)).json();

async function until_told(address, good) {
    for (let k = 0; k < 100; ++k) {
        if (good(await told(address))) return;
        await new Promise((resolve) => setTimeout(resolve, 50));
    }
    assert.fail(`the server was told ${JSON.stringify(await told(address))}`);
}

const both_final = (page) =>
    until(page, () => window.lightwalk.final && window.lightwalk.beside?.final);

const compares = (page) => page.evaluate(() => window.lightwalk.beside !== null);

async function compare(page) {
    await page.focus("#picture");
    if (!(await compares(page))) await page.keyboard.press(".");
}

/** Mean green of the screen left and right of its middle, in a band that holds nothing but the pictures [0..255]. */
async function halves(page) {
    const { width } = kSize;
    const clip = (x) => ({ x, y: 120, width: 120, height: 60 });
    const mean = async (x) => {
        const png = (await page.screenshot({ clip: clip(x) })).toString("base64");
        return page.evaluate(async (data) => {
            const image = new Image();
            image.src = `data:image/png;base64,${data}`;
            await image.decode();
            const canvas = document.createElement("canvas");
            Object.assign(canvas, { width: image.width, height: image.height });
            const context = canvas.getContext("2d");
            context.drawImage(image, 0, 0);
            const { data: bytes } = context.getImageData(0, 0, image.width, image.height);
            return bytes.reduce((sum, v, k) => sum + (k % 4 === 1 ? v : 0), 0) / (bytes.length / 4);
        }, png);
    };
    return [await mean(width / 2 - 160), await mean(width / 2 + 40)];
}

export const compare_steps = (address, npm, prank) => ({
    async "two states side by side: the other one has its own hour, and the divider parts them"(
        page,
    ) {
        await page.focus("#picture");
        // Brightness is compared here, of which false colours know nothing.
        if (await page.isVisible("#legend")) await page.keyboard.press("f");
        await page.keyboard.press("2");
        await shown(page);
        assert.ok(await page.isHidden("#divider"));
        await page.keyboard.press(".");
        await both_final(page);
        assert.equal(await page.getAttribute("#divider", "aria-valuenow"), "50");
        const [left, right] = await halves(page);
        await page.keyboard.press("0");
        assert.match(
            await page.evaluate(
                () => getComputedStyle(document.querySelector("#title-time"), "::after").content,
            ),
            /B/,
        );
        await page.fill("#time-hour", "600");
        await until_told(address, ({ time }) => time?.time?.hour === 10 && !time.moving);
        assert.equal((await (await fetch(`${address}time`)).json()).time, null);
        await until(page, () => document.querySelector("#side-b").textContent === "B · 10:00");
        assert.match(await page.textContent("#side-a"), /^A · 14:18/);
        await both_final(page);
        await page.keyboard.press("Escape");
        let [same, brighter] = await halves(page);
        for (let k = 0; k < 100 && brighter <= right + 10; ++k) {
            await page.waitForTimeout(100); // a frame of the old hour may have been on its way
            [same, brighter] = await halves(page);
        }
        assert.ok(Math.abs(same - left) < 2, `${left} became ${same}`);
        assert.ok(brighter > right + 10, `${right} became ${brighter}`);
        assert.deepEqual((await axe_complaints(page, npm)) ?? [], []);
        // To the right of all there is A.
        await page.focus("#divider");
        await page.keyboard.press("End");
        assert.equal(await page.getAttribute("#divider", "aria-valuenow"), "100");
        assert.ok(Math.abs((await halves(page))[1] - right) < 2);
        for (let k = 0; k < 10; ++k) await page.keyboard.press("ArrowLeft");
        await page.keyboard.press("Shift+ArrowLeft");
        assert.equal(await page.getAttribute("#divider", "aria-valuenow"), "70");
        const { height, width } = kSize;
        await page.mouse.move(0.7 * width, height / 3);
        await page.mouse.down();
        await page.mouse.move(0.4 * width, height / 3, { steps: 4 });
        await page.mouse.up();
        assert.equal(await page.getAttribute("#divider", "aria-valuenow"), "40");
    },

    async "what is read, and what panels change, is of the side where it is"(page) {
        await compare(page);
        await both_final(page);
        const { width, height } = kSize;
        const read = async (x) => {
            await page.evaluate(() => (window.lightwalk.last_pick = null));
            await page.mouse.click(x * width, 0.4 * height);
            await until(page, () => window.lightwalk.last_pick);
            return {
                ...(await value(page, "last_pick")),
                card: await page.textContent("#reading"),
            };
        };
        const b = await read(0.8);
        assert.equal(b.luminance, 77);
        assert.match(b.card, /cd\/m².* · B/);
        await page.keyboard.press("Escape");
        const a = await read(0.2);
        assert.notEqual(a.luminance, 77);
        assert.match(a.card, /cd\/m² ±.* · A/);
        await page.keyboard.press("Escape");
        await page.check("[name=side][value=A]", { force: true });
        await page.focus("#picture");
        await page.keyboard.press("0");
        assert.equal(await page.textContent("#time-clock"), "14:18");
        const before = await told(address);
        await page.fill("#time-hour", "720");
        await until(page, () => window.lightwalk.last_time?.time?.hour === 12);
        assert.deepEqual((await told(address)).time, before.time);
        await page.check("[name=side][value=B]", { force: true });
        assert.notEqual(await page.textContent("#time-clock"), "12:00");
        await page.check("[name=side][value=A]", { force: true });
        assert.equal(await page.textContent("#time-clock"), "12:00");
        await page.click("#time-reset");
        await page.keyboard.press("Escape");
    },

    async "the difference is shown with its scale, and saved pictures have both sides"(page) {
        await compare(page);
        await both_final(page);
        await page.focus("#picture");
        await page.keyboard.press(",");
        await until_told(address, ({ difference }) => difference?.shown);
        assert.equal(await page.getAttribute("#difference", "aria-pressed"), "true");
        await page.waitForSelector("#difference-legend:not([hidden])");
        assert.ok((await page.locator("#difference-bar text").count()) >= 7);
        await page.waitForTimeout(300);
        assert.deepEqual((await axe_complaints(page, npm)) ?? [], []);
        await page.mouse.move(300, 300);
        await page.click("[data-panel=save]");
        const png = (await saved_text(page, "#write-png")).bytes;
        assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [800, 500]);
        await page.click("[data-panel=save]");
        await page.click("#difference");
        await until_told(address, ({ difference }) => difference?.shown === false);
        assert.ok(await page.isHidden("#difference-legend"));
    },

    async "the eye moves on both sides, and a line that breaks is made again"(page) {
        await compare(page);
        await both_final(page);
        await page.focus("#picture");
        await page.keyboard.down("ArrowRight");
        await until(
            page,
            () => window.lightwalk.beside.camera.draws && window.lightwalk.camera_draws,
        );
        await page.keyboard.up("ArrowRight");
        await shown(page);
        await both_final(page);
        await until(page, () => {
            const { shown_view, beside } = window.lightwalk;
            return beside.session.frame_view?.direction[0] === shown_view.direction[0];
        });
        await prank("drop_beside");
        const frames = await page.evaluate(() => window.lightwalk.beside.frames);
        await until(page, (n) => window.lightwalk.beside.frames > n, frames);
        // Who does not drive has nothing to compare.
        await prank("steal");
        await until(page, () => window.lightwalk.beside === null);
        assert.ok(await page.isHidden("#divider"));
        assert.equal(await page.locator("canvas.beside").count(), 0);
        await prank("leave");
        await page.click("#take");
        await until(page, () => window.lightwalk.driving);
    },

    async "where nothing can be compared the page says why"(page) {
        await prank("alone");
        await until(page, () => window.lightwalk.ready);
        await page.waitForTimeout(200);
        await page.focus("#picture");
        await page.keyboard.press(".");
        await page.waitForSelector("text=many processes draw this walk");
        assert.equal(await compares(page), false);
        await prank("reload");
        await until(page, () => window.lightwalk.ready);
        await page.waitForTimeout(500);
        await shown(page);
    },

    async "pictures are compared without a camera, too"(page) {
        await page.goto(`${address}?plain`);
        await shown(page);
        await page.focus("#picture");
        await page.keyboard.press(".");
        await both_final(page);
        await page.keyboard.press("0");
        await page.fill("#time-hour", "600");
        await until_told(address, ({ time }) => time?.time?.hour === 10);
        await page.waitForTimeout(300);
        await both_final(page);
        await page.keyboard.press("Escape");
        const [left, right] = await halves(page);
        assert.notEqual(Math.round(left), Math.round(right));
        await page.focus("#picture");
        await page.keyboard.press(".");
        assert.equal(await compares(page), false);
        await page.goto(address);
        await shown(page);
    },
});
