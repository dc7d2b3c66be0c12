// The bytes of a frame become what can be drawn: bitmaps, depth, luminance. Does not use the document: a worker does it, too.
import { background_of } from "./background.js";
import { decode_depth } from "./depth.js";

const kNumbers = 12; // bytes of the numbers before the JPEG of a luminance piece

const bitmap_of = ({ bytes, type }) => createImageBitmap(new Blob([bytes], { type }));

/** The numbers of a luminance piece, and its JPEG; null for a piece without bytes: there is none. Throws Error for bytes that are none. */
export function parse_luminance({ bytes }) {
    if (bytes.byteLength === 0) return null;
    if (bytes.byteLength < kNumbers) throw new Error("frame: its luminance is cut off");
    const data = new DataView(bytes.buffer, bytes.byteOffset, kNumbers);
    const [low, step, white] = [0, 4, 8].map((at) => data.getFloat32(at, true));
    if (![low, step, white].every(Number.isFinite) || !(step > 0) || white < 0)
        throw new Error("frame: its luminance has no sense");
    return { low, step, white, jpeg: bytes.subarray(kNumbers) };
}

async function decode_pieces(pieces) {
    const bitmaps = await Promise.all(pieces.map(bitmap_of));
    return pieces.map(({ x, y, width, height }, k) => ({
        ...{ x, y, width, height },
        bitmap: bitmaps[k],
    }));
}

async function decode_luminance(piece) {
    const plane = parse_luminance(piece);
    if (!plane) return null;
    const { jpeg, ...numbers } = plane;
    return { ...numbers, bitmap: await bitmap_of({ bytes: jpeg, type: "image/jpeg" }) };
}

/** Depth, and the sheet behind it. */
async function decode_surfaces(piece, width, height) {
    const depth = await decode_depth(piece, width, height);
    return depth && { ...depth, background: background_of(depth, width, height) };
}

/**
 * Decode a frame that parse_frame() returned. Throws Error for bytes that are none.
 * @returns {{pieces, depth, plane}}: pieces: each with its place and its bitmap; depth: as decode_depth() returns it, with what background_of()
 *     does; plane: parse_luminance()'s numbers and a bitmap. Of depth and plane null says that there is none any more, undefined that it is as before.
 */
export async function decode_frame({ width, height, pieces, depth, luminance }) {
    const [drawn, surfaces, plane] = await Promise.all([
        decode_pieces(pieces),
        depth ? decode_surfaces(depth, width, height) : undefined,
        luminance ? decode_luminance(luminance) : undefined,
    ]);
    return { pieces: drawn, depth: surfaces, plane };
}

/** What of a decoded frame passes from one thread to another without a copy. */
export function transferables({ pieces, depth, plane }) {
    const own = pieces.map(({ bitmap }) => bitmap);
    if (depth) own.push(depth.patches.buffer, depth.background.places.buffer);
    if (plane) own.push(plane.bitmap);
    return own;
}
