// Steps of page_test.mjs: illuminances on planes, and their contours over the picture.
import assert from "node:assert/strict";
import { contours_of, read_grid, statistics } from "../../../apps/viewer/isolux.js";
import { strokes_of } from "../../../apps/viewer/strokes.js";
import { quantity } from "../../../apps/viewer/words.js";
import { axe_complaints } from "./axe.mjs";
import { lamp_illuminance } from "./fake_isolux.mjs";
import { direction_at, look } from "./fake_scene.mjs";
import { kSize, saved_text, shown, until, value } from "./page_helpers.mjs";

const final = (page) =>
    until(page, () => document.querySelector("#isolux-text").textContent.endsWith("Final."));

/** Opens the panel and measures a plane, where the steps before have left neither. */
async function have_isolux(page) {
    if (!(await page.isVisible("#isolux-height"))) await page.click("#dock [data-panel=measure]");
    if (await value(page, "last_isolux")) return;
    await page.fill("#isolux-height", "0.75");
    await page.click("#isolux-floor");
    await final(page);
}

/** The contours over the picture: {level: points on the screen}. The labels are in the order of the lines that have one. */
const drawn = (page) =>
    page.evaluate(() =>
        [...document.querySelectorAll("#overlay .contour")].map((path) =>
            [...path.getAttribute("d").matchAll(/([\d.-]+) ([\d.-]+)/g)].map((m) => [+m[1], +m[2]]),
        ),
    );

/** The illuminances of the places of a level plane that points of the screen show. */
function lux_at(points, view, z) {
    return points.map(([x, y]) => {
        const way = direction_at(view, x / kSize.width, 1 - y / kSize.height);
        const far = (z - view.position[2]) / way[2];
        return lamp_illuminance(
            view.position.map((p, k) => p + far * way[k]),
            [0, 0, 1],
        );
    });
}

export const isolux_steps = (prank, npm) => ({
    async "isolux of a level plane: contours where their illuminance is, and its figures"(page) {
        await page.keyboard.press("1");
        await shown(page);
        await page.mouse.move(300, 300);
        await page.click("#dock [data-panel=measure]");
        await page.fill("#isolux-height", "-1");
        await page.click("#isolux-floor");
        await page.waitForSelector("text=The height must be a number");
        await page.fill("#isolux-height", "0,75");
        await page.keyboard.press("Enter");
        await until(page, () =>
            document.querySelector("#isolux-text").textContent.includes("Coarse"),
        );
        await page.waitForSelector("#isolux-figures.unsettled");
        await final(page);
        const grid = read_grid(await value(page, "last_isolux"));
        const figures = statistics(grid);
        const plain = (x) => quantity(x).replaceAll("\u202f", "");
        const words = await page.textContent("#isolux-figures");
        const spaced = words.replaceAll("\u202f", "");
        assert.ok(spaced.includes(`Mean${plain(figures.mean)} lx ±2%`), words);
        assert.ok(spaced.includes(`Minimum${plain(figures.min)} lx ±4%`), words);
        assert.ok(spaced.includes(`Maximum${plain(figures.max)} lx ±<1%`), words);
        assert.ok(words.includes(`(min/mean)${figures.uniformity.toFixed(2)} ±`), words);
        assert.match(await page.textContent("#isolux-text"), /^0\.75 m above the floor\. /);
        assert.deepEqual((await axe_complaints(page, npm)) ?? [], []);
        const contours = await drawn(page);
        assert.ok(contours.length >= 3, `${contours.length} contours`);
        const view = await value(page, "shown_view");
        for (const points of contours) {
            const lux = lux_at(points, view, 0.75);
            const spread = Math.max(...lux) / Math.min(...lux);
            assert.ok(spread < 1.1, `${Math.min(...lux)} to ${Math.max(...lux)} lx on one contour`);
        }
        const labels = await page.locator("#overlay text").allTextContents();
        assert.ok(
            labels.some((label) => /^\d+ lx$/.test(label)),
            labels.join(),
        );
    },

    async "isolux stay in their places when the eye turns, hidden by what stands before them"(
        page,
    ) {
        await have_isolux(page);
        await page.fill("#isolux-height", "0");
        await page.click("#isolux-floor");
        await final(page);
        await page.mouse.move(200, 200);
        await page.mouse.down();
        await page.mouse.move(230, 200, { steps: 4 });
        await page.mouse.up();
        await shown(page);
        await until(page, () => !window.lightwalk.camera_draws);
        const view = await value(page, "shown_view");
        const seen = await drawn(page);
        for (const points of seen) {
            const lux = lux_at(points, view, 0);
            assert.ok(Math.max(...lux) / Math.min(...lux) < 1.1);
            for (const [x, y] of points) {
                if (!(x > 0 && x < kSize.width && y > 0 && y < kSize.height)) continue;
                const way = direction_at(view, x / kSize.width, 1 - y / kSize.height);
                const far = -view.position[2] / way[2];
                const { t } = look(view.position, way);
                assert.ok(t > 0.9 * far, `${x}, ${y} is drawn over what is nearer: ${t} ${far}`);
            }
        }
        const contours = contours_of(read_grid(await value(page, "last_isolux")));
        const size = [kSize.width, kSize.height];
        const all = contours
            .flatMap(({ lines }) => lines)
            .flatMap((line) => strokes_of(view, line, size, () => false));
        const kept = seen.flat().length;
        assert.ok(kept > 50 && kept < 0.9 * all.flat().length, `${kept} of ${all.flat().length}`);
        await page.fill("#isolux-height", "0.75");
        await page.click("#isolux-floor");
        await final(page);
    },

    async "isolux of a scene that is read again are out of date until they are measured again"(
        page,
    ) {
        await have_isolux(page);
        const mean = async () => statistics(read_grid(await value(page, "last_isolux"))).mean;
        const before = await mean();
        await prank("reload");
        await page.waitForSelector("#isolux-text >> text=Out of date: the scene is read again.");
        await page.waitForSelector("#overlay .contour.outdated", { state: "attached" });
        await final(page);
        assert.ok(Math.abs((await mean()) / before - 2) < 1e-3);
        assert.equal(await page.locator("#overlay .contour.outdated").count(), 0);
    },

    async "isolux are saved as a table, and as points for rtrace with the command"(page) {
        await have_isolux(page);
        const { count } = statistics(read_grid(await value(page, "last_isolux")));
        const table = await saved_text(page, "#write-isolux");
        assert.match(table.name, /\.isolux\.csv$/);
        const rows = String(table.bytes).trimEnd().split("\r\n");
        assert.equal(rows.length, count + 1);
        assert.match(rows[1], /^-?[\d.]+,-?[\d.]+,0\.75,[\d.]+,1,room\/room\.rad,/);
        const points = await saved_text(page, "#write-points");
        assert.equal(String(points.bytes).trimEnd().split("\n").length, count);
        const command = await page.textContent("#isolux-command code");
        assert.ok(command.includes(`< '${points.name}'`) || command.includes(`< ${points.name}`));
    },

    async "a surface for isolux is chosen by keys, and what has no plane says so"(page) {
        await have_isolux(page);
        await page.click("#clear-isolux");
        assert.equal(await page.locator("#overlay .contour").count(), 0);
        assert.ok(await page.isHidden("#isolux-files"));
        await page.click("#dock [data-panel=measure]");
        await page.keyboard.press("3");
        await page.waitForTimeout(100);
        await shown(page);
        await page.focus("#picture");
        await page.keyboard.press("c");
        assert.equal(await page.getAttribute("#isolux-surface", "aria-pressed"), "true");
        await page.keyboard.press("Escape");
        assert.equal(await page.getAttribute("#isolux-surface", "aria-pressed"), "false");
        await page.keyboard.press("c");
        await page.keyboard.press("Enter");
        await page.waitForSelector("#isolux-text >> text=On west_wall, plaster. There is no plane");
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
        await page.keyboard.press("c");
        await page.mouse.click(60, 430);
        await final(page);
        assert.match(await page.textContent("#isolux-text"), /^On floor, oak\. /);
        await page.click("#clear-isolux");
        await page.click("#dock [data-panel=measure]");
        await page.focus("#picture");
    },
});
