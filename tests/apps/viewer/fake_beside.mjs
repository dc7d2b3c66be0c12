// What the fake server shows beside its walk: the same room, twice as bright at any other hour than the file's.
import {
    coarse_pieces,
    depth_piece,
    frame_bytes,
    luminance_piece,
    strip_piece,
    kStrips,
} from "./fake_frames.mjs";

const kBrighter = 1; // stops

export class FakeBeside {
    constructor(jpeg, loaded, edited_message) {
        Object.assign(this, { jpeg_: jpeg, loaded_: loaded, edited_message_: edited_message });
        this.socket = null;
        this.told = {}; ///< the newest message of each type
    }

    open(socket, hello, driven) {
        if (this.socket || !driven) return socket.close(1008, "not now");
        Object.assign(this, {
            socket,
            hello_: hello,
            told: {},
            busy_: false,
            frame_: 0,
            drawn_: "",
        });
        this.tell_({ type: "welcome", you: 0, driver: true, scene: "room/room.rad", views: [] });
        const { type, time, lights } = this.loaded_;
        this.tell_({ type, time, lights, views: [] });
        this.tell_({ type: "time", time: null, rise: 6.5, set: 18.25, altitude: 30, azimuth: 40 });
    }

    close(socket) {
        if (socket !== this.socket) return false;
        this.socket = null;
        return true;
    }

    tell_(message) {
        if (this.socket.readyState === 1) this.socket.send(JSON.stringify(message));
    }

    answer(message) {
        this.told[message.type] = message;
        if (message.type === "ack") this.busy_ = false;
        if (message.type === "time")
            this.tell_({ ...message, rise: 6.5, set: 18.25, altitude: 20, azimuth: 10 });
        if (message.type === "edits") this.tell_(this.edited_message_(message));
        if (message.type === "pick")
            this.tell_({
                ...{ type: "picked", id: message.id, hit: true, luminance: 77, illuminance: 7 },
                ...{ distance: 2, position: [0, 0, 1], normal: [0, 0, 1] },
                ...{ material: "beside", surface: "beside" },
            });
    }

    /** Whole at once, then strip by strip, as the walk's. */
    next_frame(view, wish, display) {
        if (!this.socket || this.busy_) return;
        const time = this.told.time?.time ?? null,
            difference = this.told.difference?.shown === true;
        const key = JSON.stringify([wish.version, time?.hour, difference]);
        const ev = display.exposure.auto ? Math.log2(1.1) : display.exposure.ev;
        // Without a renderer a difference is false colours: what matters is that it is something else.
        const shown = difference
            ? { ...display, mode: "false" }
            : { ...display, exposure: { auto: false, ev: ev + (time ? kBrighter : 0) } };
        let pieces,
            flags = 1;
        if (key !== this.drawn_) {
            this.drawn_ = key;
            this.strip_ = 0;
            this.tell_({ type: "view", view, seen: wish.seen });
            pieces = coarse_pieces(this.jpeg_, view, wish, shown);
            if (this.hello_.depth) pieces.push(depth_piece(view, wish));
            if (this.hello_.luminance) pieces.push(luminance_piece(this.jpeg_, view, wish, shown));
        } else if (!wish.moving && this.strip_ < kStrips) {
            pieces = [strip_piece(this.jpeg_, view, wish, this.strip_++, shown)];
            flags = this.strip_ === kStrips ? 6 : 2;
        } else return;
        this.busy_ = true;
        this.tell_({ type: "state", phase: flags === 6 ? "done" : "refining", share: 0.5 });
        const head = { ...shown, number: display.number };
        this.socket.send(frame_bytes(++this.frame_, wish, view.position, flags, pieces, head));
    }
}
