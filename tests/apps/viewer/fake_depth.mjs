// Depth as the protocol has it, of a picture whose inverse depths a function tells: written from io/net/README.md alone.
import { deflateRawSync } from "node:zlib";

const folded = (difference) => {
    const wrapped = (difference << 16) >> 16;
    return ((wrapped << 1) ^ (wrapped >> 15)) & 0xffff;
};

/** Cut a square into patches: `inverse(x, y)` [steps] must be affine on each. */
function cut(inverse, width, y1, x, y, level, patches) {
    if (x >= width || y >= y1) return;
    const side = 1 << level,
        last = side - 1;
    if (x + side <= width && y + side <= y1) {
        const first = inverse(x, y);
        const slope_x = level ? (inverse(x + last, y) - first) / last : 0,
            slope_y = level ? (inverse(x, y + last) - first) / last : 0;
        let worst = 0;
        for (let v = 0; v < side; ++v)
            for (let u = 0; u < side; ++u) {
                const off = inverse(x + u, y + v) - first - slope_x * u - slope_y * v;
                worst = Math.max(worst, Math.abs(off));
            }
        // Two pixels lie on a plane even where one hides what the other shows.
        const steep = level === 1 && Math.max(Math.abs(slope_x), Math.abs(slope_y)) > 12;
        if (worst <= 2 && !steep) {
            const value = Math.round(first + ((slope_x + slope_y) * last) / 2);
            patches.push({
                x,
                y,
                level,
                edges: 0,
                value,
                slope_x: Math.round(64 * slope_x),
                slope_y: Math.round(64 * slope_y),
            });
            return;
        }
    }
    const half = side / 2;
    for (const [u, v] of [
        [0, 0],
        [half, 0],
        [0, half],
        [half, half],
    ])
        cut(inverse, width, y1, x + u, y + v, level - 1, patches);
}

/** The numbers of a band. */
function band(patches) {
    const shapes = [],
        columns = [[], [], [], [], [], []];
    let before = { value: 0, slope_x: 0, slope_y: 0, middle: [0, 0] };
    const put = (k, number) => {
        columns[k].push(number & 255);
        columns[k + 1].push(number >> 8);
    };
    for (const { x, y, level, guessed, edges, value, slope_x, slope_y } of patches) {
        shapes.push(level | (guessed ? 8 : 0) | (edges << 4));
        const middle = [2 * x + 2 ** level - 1, 2 * y + 2 ** level - 1];
        const ahead =
            (before.slope_x * (middle[0] - before.middle[0]) +
                before.slope_y * (middle[1] - before.middle[1])) >>
            7;
        put(0, folded(value - Math.max(0, Math.min(65535, before.value + ahead))));
        if (level > 0) {
            put(2, folded(slope_x - before.slope_x));
            put(4, folded(slope_y - before.slope_y));
            before = { ...before, slope_x, slope_y };
        }
        before = { ...before, value, middle };
    }
    const count = Buffer.alloc(4);
    count.writeUInt32LE(patches.length);
    return Buffer.concat([
        count,
        Buffer.from(shapes),
        ...columns.map((bytes) => Buffer.from(bytes)),
    ]);
}

/** A piece of given bands, each a list of patches. */
export function depth_of_bands(step, bands) {
    const head = Buffer.alloc(8);
    head.writeFloatLE(step, 0);
    head.writeUInt32LE(
        bands.reduce((sum, patches) => sum + patches.length, 0),
        4,
    );
    return Buffer.concat([head, deflateRawSync(Buffer.concat(bands.map(band)))]);
}

/** The patches of a picture, band by band. */
export function bands_of(inverse, width, height) {
    const bands = [];
    for (let y0 = 0; y0 < height; y0 += 64) {
        const patches = [];
        const y1 = Math.min(y0 + 64, height);
        for (let y = y0; y < y1; y += 32)
            for (let x = 0; x < width; x += 32) cut(inverse, width, y1, x, y, 5, patches);
        bands.push(patches);
    }
    return bands;
}
