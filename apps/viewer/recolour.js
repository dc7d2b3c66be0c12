// Keeps the picture in the colours that are wanted while frames still come in those of before.
import { element } from "./dom.js";
import { can_make, Luminance, recolour } from "./tone.js";

/** Whether two displays make the same picture of the same light, false colours aside. */
const same_colours = (a, b) =>
    b !== undefined &&
    a.mode === "tone" &&
    b.mode === "tone" &&
    JSON.stringify([a.exposure, a.human]) === JSON.stringify([b.exposure, b.human]);

const copy_of = (canvas) => {
    const copy = element("canvas", { width: canvas.width, height: canvas.height });
    copy.getContext("2d").drawImage(canvas, 0, 0);
    return copy;
};

export class Recolour {
    constructor(canvas, context) {
        this.canvas_ = canvas;
        this.context_ = context;
        this.wanted_ = null; // {number, display}
        this.displays_ = new Map(); // by number
        this.frame_ = null; // the newest that was drawn
        this.sent_ = null; // the picture as the server sent it, while another one is shown
        this.toned_ = null; // what false colours replaced: {canvas, tone, luminance, view_id}
        this.plane_ = null; // the newest luminance piece, with its bitmap
        this.luminance_ = null; // made of it
    }

    /** Luminance of what is on the picture; null where the server tells none. */
    get luminance() {
        this.luminance_ ??= this.plane_ && read_luminance(this.plane_);
        return this.luminance_;
    }

    /** Take what goes with the next frame. plane: see decode_frame(); null: there is none any more. */
    take(plane) {
        this.plane_?.bitmap.close();
        this.plane_ = plane;
        this.luminance_ = null;
    }

    /** Show the picture in other colours, if that can be; frames that have them say so by the number. Returns whether it shows. */
    want(number, display) {
        this.wanted_ = { number, display };
        this.displays_.set(number, display);
        if (!this.frame_ || this.frame_.display === number) return false;
        this.sent_ ??= copy_of(this.canvas_);
        return this.paint_();
    }

    /** Where the pieces of a frame are to be drawn. */
    begin(frame) {
        const { canvas_: canvas, sent_: sent } = this;
        const other = canvas.width !== frame.width || canvas.height !== frame.height;
        // Setting a canvas's size clears it, so only when it changes.
        if (other) Object.assign(canvas, { width: frame.width, height: frame.height });
        const wanted = !this.wanted_ || this.wanted_.number === frame.display;
        this.frame_ = frame;
        if (wanted) {
            if (sent && !other) this.context_.drawImage(sent, 0, 0);
            this.sent_ = null;
            return this.context_;
        }
        this.sent_ ??= copy_of(canvas);
        if (other) Object.assign(this.sent_, { width: frame.width, height: frame.height });
        return this.sent_.getContext("2d");
    }

    /** They are drawn. */
    end() {
        if (this.sent_) this.paint_();
    }

    /** Show what the server sent in the colours that are wanted. */
    paint_() {
        const { display } = this.wanted_;
        const from = can_make(display) && (this.own_tone_() ?? this.earlier_());
        if (!from) {
            this.context_.drawImage(this.sent_, 0, 0);
            return false;
        }
        if (display.mode === "false") this.toned_ = from;
        if (same_colours(display, from.display)) {
            this.context_.drawImage(from.canvas, 0, 0);
            return true;
        }
        const { width, height } = from.canvas;
        const picture = from.canvas.getContext("2d").getImageData(0, 0, width, height);
        recolour(picture.data, width, height, from.tone, from.luminance, display);
        this.context_.putImageData(picture, 0, 0);
        return true;
    }

    /** What was sent, where its bytes can be turned back. */
    own_tone_() {
        if (!(this.plane_?.white > 0)) return null;
        const tone = { exposure: this.frame_.exposure, white: this.plane_.white };
        const { view_id } = this.frame_;
        const display = this.displays_.get(this.frame_.display);
        return { canvas: this.sent_, tone, luminance: this.luminance, view_id, display };
    }

    /** What was there before false colours, of the same view. */
    earlier_() {
        const { toned_: toned, canvas_: canvas } = this;
        const same =
            toned?.view_id === this.frame_.view_id &&
            toned.canvas.width === canvas.width &&
            toned.canvas.height === canvas.height;
        return same ? toned : null;
    }
}

function read_luminance({ low, step, bitmap }) {
    const { width, height } = bitmap;
    const canvas = new OffscreenCanvas(width, height);
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    const greys = Uint8Array.from({ length: width * height }, (_, k) => data[4 * k]);
    return new Luminance({ low, step, width, height, greys });
}
