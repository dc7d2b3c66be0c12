// Steps of page_test.mjs: whether everybody reaches every control.
import assert from "node:assert/strict";
import { axe_complaints } from "./axe.mjs";
import { until } from "./page_helpers.mjs";

const kPanels = ["light", "views", "plan", "measure", "lamps", "materials", "time", "save"];

export const access_steps = (address, npm) => ({
    async "axe finds nothing wrong with any panel"(page) {
        for (const panel of [...kPanels, "help"]) {
            await page.mouse.move(300, 300);
            if (panel === "help") await page.click("#show-help");
            else await page.click(`#dock [data-panel=${panel}]`);
            await page.waitForTimeout(500);
            const complaints = await axe_complaints(page, npm);
            if (complaints === null) return console.log("skipped: no axe-core");
            assert.deepEqual(complaints, [], panel);
        }
        await page.keyboard.press("Escape");
    },

    async "Tab reaches every control"(page) {
        for (const panel of kPanels) {
            await page.mouse.move(300, 300);
            await page.click(`#dock [data-panel=${panel}]`);
            const wanted = await page.evaluate(() =>
                [...document.querySelectorAll("button, select, input, [tabindex]")]
                    .filter((e) => !e.disabled && e.offsetParent !== null && e.type !== "radio")
                    .map((e) => e.id || e.textContent),
            );
            const reached = new Set();
            await page.focus("#picture");
            for (let k = 0; k < 60; ++k) {
                reached.add(
                    await page.evaluate(
                        () => document.activeElement.id || document.activeElement.textContent,
                    ),
                );
                await page.keyboard.press("Tab");
            }
            const missing = wanted.filter((name) => !reached.has(name) && name !== "picture");
            assert.deepEqual(missing, [], panel);
            await page.click(`#dock [data-panel=${panel}]`);
        }
    },

    async "fingers find 44 pixels, and nothing is cut off in a window of 400 x 300"(page) {
        const phone = await page
            .context()
            .browser()
            .newContext({
                viewport: { width: 390, height: 844 },
                deviceScaleFactor: 2,
                isMobile: true,
                hasTouch: true,
            });
        const other = await phone.newPage();
        await other.goto(address);
        await until(other, () => window.lightwalk?.frames > 0);
        for (const size of [
            [390, 844],
            [844, 390],
            [400, 300],
        ]) {
            await other.setViewportSize({ width: size[0], height: size[1] });
            for (const panel of kPanels) {
                await other.evaluate(
                    (p) => document.querySelector(`#dock [data-panel=${p}]`).click(),
                    panel,
                );
                const wrong = await other.evaluate(() => {
                    const small = [
                        ...document.querySelectorAll(
                            "button, select, input[type=range], .segments label, label.line",
                        ),
                    ]
                        .filter(
                            (e) =>
                                e.offsetParent !== null || getComputedStyle(e).position === "fixed",
                        )
                        .map((e) => [e.id || e.textContent, e.getBoundingClientRect()])
                        .filter(
                            ([, box]) => box.width > 0 && (box.width < 43.5 || box.height < 43.5),
                        )
                        .map(([name, box]) => `${name}: ${box.width} x ${box.height}`);
                    const outside = [
                        ...document.querySelectorAll("#dock button, .panel:not([hidden])"),
                    ]
                        .map((e) => [e.id || e.dataset.panel, e.getBoundingClientRect()])
                        .filter(
                            ([, box]) =>
                                box.width > 0 &&
                                (box.left < 0 ||
                                    box.right > innerWidth + 0.5 ||
                                    box.top < 0 ||
                                    box.bottom > innerHeight + 0.5),
                        )
                        .map(([name, box]) => `${name}: ${JSON.stringify(box)}`);
                    return { small, outside };
                });
                assert.deepEqual(wrong, { small: [], outside: [] }, `${panel} at ${size}`);
                await other.evaluate(
                    (p) => document.querySelector(`#dock [data-panel=${p}]`).click(),
                    panel,
                );
            }
        }
        await phone.close();
    },

    async "help opens and closes by keys, and every control has a name"(page) {
        await page.focus("#picture");
        await page.keyboard.press("?");
        await page.waitForSelector("#help[open]");
        await page.keyboard.press("Escape");
        await page.waitForSelector("#help", { state: "hidden" });
        const nameless = await page.evaluate(() =>
            [...document.querySelectorAll("button, input, select")]
                .filter((control) => {
                    const words = control.getAttribute("aria-label") || control.textContent.trim();
                    return !words && !control.labels?.length && !control.hidden;
                })
                .map((control) => control.outerHTML),
        );
        assert.deepEqual(nameless, []);
    },
});
