// What the measurements of truth in motion share: the true pictures, and how pictures are compared.
import { spawnSync } from "node:child_process";
import { readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { fit_view } from "../apps/viewer/view.js";
import { view_line } from "../apps/viewer/view_text.js";
import { environment } from "./walk_setup.mjs";

export const kOff = 0.1 * 255; // of a channel: what counts as off
/** Draws true pictures of a scene, as data URLs, with files in a folder of its own. */
export function renderer(program, { folder, options, words }, [width, height], own_folder) {
    return async (view, exposure, seed = 0) => {
        const file = path.join(own_folder, "true");
        await writeFile(`${file}.vf`, `${view_line(fit_view(view, width, height))}\n`);
        const size = ["-x", width, "-y", height, "-ps", 1, "-pa", 0].map(String);
        const colours = ["--seed", seed, "--exposure", Math.log2(exposure)].map(String);
        const made = spawnSync(
            program,
            [
                ...["render", "--quiet", "-vf", `${file}.vf`, ...size, ...options, ...colours],
                ...["-o", `${file}.png`, ...words],
            ],
            { cwd: folder, env: environment },
        );
        if (made.status !== 0) throw new Error(String(made.stderr));
        return `data:image/png;base64,${(await readFile(`${file}.png`)).toString("base64")}`;
    };
}

/**
 * In a page of a browser: how far a frame is from the truth.
 * @param frame  {pieces: [{url, x, y}], size: [width, height], truth: url, most: how far a channel may be off}; the frame is
 *     enlarged to the truth's size
 * @returns {{psnr [dB], off [%], detail, picture}}: detail: correlation of the gradients; picture: the frame as a PNG in base64
 */
export async function compare({ pieces, size, truth, most }) {
    const canvas = (width, height) => {
        const made = new OffscreenCanvas(width, height);
        return [made, made.getContext("2d")];
    };
    const bitmap = async (url) => createImageBitmap(await (await fetch(url)).blob());
    const [frame, draw] = canvas(...size);
    for (const { url, x, y } of pieces) draw.drawImage(await bitmap(url), x, y);
    const right = await bitmap(truth);
    const pixels = (image) => {
        const [made, context] = canvas(right.width, right.height);
        context.drawImage(image, 0, 0, right.width, right.height);
        return [made, context.getImageData(0, 0, right.width, right.height).data];
    };
    const [shown, a] = pixels(frame);
    const [, b] = pixels(right);
    let [squares, off] = [0, 0];
    for (let k = 0; k < a.length; k += 4) {
        let worst = 0;
        for (let c = 0; c < 3; ++c) {
            const apart = Math.abs(a[k + c] - b[k + c]);
            squares += apart * apart;
            worst = Math.max(worst, apart);
        }
        if (worst > most) ++off;
    }
    let [both, of_a, of_b] = [0, 0, 0];
    for (const next of [4, 4 * right.width])
        for (let k = 1; k + next < a.length; k += 4) {
            const [p, q] = [a[k + next] - a[k], b[k + next] - b[k]];
            both += p * q;
            of_a += p * p;
            of_b += q * q;
        }
    const blob = await shown.convertToBlob({ type: "image/png" });
    return {
        psnr: 10 * Math.log10((255 * 255) / (squares / (0.75 * a.length))),
        off: (400 * off) / a.length,
        detail: both / Math.sqrt(of_a * of_b),
        picture: btoa(
            Array.from(new Uint8Array(await blob.arrayBuffer()), (c) =>
                String.fromCharCode(c),
            ).join(""),
        ),
    };
}
