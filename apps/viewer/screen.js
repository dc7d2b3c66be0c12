// Draws frames: their pieces are decoded concurrently, and drawn in the order of frames.
import { Decoder } from "./decoder.js";
import { parse_frame } from "./frame.js";
import { Recolour } from "./recolour.js";

const kResized = 120; // wait after the last resize of the window [ms]

export class Screen {
    /**
     * @param canvas
     * @param on  {drawn(frame, depth, told), skipped(frame), failed(error, frame)}: frame as parse_frame() returns it; depth as
     *     decode_frame() does, undefined where it is as before; told as receive() took it; all three must acknowledge the frame
     */
    constructor(canvas, on) {
        this.canvas = canvas;
        this.on_ = on;
        this.context_ = canvas.getContext("2d", { alpha: false });
        this.context_.imageSmoothingQuality = "high";
        this.recolour_ = new Recolour(canvas, this.context_);
        this.decoder = new Decoder();
        this.queue_ = Promise.resolve();
        this.newest_complete_ = null;
    }

    /** Nothing more is shown. */
    end() {
        this.decoder.end();
    }

    /** See Recolour. */
    want(number, display) {
        return this.recolour_.want(number, display);
    }

    /** Luminance of what is on the picture, see tone.js; null where the server tells none. */
    get luminance() {
        return this.recolour_.luminance;
    }

    /**
     * Take the bytes of a frame, which are gone afterwards; it is drawn when it is decoded and the frames before it are drawn.
     * @param told  what is known of it from elsewhere
     */
    receive(buffer, told) {
        let frame;
        try {
            frame = parse_frame(buffer);
        } catch (error) {
            return this.on_.failed(error, null);
        }
        if (frame.complete) this.newest_complete_ = frame;
        const decoded = this.decoder.decode(frame, buffer);
        decoded.catch(() => {}); // reported when its turn to be drawn comes
        this.queue_ = this.queue_.then(() => this.show_(frame, decoded, told));
    }

    /** Whether a later frame supersedes this one: only a frame that holds all pieces of the picture does. */
    superseded_(frame) {
        const newest = this.newest_complete_;
        return newest !== null && newest !== frame && newest.frame > frame.frame;
    }

    async show_(frame, decoded, told) {
        try {
            const { pieces, depth, plane } = await decoded;
            if (this.superseded_(frame)) {
                plane?.bitmap.close();
                this.on_.skipped(frame);
            } else {
                if (plane !== undefined) this.recolour_.take(plane);
                this.draw_(frame, pieces, depth, told);
            }
            for (const { bitmap } of pieces) bitmap.close();
        } catch (error) {
            this.on_.failed(error, frame);
        }
    }

    draw_(frame, pieces, depth, told) {
        const context = this.recolour_.begin(frame);
        for (const { x, y, width, height, bitmap } of pieces)
            context.drawImage(bitmap, x, y, width, height);
        this.recolour_.end();
        this.on_.drawn(frame, depth, told);
    }
}

/** The largest size of the same proportions that is not larger than `most` in width and height [pixels]. */
export function scaled_into(most, { width, height }) {
    const factor = Math.min(most.width / width, most.height / height);
    const pixels = (size) => Math.max(1, Math.round(size * factor));
    return { width: pixels(width), height: pixels(height) };
}

/** The picture's size [pixels] for a window: that of the window in device pixels, within the server's limits. */
export function picture_size(width, height, ratio, [most_width, most_height]) {
    const share = Math.min(1, most_width / (width * ratio), most_height / (height * ratio));
    const pixels = (size) => Math.max(1, Math.round(size * ratio * share));
    return { width: pixels(width), height: pixels(height) };
}

/** While the window is resized call `changing`, and `done` a while after the last time: then it is worth a view of the new size. */
export function on_resize(changing, done) {
    let resized;
    addEventListener("resize", () => {
        changing();
        clearTimeout(resized);
        resized = setTimeout(done, kResized);
    });
}
