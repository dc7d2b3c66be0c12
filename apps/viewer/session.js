// The protocol between page and server: numbered views go out, frames and answers come in.
import { Connection, socket_address } from "./connection.js";
import { Latency } from "./latency.js";
import { FrameTimes } from "./prediction.js";
import { fit_view } from "./view.js";
import { widened } from "./warp.js";

const kBeside = 2 ** 31; // numbers of requests about the scene beside are above this
const kRemembered = 600; // how many sent views are remembered for frames that show them

export class Session {
    /**
     * @param id      of the session
     * @param depth   whether frames shall tell how far away what they show is
     * @param screen  shows frames; its owner hands them to drawn() and skipped()
     * @param on      a function for each message type: welcome, loaded, picked, ..., and connected(), lost(reason, wait)
     * @param beside  whether it is about the scene that the driver sees beside the walk's: its view is told as to who watches
     */
    constructor(id, depth, screen, on, beside = false) {
        this.latency = new Latency();
        this.times = new FrameTimes();
        this.view = null; ///< the newest view that was sent, fitted to the window
        this.view_id = 0;
        this.shown_id = 0;
        this.shown = null; ///< the view that the screen shows; null when it is not known
        this.frame_view = null; ///< the view of the newest frame; null when it is not known
        this.seen = null; ///< for a page that watches: what the driver saw when the newest frame came; null when it is not known
        this.told_ = null; // for a page that watches: the newest `view` message {view, seen}
        this.driving = false;
        this.request_ = beside ? kBeside : 0;
        this.sent_ = new Map(); // what was sent as each view, by id: {view, walk, epoch}
        this.connection = new Connection(socket_address(location.href), {
            open: () => {
                const hello = { type: "hello", session: id, luminance: true };
                if (depth) hello.depth = true;
                if (beside) hello.beside = true;
                this.send(hello);
                on.connected();
            },
            message: (message) => on[message.type]?.(message),
            frame: (buffer) => screen.receive(buffer, this.told_),
            lost: (reason, wait) => {
                this.latency.forget();
                on.lost(reason, wait);
            },
        });
    }

    send(message) {
        return this.connection.send(message);
    }

    /** Send a request with a new number, which the answer repeats; returns the number. */
    ask(type, fields = {}) {
        const id = fields.id ?? ++this.request_;
        this.send({ ...fields, type, id });
        return id;
    }

    /**
     * Send a view.
     * @param step  as Navigator.tick() gives it; seen: what the screen shows meanwhile, where that is another view
     * @param size  of the picture {width, height} [pixels]
     * @param epoch   see Navigator
     * @param factor  how much larger than the window's the picture's angles are; more than 1 for perspective views only
     */
    send_view({ view, moving, walk, input, seen }, { width, height }, epoch, factor = 1) {
        const own = fit_view(view, width, height);
        const fitted = factor > 1 ? widened(own, factor) : own;
        const id = this.view_id + 1;
        const message = { type: "view", id, view: fitted, width, height, moving, walk };
        if (seen) message.seen = fit_view(seen, width, height);
        if (!this.send(message)) return false;
        this.view_id = id;
        this.view = fitted;
        this.sent_.set(id, { view: fitted, walk, epoch, at: performance.now() });
        if (this.sent_.size > kRemembered) this.sent_.delete(this.sent_.keys().next().value);
        this.latency.sent(id, input);
        return true;
    }

    /**
     * Acknowledge a frame that is on the picture.
     * @param told  for a page that watches: the `view` message before the frame, null where none has come
     * @returns what was sent as the view that it shows: {view, walk, epoch}; nothing for a page that watches
     */
    drawn(frame, told) {
        this.send({ type: "ack", frame: frame.frame });
        if (!this.driving) return this.watched_(told);
        const sent = this.sent_.get(frame.view_id);
        if (!sent) return null;
        if (this.shown_id !== frame.view_id) this.times.shown(sent.at, performance.now());
        this.shown_id = frame.view_id;
        this.frame_view = { ...sent.view, position: frame.eye };
        this.shown = this.frame_view;
        for (const id of this.sent_.keys()) {
            if (id >= frame.view_id) break;
            this.sent_.delete(id);
        }
        // What is drawn on a canvas becomes visible when the browser paints next.
        requestAnimationFrame(() => this.latency.shown(frame.view_id, performance.now()));
        return sent;
    }

    skipped(frame) {
        this.send({ type: "ack", frame: frame.frame });
    }

    /** For a page that watches: the server's `view` message tells the view of the frames that follow. */
    watch({ view, seen }) {
        this.told_ = { view, seen: seen ?? view };
        // Who has just come may have got the frame before.
        if (!this.driving && !this.frame_view) this.watched_(this.told_);
    }

    watched_(told) {
        this.frame_view = this.shown = told?.view ?? null;
        this.seen = told?.seen ?? null;
        return null;
    }

    /** Who drives has changed. */
    drive(driving) {
        // Frames go on to show what the former driver saw until the server tells of another view.
        if (this.driving && !driving) {
            const view = this.frame_view;
            this.told_ = view && { view, seen: view };
        }
        if (!driving) this.watched_(this.told_);
        this.driving = driving;
    }
}
