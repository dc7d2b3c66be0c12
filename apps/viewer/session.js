// The walk as server and page agree on it: numbered views out, frames and answers in.
import { Connection, socket_address } from "./connection.js";
import { Latency } from "./latency.js";
import { fit_view } from "./view.js";

const kRemembered = 600; // views that a frame may still show

export class Session {
    /**
     * @param screen  shows frames; its owner hands them to drawn() and skipped()
     * @param on      by message: welcome, loaded, picked, ... and connected(), lost(reason, wait)
     */
    constructor(id, screen, on) {
        this.latency = new Latency();
        this.view = null; ///< the newest that was sent, fitted to the window
        this.view_id = 0;
        this.shown_id = 0;
        this.shown = null; ///< the view that the screen shows, as far as it is known
        this.driving = false;
        this.request_ = 0;
        this.sent_ = new Map(); // by id: {view, walk, epoch}
        this.connection = new Connection(socket_address(location.href), {
            open: () => {
                this.send({ type: "hello", session: id });
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

    /** A question with a number of its own, which comes back with the answer. */
    ask(type, fields = {}) {
        const id = fields.id ?? ++this.request_;
        this.send({ ...fields, type, id });
        return id;
    }

    /**
     * Tell the server where the eye is.
     * @param step  as Navigator.tick() gives it
     * @param size  of the picture {width, height} [pixels]
     */
    send_view({ view, moving, walk, input }, { width, height }, epoch) {
        const fitted = fit_view(view, width, height);
        const id = this.view_id + 1;
        if (!this.send({ type: "view", id, view: fitted, width, height, moving, walk }))
            return false;
        this.view_id = id;
        this.view = fitted;
        this.sent_.set(id, { view: fitted, walk, epoch });
        if (this.sent_.size > kRemembered) this.sent_.delete(this.sent_.keys().next().value);
        this.latency.sent(id, input);
        return true;
    }

    /**
     * A frame is on the screen.
     * @returns what was sent as the view it shows: {view, walk, epoch}; nothing for whoever watches
     */
    drawn(frame) {
        this.send({ type: "ack", frame: frame.frame });
        if (!this.driving) return null;
        const sent = this.sent_.get(frame.view_id);
        if (!sent) return null;
        this.shown_id = frame.view_id;
        this.shown = { ...sent.view, position: frame.eye };
        for (const id of this.sent_.keys()) {
            if (id >= frame.view_id) break;
            this.sent_.delete(id);
        }
        // The screen shows what was drawn when the browser next paints.
        requestAnimationFrame(() => this.latency.shown(frame.view_id, performance.now()));
        return sent;
    }

    skipped(frame) {
        this.send({ type: "ack", frame: frame.frame });
    }

    /** Who watches learns the view from the server, where it tells. */
    watch(view) {
        if (!this.driving) this.shown = view;
    }
}
