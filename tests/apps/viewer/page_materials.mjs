// Steps of page_test.mjs: what a surface is made of, and other numbers for it.
import assert from "node:assert/strict";
import { axe_complaints } from "./axe.mjs";
import { saved_text, shown, until, value } from "./page_helpers.mjs";

/** What the server knows of changed materials. */
const told = async (address) => (await fetch(`${address}materials`)).json();

async function until_told(address, good) {
    for (let k = 0; k < 100; ++k) {
        if (good(await told(address))) return;
        await new Promise((resolve) => setTimeout(resolve, 50));
    }
    assert.fail(`the server was told ${JSON.stringify(await told(address))}`);
}

const number = (k) => `#material-layers .layer:first-child [data-number="${k}"]`;

async function enter(page, k, text) {
    await page.fill(number(k), text);
    await page.press(number(k), "Enter");
}

/** The panel shows what the wall is made of; a step that is run alone, or once more, finds nothing chosen. */
async function choose_surface(page) {
    if ((await page.locator(number(0)).count()) > 0) return;
    await page.focus("#picture");
    await page.keyboard.press("y");
    await page.mouse.click(400, 300);
    await page.waitForSelector("#panel-materials:not([hidden]) .layer");
}

export const material_steps = (address, npm) => ({
    async "a click tells the materials of a surface, and numbers change them"(page) {
        await page.keyboard.press("1");
        await shown(page);
        await page.focus("#picture");
        await page.keyboard.press("y");
        assert.equal(await page.getAttribute("#material-choose", "aria-pressed"), "true");
        await page.keyboard.press("Escape");
        assert.equal(await page.getAttribute("#material-choose", "aria-pressed"), "false");
        await page.keyboard.press("y");
        await page.keyboard.press("c"); // one surface is chosen for one thing
        assert.equal(await page.getAttribute("#material-choose", "aria-pressed"), "false");
        await page.keyboard.press("y");
        assert.equal(await page.getAttribute("#isolux-surface", "aria-pressed"), "false");
        await page.mouse.click(400, 300);
        await page.waitForSelector("#panel-materials:not([hidden]) .layer");
        const { layers, surface } = await value(page, "last_material");
        const words = await page.textContent("#material-text");
        assert.equal(words, `${surface} is made of ${layers[0].name} (plastic).`);
        const all = await page.textContent("#material-layers");
        for (const part of ["weave", "colorpict · modified by void · red · green", "room.rad:7"])
            assert.ok(all.includes(part), all);
        assert.deepEqual((await axe_complaints(page, npm)) ?? [], []);
        await enter(page, 0, "0,25");
        await until_told(address, ([one]) => one?.reals[0] === 0.25 && one.kind === "plastic");
        assert.equal((await told(address))[0].name, layers[0].name);
        await page.focus("#material-layers .layer:first-child [data-slider='3']");
        await page.keyboard.press("ArrowRight");
        await until_told(address, ([one]) => one?.reals[3] === 0.001);
        assert.equal(await page.inputValue(number(3)), "0.001");
        await page.fill("#material-layers .layer:first-child [type=color]", "#ffffff");
        await until_told(address, ([one]) => one?.reals[1] === 1);
        assert.equal(await page.inputValue(number(2)), "1");
        assert.ok(await page.isDisabled("#material-layers .layer:last-child [data-number='0']"));
    },

    async "numbers that a material cannot have are refused in words, by the page or the server"(
        page,
    ) {
        await choose_surface(page);
        const before = await told(address);
        for (const [text, words] of [
            ["1.5", "The reflectance, red must be from 0 to 1."],
            ["much", "The reflectance, red must be a number."],
        ]) {
            await enter(page, 0, text);
            assert.equal(await page.textContent("#material-problem"), words);
            assert.equal(await page.getAttribute(number(0), "aria-invalid"), "true");
        }
        await page.waitForTimeout(100);
        assert.deepEqual(await told(address), before);
        await enter(page, 0, "0.123");
        await until(page, () => !document.querySelector("#material-problem").hidden);
        assert.match(
            await page.textContent("#material-problem"),
            / is not changed: nobody paints so\.$/,
        );
        await enter(page, 0, "0.4");
        await until_told(address, ([one]) => one?.reals[0] === 0.4);
        assert.ok(await page.isHidden("#material-problem"));
    },

    async "an answer to the change before does not undo one that waits for the next refresh"(page) {
        await choose_surface(page);
        await page.evaluate(async (box) => {
            const enter = (text) => {
                const input = document.querySelector(box);
                input.value = text;
                input.dispatchEvent(new Event("change"));
            };
            const refreshes = window.requestAnimationFrame;
            const refresh = () => new Promise((resolve) => refreshes(resolve));
            enter("0.45");
            for (let k = 0; k < 2; ++k) await refresh();
            const waiting = [];
            window.requestAnimationFrame = (then) => waiting.push(then);
            enter("0.4");
            const is_answered = () => window.lightwalk.last_edited?.materials[0]?.reals[0] === 0.45;
            for (let k = 0; k < 600 && !is_answered(); ++k) await refresh();
            window.requestAnimationFrame = refreshes;
            for (const then of waiting) refreshes(then);
        }, number(0));
        await until_told(address, ([one]) => one?.reals[0] === 0.4);
    },

    async "an answer that comes while a number is typed leaves it alone"(page) {
        await choose_surface(page);
        const [red, green] = await Promise.all(
            [0, 1].map(async (k) =>
                (await page.inputValue(number(k))) === "0.35" ? "0.55" : "0.35",
            ),
        );
        await page.evaluate(
            ([boxes, numbers]) => {
                const [one, other] = boxes.map((box) => document.querySelector(box));
                one.value = numbers[0];
                one.dispatchEvent(new Event("change"));
                other.focus();
                other.value = numbers[1];
                other.dispatchEvent(new Event("input"));
            },
            [
                [number(0), number(1)],
                [red, green],
            ],
        );
        const is_red = (value) => window.lightwalk.last_edited?.materials[0]?.reals[0] === value;
        await until(page, is_red, Number(red));
        assert.equal(await page.inputValue(number(0)), red);
        assert.equal(await page.inputValue(number(1)), green);
        await page.evaluate(() => document.activeElement.dispatchEvent(new Event("change")));
        await until_told(address, ([one]) => one?.reals[1] === Number(green));
        assert.equal((await told(address))[0].reals[0], Number(red));
        assert.equal(await page.inputValue(number(1)), green);
    },

    async "changed materials are undone, forgotten and saved, and stay over a reload"(page) {
        await choose_surface(page);
        await enter(page, 0, "0.4");
        await until_told(address, ([one]) => one?.reals[0] === 0.4);
        await enter(page, 4, "0.2");
        await until_told(address, ([one]) => one?.reals[4] === 0.2);
        await page.click("#material-undo");
        await until_told(address, ([one]) => one?.reals[4] === 0.1 && one.reals[0] === 0.4);
        assert.equal(await page.inputValue(number(4)), "0.1");
        const { name, bytes } = await saved_text(page, "#write-materials");
        assert.match(name, /materials\.rad$/);
        assert.match(String(bytes), /plastic/);
        await page.reload();
        await until(page, () => window.lightwalk?.frames > 0 && window.lightwalk.driving);
        await page.mouse.move(300, 300);
        await page.click("#dock [data-panel=materials]");
        await until(page, () => document.querySelectorAll("#material-edits li").length === 1);
        const other = await page.context().browser().newPage();
        await other.goto(address);
        await until(other, () => window.lightwalk?.last_edited);
        await other.evaluate(() => document.querySelector("#dock [data-panel=materials]").click());
        assert.ok(await other.isDisabled("#material-reset"));
        await other.close();
        await page.bringToFront();
        await page.click("#material-edits button");
        await until_told(address, (all) => all.length === 0);
        await page.click("#material-undo");
        await until_told(address, (all) => all.length === 1);
        await page.click("#material-reset");
        await until_told(address, (all) => all.length === 0);
        assert.ok(await page.isHidden("#material-changed"));
        await page.keyboard.press("Escape");
    },
});
