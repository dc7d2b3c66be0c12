// Steps of page_test.mjs: the camera of now, while frames are ahead of the eye and at rest.
import assert from "node:assert/strict";
import { fit_view, locate } from "../../../apps/viewer/view.js";
import { heading, hold, kSize, shown, until, value } from "./page_helpers.mjs";

/**
 * What is on the canvas of the camera, at a refresh that is hardly black anywhere, if one of the next 100 is such: where
 * all else is slow the newest frame may be far away for a while. Runs in the page.
 */
function drawn_camera() {
    const look = () => {
        const canvas = document.createElement("canvas");
        const [w, h] = [(canvas.width = 40), (canvas.height = 25)];
        const context = canvas.getContext("2d");
        context.drawImage(document.querySelector("#camera"), 0, 0, w, h);
        const { data } = context.getImageData(0, 0, w, h);
        const dark = data.filter((x, k) => k % 4 === 1 && x < 8).length / (w * h);
        const { eye, shown_view, frame_view, view, camera_draws } = window.lightwalk;
        const hidden = document.querySelector("#camera").hidden;
        return { eye, shown_view, frame_view, view, camera_draws, hidden, dark };
    };
    return new Promise((resolve) => {
        let left = 100;
        // In the same refresh in which it was drawn the canvas can be read.
        const refreshed = () => {
            const seen = look();
            const good = seen.camera_draws && !seen.hidden && seen.dark < 0.02;
            if (good || --left === 0) resolve(seen);
            else requestAnimationFrame(refreshed);
        };
        requestAnimationFrame(refreshed);
    });
}

export const eye_steps = (address) => ({
    async "while the eye moves the page draws what it sees, and at rest shows the frame"(page) {
        const before = await value(page, "refreshes");
        await page.focus("#picture");
        await page.keyboard.down("ArrowRight");
        await until(page, (n) => window.lightwalk.refreshes > n + 5, before);
        const seen = await page.evaluate(drawn_camera);
        assert.ok(seen.camera_draws && !seen.hidden && seen.dark < 0.02, `${seen.dark} is black`);
        // What is drawn is what the eye sees; what is asked for is ahead of it, and wider.
        assert.ok(Math.abs(heading(seen.eye) - heading(seen.shown_view)) < 0.01);
        assert.ok(heading(seen.view) > heading(seen.eye));
        assert.ok(seen.view.horizontal > seen.shown_view.horizontal);
        await page.keyboard.up("ArrowRight");
        await shown(page);
        await until(page, () => !window.lightwalk.camera_draws);
        assert.ok(await page.isHidden("#camera"));
        const { width, height } = kSize;
        const rest = await value(page, "shown_view");
        assert.deepEqual(rest, fit_view(await value(page, "eye"), width, height));
        assert.ok(await value(page, "decodes_beside"));
    },

    async "a drag that is held still comes to rest, and goes on with the pointer"(page) {
        await page.mouse.move(400, 250);
        const [before] = (await value(page, "eye")).direction;
        await page.mouse.down();
        await page.mouse.move(440, 250, { steps: 4 });
        await until(page, (x) => window.lightwalk.eye.direction[0] !== x, before);
        await shown(page);
        await until(page, () => window.lightwalk.at_rest && !window.lightwalk.camera_draws);
        const { width, height } = kSize;
        const rest = fit_view(await value(page, "eye"), width, height);
        assert.deepEqual(await value(page, "view"), rest);
        await page.mouse.move(480, 250, { steps: 4 });
        await page.mouse.up();
        await shown(page);
        assert.ok(heading(await value(page, "view")) < heading(rest) - 1);
    },

    async "a watcher sees what the driver sees, also while frames are ahead of the eye"(page) {
        const other = await page.context().browser().newPage({ viewport: kSize });
        await other.goto(address);
        await until(other, () => window.lightwalk?.frames > 0 && !window.lightwalk.driving);
        await page.focus("#picture");
        await page.keyboard.down("ArrowRight");
        await until(other, () => window.lightwalk.camera_draws);
        const { shown_view, frame_view } = await other.evaluate(() => ({ ...window.lightwalk }));
        const { width, height } = kSize;
        const eye = fit_view(await value(page, "eye"), width, height);
        assert.ok(Math.abs(shown_view.horizontal - eye.horizontal) < 1e-9);
        assert.ok(frame_view.horizontal > eye.horizontal);
        assert.ok(heading(frame_view) > heading(shown_view));
        await page.keyboard.up("ArrowRight");
        await shown(page);
        const rest = await value(page, "view");
        await until(
            other,
            (v) => window.lightwalk.shown_view?.direction[0] === v,
            rest.direction[0],
        );
        await until(other, () => !window.lightwalk.camera_draws);
        assert.deepEqual(await value(other, "shown_view"), rest);
        await other.close();
    },

    async "a point is read where it is seen, also while the eye moves"(page) {
        await page.focus("#picture");
        await page.keyboard.down("ArrowLeft");
        await until(page, () => window.lightwalk.camera_draws);
        await page.evaluate(() => (window.lightwalk.last_pick = null));
        const asked = page.evaluate(() => {
            document.activeElement.dispatchEvent(
                new KeyboardEvent("keydown", { key: "Enter", bubbles: true }),
            );
            return window.lightwalk.shown_view;
        });
        await until(page, () => window.lightwalk.last_pick);
        const { position } = await value(page, "last_pick");
        await page.keyboard.up("ArrowLeft");
        const at = locate(await asked, position);
        assert.ok(Math.hypot(at.x - 0.5, at.y - 0.5) < 1e-3, `${at.x}, ${at.y}`);
        await shown(page);
    },

    async "a lost graphics memory is no fault"(page) {
        const lose = (what) =>
            page.evaluate((name) => {
                const context = document.querySelector("#camera").getContext("webgl2");
                window.loss ??= context.getExtension("WEBGL_lose_context");
                window.loss[name]();
            }, what);
        await lose("loseContext");
        assert.ok((await hold(page, "w")) > 0.1);
        assert.equal(await value(page, "camera_draws"), false);
        await lose("restoreContext");
        const before = await value(page, "refreshes");
        await hold(page, "s");
        assert.ok((await value(page, "refreshes")) > before);
    },

    async "frames are shown as they come where the address says so"(page) {
        await page.goto(`${address}?plain`);
        await shown(page);
        assert.ok((await hold(page, "w")) > 0.1);
        assert.equal(await value(page, "refreshes"), 0);
        await page.goto(address);
        await shown(page);
    },
});
