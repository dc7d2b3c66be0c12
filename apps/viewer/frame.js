// A frame as the server sends it, little-endian:
//  0 "LWF1"; 4 u32 frame; 8 u32 id of the newest view it shows; 12 u16 width; 14 u16 height;
// 16 u8 flags; 17 u8 number of the display; 18 u16 pieces; 20 f32 exposure; 24 f64 x3 eye position [m];
// 48 pieces, each: u16 x, y (from the top left), width, height; u8 codec; u8 x3 0; u32 bytes; bytes.

const kMagic = 0x3146574c; // "LWF1"
const kHeader = 48;
const kPieceHeader = 16;
const kTypes = { 1: "image/jpeg", 2: "image/png", 3: "depth", 4: "luminance" };

/** The piece at byte offset `at`: its place in the picture, its media type and its bytes. */
function parse_piece(data, at) {
    if (at + kPieceHeader > data.byteLength) throw new Error("frame: a piece is cut off");
    const piece = {
        x: data.getUint16(at, true),
        y: data.getUint16(at + 2, true),
        width: data.getUint16(at + 4, true),
        height: data.getUint16(at + 6, true),
        type: kTypes[data.getUint8(at + 8)],
    };
    const size = data.getUint32(at + 12, true);
    if (!piece.type) throw new Error("frame: unknown codec");
    if (at + kPieceHeader + size > data.byteLength) throw new Error("frame: a piece is cut off");
    piece.bytes = new Uint8Array(data.buffer, data.byteOffset + at + kPieceHeader, size);
    return piece;
}

/** Add a piece to a frame. */
function take_piece(result, piece) {
    const { type } = piece;
    if (type !== "depth" && type !== "luminance") return result.pieces.push(piece);
    if (result[type] || piece.width !== result.width || piece.height !== result.height)
        throw new Error(`frame: its ${type} is not of its size`);
    result[type] = piece;
}

/**
 * A frame's header and pieces; bytes are views into the buffer.
 * @returns {{frame, view_id, width, height, complete, at_rest, final, denoised, display, exposure, eye, pieces, depth, luminance}}
 * depth, luminance: the pieces with those of the pixels, null where there are none; display: number of the settings that its colours are after; complete: the message holds all pieces of the picture; at_rest: the eye stands still; final: nothing will be refined
 * any more; denoised: its colours are of a picture for the eye. Throws Error for bytes that are no frame.
 */
export function parse_frame(buffer) {
    const data = new DataView(buffer);
    if (data.byteLength < kHeader || data.getUint32(0, true) !== kMagic)
        throw new Error("frame: not a frame");
    const flags = data.getUint8(16);
    const result = {
        frame: data.getUint32(4, true),
        view_id: data.getUint32(8, true),
        width: data.getUint16(12, true),
        height: data.getUint16(14, true),
        complete: (flags & 1) !== 0,
        at_rest: (flags & 2) !== 0,
        final: (flags & 4) !== 0,
        denoised: (flags & 8) !== 0,
        display: data.getUint8(17),
        exposure: data.getFloat32(20, true),
        eye: [24, 32, 40].map((at) => data.getFloat64(at, true)),
        pieces: [],
        depth: null,
        luminance: null,
    };
    let at = kHeader;
    for (let k = data.getUint16(18, true); k > 0; --k) {
        const piece = parse_piece(data, at);
        if (piece.x + piece.width > result.width || piece.y + piece.height > result.height)
            throw new Error("frame: a piece lies outside");
        take_piece(result, piece);
        at += kPieceHeader + piece.bytes.byteLength;
    }
    if (at !== data.byteLength) throw new Error("frame: bytes after the last piece");
    return result;
}
