// Where the eye will be when a frame that is asked for now is on the screen.
import { looked, moved, kSettle, kTurnRate } from "./motion.js";

const kStale = 60; // a drag that has paused for so long has ended, as far as one can tell [ms]
const kWeight = 0.5; // of the newest step in a drag's speed
const kLongestDrag = 0.12; // hands turn back: a drag is foretold no further [s]
const kLongest = 0.4; // nothing is foretold further [s]

/** How far, in seconds of full speed, rates that approach `wish` lead within `seconds`; see next_rates(). */
export function distances_ahead(rates, wish, seconds) {
    const share = kSettle * (1 - Math.exp(-seconds / kSettle));
    return rates.map((rate, k) => wish[k] * seconds + (rate - wish[k]) * share);
}

/** The view after keys have moved the eye for `seconds` more; see advanced(). */
export function view_ahead(view, rates, wish, seconds, speed, walk) {
    const [right, forward, up, yaw, pitch] = distances_ahead(rates, wish, seconds);
    // What is walked meanwhile leads where the eye looks halfway through the turn.
    const half = looked(view, 0.5 * kTurnRate * yaw, 0.5 * kTurnRate * pitch);
    const step = [right, forward, walk ? 0 : up].map((way) => way * speed);
    const position = moved(half, step, walk).position;
    return { ...looked(view, kTurnRate * yaw, kTurnRate * pitch), position };
}

/** The speed of a drag. */
export class DragSpeed {
    constructor() {
        this.rates_ = [0, 0];
        this.time_ = null;
    }

    /** The eye was turned [rad] at a time [ms]. */
    step(yaw, pitch, now) {
        const ms = this.time_ === null ? Infinity : now - this.time_;
        if (ms <= 0) return;
        this.time_ = now;
        if (ms > kStale) return void (this.rates_ = [0, 0]);
        this.rates_ = [yaw, pitch].map(
            (turn, k) => this.rates_[k] + kWeight * ((1000 * turn) / ms - this.rates_[k]),
        );
    }

    /** To the right and up [rad/s]. */
    rates(now) {
        return this.time_ === null || now - this.time_ > kStale ? [0, 0] : this.rates_;
    }

    /** How far it leads within `seconds` [rad]. */
    ahead(now, seconds) {
        return this.rates(now).map((rate) => rate * Math.min(seconds, kLongestDrag));
    }
}

/** How long frames take: from asking to the screen, and from one to the next. */
export class FrameTimes {
    constructor() {
        this.way_ = []; // of the newest frames [ms]
        this.apart_ = [];
        this.last_ = null;
    }

    /** A frame is on the screen, whose view was sent at a time [ms]. */
    shown(sent, now) {
        const keep = (list, value) => list.push(value) > 9 && list.shift();
        keep(this.way_, now - sent);
        // After a pause nothing is known of how fast frames follow each other.
        if (this.last_ !== null && now - this.last_ < 1000) keep(this.apart_, now - this.last_);
        this.last_ = now;
    }

    /** The time between frames [s]. */
    get apart() {
        return middle(this.apart_) / 1000;
    }

    /** From now to the middle of the time for which a frame that is asked for now is the newest [s]. */
    get ahead() {
        return Math.min(kLongest, middle(this.way_) / 1000 + this.apart / 2);
    }
}

/** The median; 0 of nothing. */
function middle(values) {
    return [...values].sort((a, b) => a - b)[values.length >> 1] ?? 0;
}
