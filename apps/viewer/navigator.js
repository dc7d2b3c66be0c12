// The eye's position and its history: held keys, drags, jumps to views and their undoing.
// Does not use the document: the page passes events to it, and asks it for the next view once a screen refresh.
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
import { DragSpeed, view_ahead } from "./prediction.js";
import { dot, length, normalize, subtract } from "./vector.js";
import { same_place } from "./view.js";

const kHeld = 150; // a drag without a step for so long is held still [ms]
const kLongestTick = 0.1; // longer pauses of the page count as this, so that the eye does not leap [s]
const kUndo = 50;
const kFaster = 3,
    kSlower = 0.25;

export class Navigator {
    constructor() {
        this.view = null;
        this.walk = true;
        this.speed = 1.4; ///< of walking [m/s]
        this.eye_height = 1.6; ///< of people above their floor [m]
        this.on_input = null; ///< called at every key press and drag
        this.keys = new Set();
        this.modifier = "none"; ///< which modifier key is held: none, faster, slower
        this.dragging = false;
        this.dragged_ = -Infinity; // time of the newest step of a drag [ms]
        this.held_ = false; // the drag is held still
        this.lean_ = [0, 0];
        this.rates_ = [0, 0, 0, 0, 0];
        this.drag_ = new DragSpeed();
        this.way_ = null; ///< what leads the eye: {at(now): view, end: when it arrives [ms], to: where}
        this.epoch = 0; ///< rises at each jump: frames of views from before it must not correct the eye's height
        this.past_ = [];
        this.changed_ = false;
        this.input_ = null; ///< time of the oldest input that no view has been sent for yet [ms]
        this.last_ = null;
        this.was_moving_ = false;
    }

    /** Put the eye at a view that comes from the server or a file, without a transition. */
    place(view) {
        this.view = view;
        this.way_ = null;
        this.changed_ = true;
        ++this.epoch;
    }

    /**
     * Take over the height of eyes, and set the walking speed to .85 eye heights a second, which suits scenes in other
     * units than metres, too.
     */
    set_eye_height(height) {
        if (!(height > 0)) return;
        this.eye_height = height;
        this.speed = 0.85 * height;
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
        this.lean_ = [0, 0];
    }

    /** Turn the eye by a drag: to the right and up [rad]. */
    look(yaw, pitch, now) {
        if (!this.view) return;
        this.stop_transition();
        this.view = looked(this.view, yaw, pitch);
        this.drag_.step(yaw, pitch, now);
        this.step_drag_(now);
    }

    /** Move the eye by a drag of two fingers: to the right and forward [m]. */
    shift(right, forward, now) {
        if (!this.view) return;
        this.stop_transition();
        this.view = moved(this.view, [right, forward, 0], this.walk);
        this.step_drag_(now);
    }

    /** Take the wish of a stick: [right, forward], each -1 to 1. */
    lean(wish, now) {
        this.lean_ = wish;
        if (wish.some((x) => x !== 0)) this.stop_transition();
        this.note_input(now);
    }

    zoom(factor, now) {
        if (!this.view) return;
        this.view = zoomed(this.view, factor);
        this.touched_(now);
    }

    /** Make the eye move faster (notches > 0) or more slowly; returns the new speed [m/s]. */
    change_speed(notches) {
        this.speed = Math.max(1e-3, Math.min(1e4, this.speed * 1.15 ** notches));
        return this.speed;
    }

    /** Jump to a view, smoothly unless `duration` [ms] is 0; undo() returns. */
    jump(view, now, duration = this.duration_to(view)) {
        // A second click on the same view is no second jump.
        if (this.view && !same_place(this.way_?.to ?? this.view, view)) {
            this.past_.push(this.view);
            if (this.past_.length > kUndo) this.past_.shift();
        }
        this.travel_(view, now, duration);
    }

    /** Return to where the last jump began; false when there was none. */
    undo(now, duration) {
        const view = this.past_.pop();
        if (!view) return false;
        this.travel_(view, now, duration ?? this.duration_to(view));
        return true;
    }

    get can_undo() {
        return this.past_.length > 0;
    }

    /** How long a transition takes [ms]: the longer the farther it goes, and at most 1600. */
    duration_to(view) {
        if (!this.view || this.view.type !== view.type) return 0;
        const metres = length(subtract(view.position, this.view.position));
        const cosine = dot(normalize(view.direction), normalize(this.view.direction));
        const turn = Math.acos(Math.max(-1, Math.min(1, cosine)));
        return Math.min(1600, 300 + 120 * (metres / Math.max(this.speed, 1e-6)) + 250 * turn);
    }

    /** Switch between walking (the server keeps the eye's height above the floor) and flying. */
    set_walk(walk) {
        this.walk = walk;
        // What is left of a rise, whose key was just let go, would end the walk at once.
        if (walk) this.rates_ = this.rates_.map((rate, k) => (k === 2 ? 0 : rate));
        this.changed_ = true;
        ++this.epoch;
    }

    /** Take over the eye's height from the server, which keeps it constant above the surface below. */
    take_height(eye) {
        if (!this.view || !this.walk || this.way_) return;
        this.view = at_height(this.view, eye);
    }

    /**
     * Lead the eye along a path, until it ends or somebody moves the eye.
     * @param path  {at(now): view, end}: times in ms
     * @returns what follows() takes
     */
    follow({ at, end }, now) {
        this.way_ = { at, end, to: at(end) };
        ++this.epoch;
        this.touched_(now);
        return this.way_;
    }

    /** Whether the eye is still led by what follow() returned. */
    follows(way) {
        return this.way_ === way;
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

    /** Make the next tick return the view though nothing has moved: the window was resized, or the server is new. */
    touch() {
        this.changed_ = true;
    }

    /**
     * Advance the eye to the time `now` [ms], and take what has changed.
     * @returns {{view, moving, walk, input}} what to send to the server, or nothing when nothing has
     *     changed. input: time of the event that this answers [ms].
     */
    tick(now) {
        if (!this.view) return null;
        this.advance(now);
        if (!this.has_news) return null;
        const moving = this.moving;
        const input = this.input_ ?? now;
        this.changed_ = false;
        this.was_moving_ = moving;
        this.input_ = null;
        return { view: this.view, moving, walk: this.walk && !this.way_, input };
    }

    /** Advance the eye to the time `now` [ms]. */
    advance(now) {
        if (!this.view) return;
        const dt = this.last_ === null ? 0 : Math.min((now - this.last_) / 1000, kLongestTick);
        this.last_ = now;
        this.held_ = now - this.dragged_ > kHeld;
        this.advance_(now, dt);
    }

    /** The view in `seconds`, as far as it can be foretold at the time `now` [ms]. */
    ahead(now, seconds) {
        if (this.way_) {
            const { at, end } = this.way_;
            return at(Math.min(end, now + 1000 * seconds));
        }
        const [yaw, pitch] = this.drag_.ahead(now, seconds);
        const dragged = yaw || pitch ? looked(this.view, yaw, pitch) : this.view;
        const wish = this.wish_;
        if (this.rates_.every((rate, k) => rate === 0 && wish[k] === 0)) return dragged;
        return view_ahead(dragged, this.rates_, wish, seconds, this.pace_ * this.speed, this.walk);
    }

    /** Whether tick() has something to return. */
    get has_news() {
        return this.view !== null && (this.changed_ || this.moving !== this.was_moving_);
    }

    /** Whether the eye moves, so that more views will follow soon. A pointer that is held still moves nothing. */
    get moving() {
        const going = this.rates_.some((rate) => rate !== 0) || this.wish_.some((x) => x !== 0);
        return (this.dragging && !this.held_) || going || this.way_ !== null;
    }

    /** What keys and stick ask for; see wish_of(). */
    get wish_() {
        const both = (x, k) => Math.max(-1, Math.min(1, x + (this.lean_[k] ?? 0)));
        return wish_of(this.keys).map(both);
    }

    get pace_() {
        return { none: 1, faster: kFaster, slower: kSlower }[this.modifier];
    }

    advance_(now, dt) {
        if (this.way_) {
            const { at, end } = this.way_;
            this.view = at(Math.min(end, now));
            this.changed_ = true;
            if (now >= end) this.way_ = null;
        }
        this.rates_ = next_rates(this.rates_, this.wish_, dt);
        if (this.rates_.every((rate) => rate === 0)) return;
        // Keys for up and down work in flight only: in a walk the floor determines the height.
        if (this.rates_[2] !== 0 && this.walk) this.set_walk(false);
        this.view = advanced(this.view, this.rates_, dt, this.speed * this.pace_, this.walk);
        this.changed_ = true;
    }

    travel_(view, now, duration) {
        this.note_input(now);
        if (!this.view || duration <= 0) return this.place(view);
        const from = this.view;
        const at = (time) => between(from, view, (time - now) / duration);
        this.way_ = { at, end: now + duration, to: view };
        ++this.epoch;
    }

    step_drag_(now) {
        this.dragged_ = now;
        this.held_ = false;
        this.touched_(now);
    }

    touched_(now) {
        this.changed_ = true;
        this.note_input(now);
    }
}
