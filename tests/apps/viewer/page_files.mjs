// Steps of page_test.mjs: the scene's files are edited, well or not.
import assert from "node:assert/strict";
import { axe_complaints } from "./axe.mjs";
import { until } from "./page_helpers.mjs";

export const file_steps = (prank, npm) => ({
    async "an edited file is told, and what is wrong with one stands until it is mended"(page) {
        await prank("edit");
        await until(
            page,
            () =>
                document.querySelector("#notice").textContent ===
                "room.rad changed: 2 materials, 1 surface",
        );
        assert.ok(await page.isHidden("#trouble"));
        await prank("spoil");
        await page.waitForSelector("#trouble:not([hidden])");
        const text = await page.textContent("#troubles");
        assert.ok(text.includes("room.rad:12:") && text.includes("lampe"), text);
        assert.ok(await page.isHidden("#failure"));
        assert.deepEqual((await axe_complaints(page, npm)) ?? [], []);
        const other = await page.context().browser().newPage();
        await other.goto(page.url());
        await other.waitForSelector("#trouble:not([hidden])");
        await other.close();
        await page.bringToFront();
        await prank("mend");
        await page.waitForSelector("#trouble", { state: "hidden" });
    },
});
