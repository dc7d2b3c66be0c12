// Steps of page_test.mjs: what WebGL2 makes of frames whose scene is known.
import assert from "node:assert/strict";

const kView = {
    type: "v",
    position: [0, 0, 0],
    direction: [0, 1, 0],
    up: [0, 0, 1],
    horizontal: 60,
    vertical: 60,
};

/** Runs in the page: the largest difference of a frame, drawn at its own view, from its picture [0..255]. */
async function drawn_at_home(view) {
    const { Reprojection } = await import("/page/reprojection.js");
    const { kNumbers, kPatchRow } = await import("/page/depth.js");
    const size = 128,
        side = 32;
    const picture = new OffscreenCanvas(size, size);
    const context = picture.getContext("2d", { alpha: false });
    for (let x = 0; x < size; ++x) {
        context.fillStyle = `rgb(${2 * x} ${(37 * x) % 256} ${255 - 2 * x})`;
        context.fillRect(x, 0, 1, size);
    }
    // Each patch has other edges that are torn, and lies at another depth.
    const patches = new Uint16Array(kNumbers * kPatchRow);
    const across = size / side;
    for (let k = 0; k < across * across; ++k)
        patches.set(
            [side * (k % across), side * Math.floor(k / across), 5 + 16 * k, 100 * k],
            kNumbers * k,
        );
    const depth = { step: 0.001, count: across * across, patches };
    const canvas = document.createElement("canvas");
    const camera = new Reprojection(canvas);
    camera.keep({ picture, depth, view }, false);
    camera.draw(view, size, size);
    const shown = new OffscreenCanvas(size, size).getContext("2d");
    shown.drawImage(canvas, 0, 0);
    const [a, b] = [shown, context].map((from) => from.getImageData(0, 0, size, size).data);
    return a.reduce((most, value, k) => Math.max(most, Math.abs(value - b[k])), 0);
}

/**
 * Runs in the page: how frames of a third of the screen's width, of far stripes finer than their pixels can tell, correlate with the
 * stripes: after one frame, and after some whose views are parts of a pixel apart.
 */
async function fine_stripes(view) {
    const { Camera } = await import("/page/camera.js");
    const { kNumbers, kPatchRow } = await import("/page/depth.js");
    const size = 96,
        small = 32;
    // The stripes' colour at a place of the screen's picture [pixels]: a place to the right of a view's middle by `shift` of its width.
    const stripe = (x) => 128 + 100 * Math.sin(1.2 * x);
    const view_of = (shift) => ({ ...view, shift });
    const patches = new Uint16Array(kNumbers * kPatchRow);
    patches.set([0, 0, 5, 0]); // one, at infinity
    const depth = { step: 0.001, count: 1, patches };
    const canvas = document.createElement("canvas");
    const picture = new OffscreenCanvas(small, small);
    const context = picture.getContext("2d", { alpha: false });
    const camera = new Camera(canvas, picture, true, true);
    const correlation = () => {
        camera.draw(view_of(0), { width: size, height: size });
        const shown = new OffscreenCanvas(size, size).getContext("2d");
        shown.drawImage(canvas, 0, 0);
        const { data } = shown.getImageData(0, size / 2, size, 1);
        let [both, of_shown, of_stripes] = [0, 0, 0];
        for (let x = 8; x < size - 8; ++x) {
            const [a, b] = [data[4 * x] - 128, stripe(x + 0.5) - 128];
            both += a * b;
            of_shown += a * a;
            of_stripes += b * b;
        }
        return both / Math.sqrt(of_shown * of_stripes);
    };
    const found = [];
    for (let k = 0; k < 24; ++k) {
        const shift = (((k * 0.618034) % 1) - 0.5) / small;
        for (let x = 0; x < small; ++x) {
            const grey = Math.round(stripe((size / small) * (x + 0.5) + shift * size));
            context.fillStyle = `rgb(${grey} ${grey} ${grey})`;
            context.fillRect(x, 0, 1, small);
        }
        camera.take(view_of(shift), depth);
        found.push(correlation());
    }
    return { first: found[0], last: found.at(-1) };
}

export const camera_steps = () => ({
    async "a frame that is drawn at its own view is its picture"(page) {
        const most = await page.evaluate(drawn_at_home, kView);
        assert.ok(most <= 8, `off by ${most}`);
    },

    async "frames of few pixels are refined by those before them"(page) {
        const { first, last } = await page.evaluate(fine_stripes, kView);
        assert.ok(first < 0.7, `one frame cannot know the stripes, but correlates by ${first}`);
        assert.ok(last > 0.9, `frames correlate by ${last}`);
    },
});
