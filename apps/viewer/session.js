// The protocol between page and server: numbered views go out, frames and answers come in.
import { Connection, socket_address } from "./connection.js";
import { Latency } from "./latency.js";
import { FrameTimes } from "./prediction.js";
import { fit_view } from "./view.js";
import { widened } from "./warp.js";

const kRemembered = 600; // how many sent views are remembered for frames that show them

export class Session {
    /**
     * @param id      of the session
     * @param depth   whether frames shall tell how far away what they show is
     * @param screen  shows frames; its owner hands them to drawn() and skipped()
     * @param on      a function for each message type: welcome, loaded, picked, ..., and connected(), lost(reason, wait)
     */
    constructor(id, depth, screen, on) {
        this.latency = new Latency();
        this.times = new FrameTimes();
        this.view = null; ///< the newest view that was sent, fitted to the window
        this.view_id = 0;
        this.shown_id = 0;
        this.shown = null; ///< the view that the screen shows; null when it is not known
        this.frame_view = null; ///< the view of the newest frame; null when it is not known
        this.driving = false;
        this.request_ = 0;
        this.sent_ = new Map(); // what was sent as each view, by id: {view, walk, epoch}
        this.connection = new Connection(socket_address(location.href), {
            open: () => {
                this.send(
                    depth ? { type: "hello", session: id, depth } : { type: "hello", session: id },
                );
                on.connected();
            },
            message: (message) => on[message.type]?.(message),
            frame: (buffer) => screen.receive(buffer),
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
     * @param step  as Navigator.tick() gives it
     * @param size  of the picture {width, height} [pixels]
     * @param epoch   see Navigator
     * @param factor  how much larger than the window's the picture's angles are; more than 1 for perspective views only
     */
    send_view({ view, moving, walk, input }, { width, height }, epoch, factor = 1) {
        const own = fit_view(view, width, height);
        const fitted = factor > 1 ? widened(own, factor) : own;
        const id = this.view_id + 1;
        if (!this.send({ type: "view", id, view: fitted, width, height, moving, walk }))
            return false;
        this.view_id = id;
        this.view = fitted;
        this.sent_.set(id, { view: fitted, walk, epoch, at: performance.now() });
        if (this.sent_.size > kRemembered) this.sent_.delete(this.sent_.keys().next().value);
        this.latency.sent(id, input);
        return true;
    }

    /**
     * Acknowledge a frame that is on the screen.
     * @returns what was sent as the view that it shows: {view, walk, epoch}; nothing for a page that watches
     */
    drawn(frame) {
        this.send({ type: "ack", frame: frame.frame });
        if (!this.driving) return null;
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

    /** For a page that watches: the view that the driver sees, from the server's `view` message. */
    watch(view) {
        if (!this.driving) this.shown = view;
    }
}
