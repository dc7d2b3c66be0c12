// What the steps of page_test.mjs have in common.
import { readFile } from "node:fs/promises";

export const kSize = { width: 800, height: 500 };

export const value = (page, name) => page.evaluate((n) => window.lightwalk[n], name);
export const until = (page, test, argument) =>
    page.waitForFunction(test, argument, { timeout: 20000 });
export const shown = (page) =>
    until(page, () => {
        const l = window.lightwalk;
        return l.ready && !l.moving && l.view_id > 0 && l.shown_view_id === l.view_id;
    });
export const gone = (a, b) => Math.hypot(...a.position.map((x, k) => x - b.position[k]));
export const heading = ({ direction: [x, y] }) => (Math.atan2(x, y) * 180) / Math.PI;

/**
 * Press a key for a while, and until the eye is elsewhere: a busy machine draws few refreshes, and the views that are sent in
 * motion run ahead of the eye. How far the eye went [m].
 */
export async function hold(page, key, ms = 400) {
    const before = await value(page, "eye");
    await page.keyboard.down(key);
    await page.waitForTimeout(ms);
    await until(
        page,
        ([x, y]) => {
            const { position, direction } = window.lightwalk.eye;
            const apart = (a, b) => Math.hypot(...a.map((value, k) => value - b[k]));
            return apart(position, x) > 0.25 || apart(direction, y) > 0.1;
        },
        [before.position, before.direction],
    );
    await page.keyboard.up(key);
    await shown(page);
    return gone(before, await value(page, "eye"));
}

/** How fast the eye goes at most while keys are held [m/s], by the refreshes' own clock. */
export async function speed_of(page, keys) {
    for (const key of keys) await page.keyboard.down(key);
    const fastest = await page.evaluate(
        () =>
            new Promise((resolve) => {
                const speeds = [];
                let last = null;
                const look = (time) => {
                    const [x, y] = window.lightwalk.eye.position;
                    if (last && time > last.time)
                        speeds.push(
                            (1000 * Math.hypot(x - last.x, y - last.y)) / (time - last.time),
                        );
                    last = { time, x, y };
                    if (speeds.length < 12) requestAnimationFrame(look);
                    else resolve(Math.max(...speeds));
                };
                requestAnimationFrame(look);
            }),
    );
    for (const key of keys.toReversed()) await page.keyboard.up(key);
    await shown(page);
    return fastest;
}

/** The text of the file that a click saves. */
export async function saved_text(page, button) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.click(button)]);
    return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
}

/** Draw an area and have its mean. */
export async function mean_over_area(page) {
    await page.evaluate(() => (window.lightwalk.last_mean = null));
    await page.keyboard.press("r");
    await page.mouse.move(300, 100);
    await page.mouse.down();
    await page.mouse.move(500, 200, { steps: 3 });
    await page.mouse.up();
    await until(page, () => window.lightwalk.last_mean?.luminance > 0);
}

/** Fingers on the picture, as Chromium's input layer has them. */
export async function touch(page, moves) {
    const line = await page.context().newCDPSession(page);
    const send = (type, points) =>
        line.send("Input.dispatchTouchEvent", {
            type,
            touchPoints: points.map(([x, y], id) => ({ x, y, id })),
        });
    await send("touchStart", moves[0]);
    for (const points of moves.slice(1)) await send("touchMove", points);
    await send("touchEnd", []);
    await line.detach();
    await shown(page);
}
