// The line between two pictures that are compared: dragged by a pointer, moved by keys.
import { by_id } from "./dom.js";

const kStep = 0.02,
    kLongStep = 0.1; // of the window's width, by a key

const kMoves = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 };

export class Divider {
    /** @param moved  called when it is somewhere else */
    constructor(moved) {
        this.bar_ = by_id("divider");
        this.moved_ = moved;
        this.at = 0.5; ///< of the window's width, from the left
        this.bar_.addEventListener("pointerdown", (event) => {
            if (event.button !== 0) return;
            event.preventDefault();
            this.bar_.setPointerCapture(event.pointerId);
            this.bar_.focus({ preventScroll: true });
        });
        this.bar_.addEventListener("pointermove", (event) => {
            if (this.bar_.hasPointerCapture(event.pointerId)) this.move(event.clientX / innerWidth);
        });
        this.bar_.addEventListener("keydown", (event) => this.key_(event));
    }

    show(shown) {
        this.bar_.hidden = !shown;
        if (shown) this.move(this.at);
    }

    move(at) {
        this.at = Math.max(0, Math.min(1, at));
        by_id("stage").style.setProperty("--divider", `${(100 * this.at).toFixed(3)}%`);
        this.bar_.setAttribute("aria-valuenow", String(Math.round(100 * this.at)));
        this.moved_();
    }

    key_(event) {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const step = event.shiftKey ? kLongStep : kStep;
        if (kMoves[event.key]) this.move(this.at + kMoves[event.key] * step);
        else if (event.key === "Home" || event.key === "End")
            this.move(event.key === "End" ? 1 : 0);
        else return;
        // These keys move the eye elsewhere.
        event.preventDefault();
        event.stopPropagation();
    }
}
