// Mouse, touch, wheel and keys become motion of the eye.
import { kKeys } from "./motion.js";
import { is_pair, is_stick_side, stick_wish } from "./stick.js";
import { angle_across } from "./view.js";

const kClick = 5; // a press that moves less than this is a click [CSS pixels]
const kTwice = 350; // longest time between the clicks of a double click [ms]
const kSamePlace = 24; // farthest that these are apart [CSS pixels]
const kNotch = 100; // wheel distance of one notch [pixels]
const kLine = 33; // wheel distance of one line, for browsers that report lines [pixels]

/** Whether a key belongs to a control that has the focus. */
function typing(target) {
    return (
        target instanceof HTMLElement &&
        (target.matches(
            "select, textarea, input:not([type=checkbox], [type=radio], [type=range])",
        ) ||
            target.closest("dialog"))
    );
}

export class Input {
    /**
     * @param surface    the element that is dragged and clicked
     * @param navigator
     * @param stick      {show(from, to), hide()}: the mark of the thumb that moves the eye
     * @param on  {click(x, y), double_click(x, y), area_begin(x, y), area_move(x, y), area_end(x, y), speed(speed),
     *     area_wanted(): bool, may_drive(): bool}: x, y in CSS pixels
     */
    constructor(surface, navigator, stick, on) {
        this.surface_ = surface;
        this.navigator_ = navigator;
        this.on_ = on;
        this.mark_ = stick;
        this.fingers_ = new Map(); // where pointers are, by id, but for the thumb that moves the eye
        this.came_ = new Map(); // where and when these came down: {at, time, touch}
        this.stick_ = null; // the thumb that moves the eye: {id, from}
        this.area_ = false;
        this.travelled_ = 0;
        this.click_ = null; // the last click {x, y, time}, if nothing but it has been done since
        this.listen_();
    }

    listen_() {
        const surface = this.surface_;
        surface.addEventListener("pointerdown", (event) => this.down_(event));
        surface.addEventListener("pointermove", (event) => this.move_(event));
        surface.addEventListener("pointerup", (event) => this.up_(event, true));
        surface.addEventListener("pointercancel", (event) => this.up_(event, false));
        surface.addEventListener("wheel", (event) => this.wheel_(event), { passive: false });
        surface.addEventListener("contextmenu", (event) => event.preventDefault());
        addEventListener("keydown", (event) => this.key_down_(event));
        addEventListener("keyup", (event) => this.key_up_(event));
        addEventListener("blur", () => this.navigator_.release_all());
    }

    down_(event) {
        if (event.button !== 0) return;
        this.surface_.setPointerCapture(event.pointerId);
        this.surface_.focus({ preventScroll: true });
        const at = [event.clientX, event.clientY];
        const came = { at, time: event.timeStamp, touch: event.pointerType === "touch" };
        if (this.fingers_.size === 1 && this.part_thumbs_(event.pointerId, came)) return;
        this.fingers_.set(event.pointerId, at);
        this.came_.set(event.pointerId, came);
        if (this.fingers_.size > 1) return this.end_area_(event);
        this.travelled_ = 0;
        this.area_ = event.shiftKey || this.on_.area_wanted();
        if (this.area_) this.on_.area_begin(event.clientX, event.clientY);
    }

    move_(event) {
        const now = [event.clientX, event.clientY];
        if (this.stick_?.id === event.pointerId) return this.lean_(now, event.timeStamp);
        const before = this.fingers_.get(event.pointerId);
        if (!before) return;
        if (this.fingers_.size === 1 && this.begins_stick_(event.pointerId, now)) {
            this.hold_stick_(event.pointerId, this.came_.get(event.pointerId).at);
            return this.lean_(now, event.timeStamp);
        }
        if (this.fingers_.size === 1) this.drag_(before, now, event);
        else this.two_fingers_(event.pointerId, before, now, event.timeStamp);
        if (this.fingers_.size > 1 || this.travelled_ >= kClick || this.area_)
            this.fingers_.set(event.pointerId, now);
    }

    /** Whether a finger in the left half, which is alone there, has begun to move the eye. */
    begins_stick_(id, [x, y]) {
        const { at, touch } = this.came_.get(id);
        if (this.stick_ || !touch || this.area_ || this.surface_.classList.contains("looking"))
            return false;
        const apart = Math.hypot(x - at[0], y - at[1]);
        return is_stick_side(at[0], innerWidth) && apart >= kClick && this.on_.may_drive();
    }

    /**
     * A second finger comes: if the two are no pair but thumbs, the left one moves the eye, and the other one looks.
     * Returns whether the second one is the left one.
     */
    part_thumbs_(id, came) {
        const [[other, first]] = this.came_;
        if (this.stick_ || this.area_ || !came.touch || !first.touch || !this.on_.may_drive())
            return false;
        if (is_pair(first, came, innerWidth)) return false;
        if (is_stick_side(came.at[0], innerWidth) && !is_stick_side(first.at[0], innerWidth)) {
            this.hold_stick_(id, came.at);
            return true;
        }
        if (is_stick_side(first.at[0], innerWidth) && !is_stick_side(came.at[0], innerWidth))
            this.hold_stick_(other, first.at);
        return false;
    }

    hold_stick_(id, from) {
        this.fingers_.delete(id);
        this.came_.delete(id);
        this.click_ = null;
        this.stick_ = { id, from };
        this.mark_.show(from, from);
    }

    lean_(now, time) {
        this.mark_.show(this.stick_.from, now);
        this.navigator_.lean(stick_wish(this.stick_.from, now), time);
    }

    let_go_of_stick_(time) {
        this.stick_ = null;
        this.mark_.hide();
        this.navigator_.lean([0, 0], time);
    }

    /** Drag with one pointer: the eye turns so that what is under the pointer stays nearly there. */
    drag_(before, now, event) {
        const step = [now[0] - before[0], now[1] - before[1]];
        this.travelled_ = Math.max(this.travelled_, Math.hypot(...step));
        if (this.area_) return this.on_.area_move(...now);
        if (this.travelled_ < kClick || !this.on_.may_drive()) return;
        this.navigator_.dragging = true;
        this.surface_.classList.add("looking");
        const angle = angle_across(this.navigator_.view) / this.surface_.clientWidth;
        this.navigator_.look(-step[0] * angle, step[1] * angle, event.timeStamp);
    }

    /** Drag with two fingers: up moves the eye forward, sideways moves it sideways, their distance changes the lens. */
    two_fingers_(id, before, now, time) {
        this.travelled_ = kClick;
        if (!this.on_.may_drive()) return;
        const other = [...this.fingers_].find(([key]) => key !== id)[1];
        const apart = (p) => Math.max(20, Math.hypot(p[0] - other[0], p[1] - other[1]));
        const metres = (2.5 * this.navigator_.speed) / this.surface_.clientHeight;
        this.navigator_.dragging = true;
        this.navigator_.shift(-(now[0] - before[0]) * metres, -(now[1] - before[1]) * metres, time);
        this.navigator_.zoom(apart(before) / apart(now), time);
    }

    up_(event, meant) {
        if (this.stick_?.id === event.pointerId) return this.let_go_of_stick_(event.timeStamp);
        this.came_.delete(event.pointerId);
        if (!this.fingers_.delete(event.pointerId)) return;
        if (this.fingers_.size > 0) return;
        this.surface_.classList.remove("looking");
        this.navigator_.dragging = false;
        if (!this.area_ && meant && this.travelled_ < kClick) return this.clicked_(event);
        this.click_ = null; // what lies between two clicks makes no double click of them
        this.end_area_(event, meant);
    }

    /** The first click of a double click counts as a click as well. */
    clicked_({ clientX: x, clientY: y, timeStamp: time }) {
        const before = this.click_;
        const twice =
            before !== null &&
            time - before.time < kTwice &&
            Math.hypot(x - before.x, y - before.y) < kSamePlace;
        this.click_ = twice ? null : { x, y, time };
        if (twice) this.on_.double_click(x, y);
        else this.on_.click(x, y);
    }

    end_area_(event, meant = false) {
        if (this.area_)
            this.on_.area_end(event.clientX, event.clientY, meant && this.travelled_ >= kClick);
        this.area_ = false;
    }

    wheel_(event) {
        event.preventDefault();
        if (!this.on_.may_drive()) return;
        const pixels = event.deltaMode === 0 ? event.deltaY : event.deltaY * kLine;
        // Browsers report a trackpad's pinch as a wheel with Ctrl.
        if (event.ctrlKey) this.navigator_.zoom(Math.exp(pixels / 300), event.timeStamp);
        else this.on_.speed(this.navigator_.change_speed(-pixels / kNotch));
    }

    key_down_(event) {
        this.modify_(event);
        if (typing(event.target) || event.metaKey || !kKeys[event.code]) return;
        // Ctrl with a letter belongs to the browser, and arrow keys to the control that has the focus.
        if (event.ctrlKey && event.code.startsWith("Key")) return;
        if (event.target instanceof HTMLInputElement && !event.code.startsWith("Key")) return;
        event.preventDefault();
        if (!event.repeat && this.on_.may_drive())
            this.navigator_.press(event.code, event.timeStamp);
    }

    key_up_(event) {
        this.modify_(event);
        if (this.navigator_.keys.has(event.code))
            this.navigator_.release(event.code, event.timeStamp);
    }

    modify_(event) {
        const slower = event.altKey || event.ctrlKey;
        this.navigator_.modifier = slower ? "slower" : event.shiftKey ? "faster" : "none";
    }
}
