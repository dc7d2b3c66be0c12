// Frames as the protocol has them, of the fake room: JPEG and PNG pieces.
import { deflateSync } from "node:zlib";
import { bands_of, depth_of_bands } from "./fake_depth.mjs";
import {
    depth_along,
    directions_of,
    exposure_of,
    kWhite,
    look,
    luminance_of,
    paint,
} from "./fake_scene.mjs";

const kMoving = 200; // pixels across while moving
export const kStrips = 8; // pieces of a picture at rest

const crc_table = Array.from({ length: 256 }, (_, n) => {
    for (let k = 0; k < 8; ++k) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
    return n >>> 0;
});

function crc32(bytes) {
    let c = ~0;
    for (const b of bytes) c = crc_table[(c ^ b) & 255] ^ (c >>> 8);
    return ~c >>> 0;
}

function png_chunk(name, data) {
    const body = Buffer.concat([Buffer.from(name), data]),
        chunk = Buffer.alloc(body.length + 8);
    chunk.writeUInt32BE(data.length, 0);
    body.copy(chunk, 4);
    chunk.writeUInt32BE(crc32(body), body.length + 4);
    return chunk;
}

function png(rgba, width, height) {
    const rows = Buffer.alloc((width * 4 + 1) * height);
    for (let y = 0; y < height; ++y)
        rgba.copy(rows, y * (width * 4 + 1) + 1, y * width * 4, (y + 1) * width * 4);
    const head = Buffer.alloc(13);
    head.writeUInt32BE(width, 0);
    head.writeUInt32BE(height, 4);
    head.set([8, 6, 0, 0, 0], 8);
    return Buffer.concat([
        Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]),
        png_chunk("IHDR", head),
        png_chunk("IDAT", deflateSync(rows, { level: 1 })),
        png_chunk("IEND", Buffer.alloc(0)),
    ]);
}

export function frame_bytes(number, wish, eye, flags, pieces, display) {
    const head = Buffer.alloc(48);
    head.write("LWF1", 0, "latin1");
    head.writeUInt32LE(number, 4);
    head.writeUInt32LE(wish.id, 8);
    head.writeUInt16LE(wish.width, 12);
    head.writeUInt16LE(wish.height, 14);
    head.writeUInt8(flags, 16);
    head.writeUInt8(display.number ?? 0, 17);
    head.writeUInt16LE(pieces.length, 18);
    head.writeFloatLE(exposure_of(display), 20);
    eye.forEach((x, k) => head.writeDoubleLE(x, 24 + 8 * k));
    const parts = [head];
    for (const { x, y, width, height, codec, bytes } of pieces) {
        const piece = Buffer.alloc(16);
        [x, y, width, height].forEach((v, k) => piece.writeUInt16LE(v, 2 * k));
        piece.writeUInt8(codec, 8);
        piece.writeUInt32LE(bytes.length, 12);
        parts.push(piece, bytes);
    }
    return Buffer.concat(parts);
}

const kKept = 400; // pieces: some ten megabytes
const kept = new Map();

/** What `make` made of the same words before, which pages ask for again and again. */
function once(words, make) {
    const key = JSON.stringify(words);
    const piece = kept.get(key) ?? make();
    kept.delete(key); // the newest ones are last
    kept.set(key, piece);
    if (kept.size > kKept) kept.delete(kept.keys().next().value);
    return piece;
}

/** The whole picture at once, coarse: one JPEG that the page stretches. */
export function coarse_pieces(jpeg, view, { width, height }, display) {
    const painted = () => painted_coarse(jpeg, view, { width, height }, display);
    return [once(["coarse", view, width, height, display], painted)];
}

function painted_coarse(jpeg, view, { width, height }, display) {
    const share = Math.min(1, kMoving / width),
        w = Math.max(1, Math.round(width * share)),
        h = Math.max(1, Math.round(height * share));
    const data = paint(view, w, h, 0, h, display);
    const { data: bytes } = jpeg.encode({ data, width: w, height: h }, 80);
    return { x: 0, y: 0, width, height, codec: 1, bytes };
}

/** One strip in full; the last one as JPEG, so that both codecs are in use: its encoder here is slow. */
export function strip_piece(jpeg, view, { width, height }, k, display) {
    return once([k, view, width, height, display], () =>
        painted_strip(jpeg, view, { width, height }, k, display),
    );
}

function painted_strip(jpeg, view, { width, height }, k, display) {
    const from = Math.floor((k * height) / kStrips),
        to = Math.floor(((k + 1) * height) / kStrips);
    const data = paint(view, width, height, from, to, display);
    const codec = k < kStrips - 1 ? 2 : 1;
    const bytes =
        codec === 2
            ? png(data, width, to - from)
            : jpeg.encode({ data, width, height: to - from }, 92).data;
    return { x: 0, y: from, width, height: to - from, codec, bytes };
}

/** How far away what a picture shows is; the same for each four by four pixels. */
export function depth_piece(view, { width, height }) {
    return once(["depth", view, width, height], () => depth_of(view, { width, height }));
}

function depth_of(view, { width, height }) {
    const kStep = 0.001,
        kCell = 4; // the unit of inverse depth [1/m]; [pixels]
    const columns = Math.ceil(width / kCell);
    const direction = directions_of(view);
    const cells = Array.from({ length: columns * Math.ceil(height / kCell) }, (_, k) => {
        const x = ((k % columns) + 0.5) * (kCell / width),
            y = 1 - (Math.floor(k / columns) + 0.5) * (kCell / height);
        return Math.min(65535, Math.round(1 / (kStep * depth_along(view, direction(x, y)))));
    });
    const inverse = (x, y) => cells[Math.floor(y / kCell) * columns + Math.floor(x / kCell)];
    const bytes = depth_of_bands(kStep, bands_of(inverse, width, height));
    return { x: 0, y: 0, width, height, codec: 3, bytes };
}

/** The luminance of a picture, one value for four by four pixels. */
export function luminance_piece(jpeg, view, { width, height }, display) {
    return once(["luminance", view, width, height, display], () =>
        painted_luminance(jpeg, view, { width, height }, display),
    );
}

function painted_luminance(jpeg, view, { width, height }, display) {
    const [w, h] = [Math.ceil(width / 4), Math.ceil(height / 4)];
    const [low, step] = [-2, 0.0625]; // logarithms to the base of 2 [cd/m2]
    const data = Buffer.alloc(4 * w * h, 255);
    const direction = directions_of(view);
    for (let k = 0; k < w * h; ++k) {
        const [x, y] = [((k % w) + 0.5) / w, 1 - (Math.floor(k / w) + 0.5) / h];
        const hit = look(view.position, direction(x, y));
        const L = hit ? luminance_of(hit) : 0;
        const grey =
            L > 0 ? Math.max(1, Math.min(255, Math.round((Math.log2(L) - low) / step))) : 0;
        data.fill(grey, 4 * k, 4 * k + 3);
    }
    const bytes = Buffer.concat([
        Buffer.alloc(12),
        jpeg.encode({ data, width: w, height: h }, 95).data,
    ]);
    const white = display.mode === "false" || display.human ? 0 : kWhite;
    [low, step, white].forEach((x, k) => bytes.writeFloatLE(x, 4 * k));
    return { x: 0, y: 0, width, height, codec: 4, bytes };
}
