// Where the eye stands and how it got there: held keys, drags, jumps and their undoing.
// Knows no document: the page feeds it events and asks it for the next view, a frame at a time.
import {
    advanced,
    at_height,
    between,
    looked,
    moved,
    next_rates,
    wish_of,
    zoomed,
} from "./motion.js";
import { dot, length, normalize, subtract } from "./vector.js";
import { same_place } from "./view.js";

const kLongestTick = 0.1; // a page that hung does not leap [s]
const kUndo = 50;
const kFaster = 3,
    kSlower = 0.25;

export class Navigator {
    constructor() {
        this.view = null;
        this.walk = true;
        this.speed = 1.4; ///< [m/s]
        this.on_input = null; ///< called when something was pressed or moved
        this.keys = new Set();
        this.modifier = "none"; ///< none, faster, slower
        this.dragging = false;
        this.rates_ = [0, 0, 0, 0, 0];
        this.way_ = null; ///< a transition under way: {from, to, begin, duration}
        this.epoch = 0; ///< rises when the eye is put elsewhere: older pictures tell nothing about it
        this.past_ = [];
        this.changed_ = false;
        this.input_ = null; ///< when the oldest input came that no view has answered yet [ms]
        this.last_ = null;
        this.was_moving_ = false;
    }

    /** The view as a server or a file has it; without a transition. */
    place(view) {
        this.view = view;
        this.way_ = null;
        this.changed_ = true;
        ++this.epoch;
    }

    /** Walking speed for scenes in other units than metres: an eye height a second, nearly. */
    set_eye_height(height) {
        if (height > 0) this.speed = 0.85 * height;
    }

    press(code, now) {
        this.keys.add(code);
        this.stop_transition();
        this.note_input(now);
    }

    release(code, now) {
        this.keys.delete(code);
        this.note_input(now);
    }

    release_all() {
        this.keys.clear();
        this.dragging = false;
    }

    /** By a drag: to the right and up [rad]. */
    look(yaw, pitch, now) {
        if (!this.view) return;
        this.stop_transition();
        this.view = looked(this.view, yaw, pitch);
        this.touched_(now);
    }

    /** By two fingers: to the right and forward [m]. */
    shift(right, forward, now) {
        if (!this.view) return;
        this.stop_transition();
        this.view = moved(this.view, [right, forward, 0], this.walk);
        this.touched_(now);
    }

    zoom(factor, now) {
        if (!this.view) return;
        this.view = zoomed(this.view, factor);
        this.touched_(now);
    }

    /** Faster (notches > 0) or slower; returns the new speed [m/s]. */
    change_speed(notches) {
        this.speed = Math.max(1e-3, Math.min(1e4, this.speed * 1.15 ** notches));
        return this.speed;
    }

    /** Go to a view, smoothly unless `duration` [ms] is 0; undo() comes back. */
    jump(view, now, duration = this.duration_to(view)) {
        // A second click on the same view is no second jump.
        if (this.view && !same_place(this.way_?.to ?? this.view, view)) {
            this.past_.push(this.view);
            if (this.past_.length > kUndo) this.past_.shift();
        }
        this.travel_(view, now, duration);
    }

    /** Back to where the last jump began; false when there was none. */
    undo(now, duration) {
        const view = this.past_.pop();
        if (!view) return false;
        this.travel_(view, now, duration ?? this.duration_to(view));
        return true;
    }

    get can_undo() {
        return this.past_.length > 0;
    }

    /** How long a transition takes [ms]: longer the farther it goes, never tedious. */
    duration_to(view) {
        if (!this.view || this.view.type !== view.type) return 0;
        const metres = length(subtract(view.position, this.view.position));
        const cosine = dot(normalize(view.direction), normalize(this.view.direction));
        const turn = Math.acos(Math.max(-1, Math.min(1, cosine)));
        return Math.min(1600, 300 + 120 * (metres / Math.max(this.speed, 1e-6)) + 250 * turn);
    }

    /** Walk (the server keeps the eye's height) or fly. */
    set_walk(walk) {
        this.walk = walk;
        this.changed_ = true;
        ++this.epoch;
    }

    /** The server keeps the eye at its height above what is below. */
    take_height(eye) {
        if (!this.view || !this.walk || this.way_) return;
        this.view = at_height(this.view, eye);
    }

    stop_transition() {
        this.way_ = null;
    }

    get travelling() {
        return this.way_ !== null;
    }

    note_input(now) {
        this.input_ = this.input_ ?? now;
        this.on_input?.();
    }

    /** Send the view again though nothing moved: a window of another size, a server that is back. */
    touch() {
        this.changed_ = true;
    }

    /**
     * One tick of the page's clock [ms].
     * @returns {{view, moving, walk, input}} what the server should know now, or nothing when
     *     nothing has changed. input: when the event came that this answers [ms].
     */
    tick(now) {
        if (!this.view) return null;
        const dt = this.last_ === null ? 0 : Math.min((now - this.last_) / 1000, kLongestTick);
        this.last_ = now;
        this.advance_(now, dt);
        const moving = this.moving;
        if (!this.changed_ && moving === this.was_moving_) return null;
        const input = this.input_ ?? now;
        this.changed_ = false;
        this.was_moving_ = moving;
        this.input_ = null;
        return { view: this.view, moving, walk: this.walk && !this.way_, input };
    }

    /** Whether more will follow soon. */
    get moving() {
        const going =
            this.rates_.some((rate) => rate !== 0) || wish_of(this.keys).some((x) => x !== 0);
        return this.dragging || going || this.way_ !== null;
    }

    advance_(now, dt) {
        if (this.way_) {
            const { from, to, begin, duration } = this.way_;
            const share = duration > 0 ? (now - begin) / duration : 1;
            this.view = between(from, to, share);
            this.changed_ = true;
            if (share >= 1) this.way_ = null;
        }
        this.rates_ = next_rates(this.rates_, wish_of(this.keys), dt);
        if (this.rates_.every((rate) => rate === 0)) return;
        const pace = { none: 1, faster: kFaster, slower: kSlower }[this.modifier];
        // Up and down is flying: whoever walks has the floor to tell the height.
        if (this.rates_[2] !== 0 && this.walk) this.set_walk(false);
        this.view = advanced(this.view, this.rates_, dt, this.speed * pace, this.walk);
        this.changed_ = true;
    }

    travel_(view, now, duration) {
        this.note_input(now);
        if (!this.view || duration <= 0) return this.place(view);
        this.way_ = { from: this.view, to: view, begin: now, duration };
        ++this.epoch;
    }

    touched_(now) {
        this.changed_ = true;
        this.note_input(now);
    }
}
