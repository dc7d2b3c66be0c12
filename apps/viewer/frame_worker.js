// A worker: decodes frames while the page goes on drawing. See Decoder.
import { decode_frame, transferables } from "./decoding.js";
import { parse_frame } from "./frame.js";

let canvas = null;

/** The pieces of a whole picture as one, so that the page has one to draw; others as they are. */
function joined({ width, height }, pieces) {
    const area = pieces.reduce((sum, piece) => sum + piece.width * piece.height, 0);
    if (pieces.length < 2 || area !== width * height) return pieces;
    canvas ??= new OffscreenCanvas(width, height);
    if (canvas.width !== width || canvas.height !== height)
        Object.assign(canvas, { width, height });
    const context = canvas.getContext("2d", { alpha: false });
    for (const { x, y, width: across, height: down, bitmap } of pieces) {
        context.drawImage(bitmap, x, y, across, down);
        bitmap.close();
    }
    return [{ x: 0, y: 0, width, height, bitmap: canvas.transferToImageBitmap() }];
}

addEventListener("message", async ({ data: { number, buffer } }) => {
    try {
        const frame = parse_frame(buffer);
        const decoded = await decode_frame(frame);
        decoded.pieces = joined(frame, decoded.pieces);
        postMessage({ number, decoded }, transferables(decoded));
    } catch (error) {
        postMessage({ number, error: error.message });
    }
});
postMessage({ ready: true });
