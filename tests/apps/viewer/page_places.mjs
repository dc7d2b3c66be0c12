// Steps of page_test.mjs: how one gets to places: addresses, clicks, paths, thumbs.
import assert from "node:assert/strict";
import { fragment_view } from "../../../apps/viewer/address.js";
import { parse_keys } from "../../../apps/viewer/view_text.js";
import { gone, heading, hold, kSize, saved_text, shown, until, value } from "./page_helpers.mjs";

export const place_steps = (address) => ({
    async "the address is the view, and the browser goes back and forward along views that were chosen"(
        page,
    ) {
        const hash = () => page.evaluate(() => location.hash);
        const rests = async (before) => {
            await until(page, (text) => location.hash !== text, before);
            return hash();
        };
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
        await page.waitForTimeout(800);
        const first = await hash();
        assert.match(first, /^#vp=3,-2\.2,1\.6&vd=/);
        await page.keyboard.press("2");
        const second = await rests(first);
        await hold(page, "w");
        const walked = await rests(second);
        await page.goBack();
        await until(page, (text) => location.hash === text, first);
        await shown(page);
        assert.ok(gone(fragment_view(first), await value(page, "view")) < 1e-4);
        await page.goForward();
        await page.waitForTimeout(100);
        await shown(page);
        assert.ok(gone(fragment_view(walked), await value(page, "view")) < 1e-4);
        const link = "#vp=1,-1,1.6&vd=0.6,0.8,0&vh=60";
        const other = await page.context().browser().newPage();
        await other.goto(address + link);
        await until(other, () => window.lightwalk?.connected && !window.lightwalk.driving);
        await other.waitForTimeout(500);
        assert.equal(await other.evaluate(() => location.hash), link, "a watcher's link is kept");
        await other.close();
        await page.evaluate((text) => (location.hash = text), link);
        await page.waitForTimeout(100);
        await shown(page);
        assert.ok(gone(fragment_view(link), await value(page, "view")) < 1e-4);
        await page.reload();
        await shown(page);
        assert.ok(gone(fragment_view(link), await value(page, "view")) < 1e-4);
    },

    async "a double click goes to the floor, or near a wall; looking level is a key and a button"(
        page,
    ) {
        await page.keyboard.press("2");
        await page.waitForTimeout(100);
        await shown(page);
        const before = await value(page, "view");
        await page.mouse.dblclick(500, 430);
        await until(page, (y) => window.lightwalk.view.position[1] > y + 0.3, before.position[1]);
        await shown(page);
        const floor = await value(page, "view");
        assert.ok(Math.abs(floor.position[2] - 1.6) < 1e-6);
        assert.ok(Math.abs(heading(floor) - heading(before)) < 1e-6);
        assert.ok(await page.isHidden("#reading"));
        for (const act of [() => page.keyboard.press("t"), () => page.click("#level")]) {
            await page.focus("#picture");
            await hold(page, "PageDown");
            assert.ok((await value(page, "view")).direction[2] < -0.05);
            await page.mouse.move(300, 300); // the dock has faded
            await act();
            await until(page, () => Math.abs(window.lightwalk.view.direction[2]) < 1e-9);
            await shown(page);
        }
        await page.keyboard.press("3");
        await page.waitForTimeout(100);
        await shown(page);
        await page.mouse.dblclick(300, 200);
        await until(page, () => window.lightwalk.view.position[0] < -1.5);
        await shown(page);
        assert.ok((await value(page, "view")).position[0] > -3.5, "through the wall");
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
    },

    async "a drag between two clicks makes no double click of them"(page) {
        await page.keyboard.press("2");
        await page.waitForTimeout(500);
        await shown(page);
        const before = await value(page, "eye");
        // All at one time: a busy machine would take too long for a double click.
        await page.evaluate(() => {
            const event = (type, x) =>
                new PointerEvent(type, {
                    ...{ clientX: x, clientY: 430, bubbles: true },
                    pointerId: 1,
                });
            const surface = document.querySelector("#picture");
            surface.setPointerCapture = () => {};
            const press = (...places) => {
                surface.dispatchEvent(event("pointerdown", places[0]));
                for (const x of places) surface.dispatchEvent(event("pointermove", x));
                surface.dispatchEvent(event("pointerup", places.at(-1)));
            };
            press(500);
            press(500, 520, 500);
            press(500);
            delete surface.setPointerCapture;
        });
        await page.waitForTimeout(500);
        await shown(page);
        assert.ok(gone(before, await value(page, "eye")) < 1e-6, "it went there");
        await page.keyboard.press("Escape");
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
    },

    async "full screen by a key"(page) {
        await page.focus("#picture");
        await page.keyboard.press("z");
        await until(page, () => document.fullscreenElement !== null);
        await page.waitForSelector("#full-screen[aria-pressed=true]");
        await page.keyboard.press("z");
        await until(page, () => document.fullscreenElement === null);
        await page.setViewportSize(kSize);
        await shown(page);
    },

    async "a path is recorded, played, scrubbed, saved and opened again"(page) {
        const idle = () => until(page, () => !window.lightwalk.moving);
        await page.keyboard.press("2");
        await page.waitForTimeout(100);
        await shown(page);
        const from = await value(page, "view");
        await page.focus("#picture");
        await page.keyboard.press("j");
        await hold(page, "w", 500);
        await hold(page, "ArrowRight", 500);
        await page.keyboard.press("j");
        await page.waitForSelector("#notice >> text=Recorded");
        const to = await value(page, "view");
        await page.keyboard.press("v");
        const count = await page.locator("#keys li").count();
        assert.ok(count >= 3 && count < 30, `${count} keys`);
        const text = await saved_text(page, "#write-path");
        assert.match(
            await page.textContent("#path-text"),
            /lightwalk animate --path room-.*\.path\.vf -o room-.*\.mp4 room\/room\.rad/,
        );
        const keys = parse_keys(String(text.bytes));
        assert.ok(
            gone(keys[0].view, from) < 0.02,
            `begins at ${keys[0].view.position}, not ${from.position}`,
        );
        assert.ok(
            gone(keys.at(-1).view, to) < 0.02,
            `ends at ${keys.at(-1).view.position}, not ${to.position}`,
        );

        await page.selectOption("#path-speed", "4");
        await page.click("#play-path");
        await until(page, () => document.querySelector("#play-path").textContent === "Pause");
        await until(page, () => document.querySelector("#play-path").textContent === "Play");
        await idle();
        assert.ok(gone(await value(page, "view"), to) < 0.02);

        await page.locator("#path-time").fill("0");
        await until(
            page,
            (p) => Math.hypot(...window.lightwalk.view.position.map((x, k) => x - p[k])) < 0.02,
            from.position,
        );
        await page.selectOption("#path-speed", "0.25");
        await page.click("#play-path");
        await page.focus("#picture");
        await page.keyboard.press("a", { delay: 100 });
        await until(page, () => document.querySelector("#play-path").textContent === "Play");
        const time = Number(await page.inputValue("#path-time"));
        assert.ok(time < keys.at(-1).time / 2, "a hand stops the path");

        await page.click("#clear-path");
        assert.ok(await page.isDisabled("#play-path"));
        const file = { name: "walk.vf", mimeType: "text/plain", buffer: text.bytes };
        await page.setInputFiles("#path-file", file);
        await until(page, (n) => document.querySelectorAll("#keys li").length === n, count);
        await idle();
        assert.ok(gone(await value(page, "view"), from) < 0.02);
        await page.setInputFiles("#path-file", {
            ...file,
            buffer: Buffer.from("3 VIEW= -vp 1 2 3\n2 VIEW= -vp 0 0 0\n"),
        });
        await page.waitForSelector("#notice >> text=times of a path must rise");
        await page.reload();
        await shown(page);
        await page.keyboard.press("v");
        assert.equal(await page.locator("#keys li").count(), count, "not kept in the browser");
        await page.click("#clear-path");
        await page.keyboard.press("Escape");
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
    },

    async "the plan shows where the eye is, and a click or the keys go there"(page) {
        /** Where a place of the scene is on the screen: the fake plan is 10 x 8 m around the origin. */
        const place = async (x, y) => {
            const box = await page.locator("#plan").boundingBox();
            const scale = Math.min(box.width / 10, box.height / 8);
            return [box.x + box.width / 2 + x * scale, box.y + box.height / 2 - y * scale];
        };
        const marks_eye = async () => {
            const [x, y] = (await value(page, "eye")).position;
            const wanted = await place(x, y);
            const box = await page.locator("#plan-marks .eye").boundingBox();
            const off = [box.x + box.width / 2 - wanted[0], box.y + box.height / 2 - wanted[1]];
            assert.ok(Math.hypot(...off) < 1.5, `the eye's dot is off by ${off}`);
        };
        const goes = (x, y) =>
            until(
                page,
                ([a, b]) => {
                    const { moving, view } = window.lightwalk;
                    return !moving && Math.hypot(view.position[0] - a, view.position[1] - b) < 0.06;
                },
                [x, y],
            );
        const asked = async () => Number(await (await fetch(`${address}fake/plans`)).text());
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
        await page.focus("#picture");
        await page.keyboard.press("n");
        await page.waitForSelector("#plan-marks .eye");
        await marks_eye();
        const before = await value(page, "view");
        await page.mouse.click(...(await place(0.5, -2)));
        await goes(0.5, -2);
        await shown(page);
        const there = await value(page, "view");
        assert.ok(Math.abs(heading(there) - heading(before)) < 1e-6);
        assert.ok(Math.abs(there.position[2] - 1.6) < 1e-6);
        await marks_eye();
        await page.focus("#picture");
        assert.ok((await hold(page, "a")) > 0.1);
        await marks_eye();
        assert.match(await page.getAttribute("#plan", "aria-label"), /from the left.*north-west/);
        await page.mouse.click(...(await place(-3.98, 0)));
        await page.waitForSelector("#notice >> text=A wall is there");

        await page.mouse.click(...(await place(0.5, -2)));
        await goes(0.5, -2);
        await page.focus("#plan");
        for (let k = 0; k < 4; ++k) await page.keyboard.press("ArrowUp");
        assert.match(await page.textContent("#plan-text"), /^1\.\d\d m north$/);
        await page.keyboard.press("Enter");
        await goes(0.5, -0.4);

        const count = await asked();
        await page.focus("#picture");
        await page.keyboard.down("e");
        await until(page, () => window.lightwalk.view.position[2] > 2.6);
        await page.keyboard.up("e");
        await until(
            page,
            async (n) => Number(await (await fetch("/fake/plans")).text()) > n,
            count,
        );
        await page.keyboard.press("g");
        await until(page, () => Math.abs(window.lightwalk.shown_view?.position[2] - 1.6) < 1e-9);
        const again = await asked();
        await fetch(`${address}fake/reload`);
        await until(
            page,
            async (n) => Number(await (await fetch("/fake/plans")).text()) > n,
            again,
        );
        await page.waitForSelector("#plan-marks .eye");
        await shown(page);
        await page.keyboard.press("Escape");
        assert.ok(await page.isHidden("#panel-plan"));
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
    },

    async "one thumb moves, the other looks"(page) {
        const line = await page.context().newCDPSession(page);
        const send = (type, ...points) =>
            line.send("Input.dispatchTouchEvent", {
                type,
                touchPoints: points.map(([id, x, y]) => ({ x, y, id })),
            });
        const start = await value(page, "view");
        await send("touchStart", [0, 150, 350]);
        await send("touchMove", [0, 150, 300]);
        await page.waitForSelector("#stick:not([hidden])");
        await page.waitForTimeout(400);
        await send("touchStart", [0, 150, 300], [1, 600, 250]);
        await send("touchMove", [0, 150, 300], [1, 640, 250]);
        await send("touchMove", [0, 150, 300], [1, 700, 250]);
        await page.waitForTimeout(200);
        await send("touchEnd", [0, 150, 300]);
        await send("touchEnd");
        await page.waitForSelector("#stick", { state: "hidden" });
        await shown(page);
        const end = await value(page, "view");
        assert.ok(gone(start, end) > 0.3, "the left thumb did not move the eye");
        assert.ok(heading(end) < heading(start) - 5, "the right thumb did not turn it");
        assert.ok(Math.abs(end.horizontal - start.horizontal) < 1e-9, "the lens changed");
        await line.detach();
        await page.keyboard.press("1");
        await page.waitForTimeout(100);
        await shown(page);
    },
});
