// How far away what a frame shows is: planar patches, decoded from the piece of a frame that io/net/README.md describes.

const kHeader = 8;
const kHighest = 5; // level of the largest patch: its side is 2^level pixels
const kBand = 64; // rows of pixels that are coded by themselves
/** Numbers of a patch in `patches`: x, y, level + 8 guessed + 16 edges, inverse depth, its slopes to the right and downward, 0, 0. */
export const kNumbers = 8;
/** `patches` are as many as fill rows of a texture; those beyond the frame's own are 0. */
export const kPatchRow = 512;

/** Inflate raw DEFLATE bytes that make up at most `most` bytes. Throws Error for others. */
async function inflated(bytes, most) {
    const reader = new Blob([bytes])
        .stream()
        .pipeThrough(new DecompressionStream("deflate-raw"))
        .getReader();
    const parts = [];
    let size = 0;
    for (;;) {
        const { done, value } = await reader.read();
        if (done) break;
        size += value.byteLength;
        if (size > most) {
            reader.cancel().catch(() => {});
            throw new Error("frame: its depth is too large");
        }
        parts.push(value);
    }
    const all = new Uint8Array(size);
    let at = 0;
    for (const part of parts) {
        all.set(part, at);
        at += part.byteLength;
    }
    return all;
}

/** 0, 1, 2, 3 ... of two bytes are 0, -1, 1, -2 ... */
const unfolded = (low, high) => {
    const number = low | (high << 8);
    return (number >> 1) ^ -(number & 1);
};

/** Fills the places of a band's patches, which follow from their levels, and checks them. */
class Places {
    constructor(out, width, y1, shapes) {
        Object.assign(this, { out, width, y1, shapes, next: 0 });
    }

    walk(x, y, level) {
        if (x >= this.width || y >= this.y1) return;
        if (this.next >= this.shapes.length) throw new Error("frame: its depth has holes");
        const shape = this.shapes[this.next];
        const side = 1 << level;
        if ((shape & 7) === level) {
            if (x + side > this.width || y + side > this.y1)
                throw new Error("frame: its depth lies outside");
            this.out.set([x, y, shape], kNumbers * this.next++);
            return;
        }
        if (level === 0) throw new Error("frame: its depth has a level that is none");
        const half = side >> 1;
        this.walk(x, y, level - 1);
        this.walk(x + half, y, level - 1);
        this.walk(x, y + half, level - 1);
        this.walk(x + half, y + half, level - 1);
    }
}

/** Fill in the inverse depths and slopes of a band's patches, whose places are known. */
function fill_values(out, count, bytes, values, slopes, sloping) {
    let value = 0,
        slope_x = 0,
        slope_y = 0,
        middle_x = 0,
        middle_y = 0,
        s = slopes;
    for (let k = 0, at = 0; k < count; ++k, at += kNumbers) {
        const level = out[at + 2] & 7,
            side = 1 << level;
        const x = 2 * out[at] + side - 1,
            y = 2 * out[at + 1] + side - 1;
        const ahead = (slope_x * (x - middle_x) + slope_y * (y - middle_y)) >> 7;
        const foretold = Math.max(0, Math.min(65535, value + ahead));
        value = (foretold + unfolded(bytes[values + k], bytes[values + count + k])) & 0xffff;
        out[at + 3] = value;
        middle_x = x;
        middle_y = y;
        if (level === 0) continue;
        const x_step = unfolded(bytes[s], bytes[s + sloping]);
        const y_step = unfolded(bytes[s + 2 * sloping], bytes[s + 3 * sloping]);
        slope_x = ((slope_x + x_step) << 16) >> 16;
        slope_y = ((slope_y + y_step) << 16) >> 16;
        out[at + 4] = slope_x;
        out[at + 5] = slope_y;
        ++s;
    }
}

/** Decode the bands of a picture into `patches`, which are `most`. Throws Error where the bytes are none. */
function fill_patches(patches, most, bytes, width, height) {
    const data = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    let at = 0,
        done = 0;
    for (let y0 = 0; y0 < height; y0 += kBand) {
        if (at + 4 > bytes.length) throw new Error("frame: its depth is cut off");
        const count = data.getUint32(at, true);
        at += 4;
        if (at + 3 * count > bytes.length || done + count > most)
            throw new Error("frame: its depth is cut off");
        const shapes = bytes.subarray(at, at + count);
        const out = patches.subarray(kNumbers * done, kNumbers * (done + count));
        const y1 = Math.min(y0 + kBand, height);
        const places = new Places(out, width, y1, shapes);
        for (let y = y0; y < y1; y += 1 << kHighest)
            for (let x = 0; x < width; x += 1 << kHighest) places.walk(x, y, kHighest);
        if (places.next !== count) throw new Error("frame: its depth has too many patches");
        let sloping = 0;
        for (const shape of shapes) if ((shape & 7) !== 0) ++sloping;
        const values = at + count;
        const slopes = values + 2 * count;
        at = slopes + 4 * sloping;
        if (at > bytes.length) throw new Error("frame: its depth is cut off");
        fill_values(out, count, bytes, values, slopes, sloping);
        done += count;
    }
    if (at !== bytes.length || done !== most) throw new Error("frame: bytes after its depth");
}

/**
 * Decode the depth of a picture of width x height pixels.
 * @returns {{step, count, patches}}: step: unit of inverse depth [1/m]; patches: Uint16Array of kNumbers for each patch (slopes
 *     are 16 bits with a sign), whole rows of kPatchRow. Nothing for a piece without bytes: the view has no depth. Throws Error for bytes that are none.
 */
export async function decode_depth(piece, width, height) {
    const { bytes } = piece;
    if (bytes.byteLength === 0) return null;
    if (bytes.byteLength < kHeader) throw new Error("frame: its depth is cut off");
    const data = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const step = data.getFloat32(0, true);
    const count = data.getUint32(4, true);
    if (!(step > 0 && step < Infinity) || count === 0 || count > width * height)
        throw new Error("frame: its depth has no sense");
    const most = 4 * Math.ceil(height / kBand) + 7 * count;
    const patches = new Uint16Array(kNumbers * kPatchRow * Math.ceil(count / kPatchRow));
    fill_patches(patches, count, await inflated(bytes.subarray(kHeader), most), width, height);
    return { step, count, patches };
}
