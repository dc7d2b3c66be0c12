// What a frame hides: whether something is in front of a place of the scene, by the frame's depth.
import { kNumbers } from "./depth.js";
import { dot, subtract } from "./vector.js";
import { axes_of, locator } from "./view.js";

const kCell = 4; // side of the index's cells [pixels]
const kGuessed = 8; // flag of a patch: no distance is known
const kNearer = 0.015; // so much nearer than a place is what hides it, as a share of its distance
const kSteps = 2; // and by so many steps of inverse depth

const signed = (x) => (x << 16) >> 16;

export class Sight {
    /**
     * @param depth  as decode_depth() returns it
     * @param view   of the frame, a perspective one; width, height: of its picture [pixels]
     */
    constructor(depth, view, width, height) {
        Object.assign(this, { depth, view, width, height });
        this.forward_ = axes_of(view).forward;
        this.locate_ = locator(view);
        this.across_ = Math.ceil(width / kCell);
        this.patches_ = new Uint32Array(this.across_ * Math.ceil(height / kCell));
        for (let k = 0; k < depth.count; ++k) this.enter_(k);
    }

    enter_(k) {
        const [x, y, shape] = this.depth.patches.subarray(kNumbers * k, kNumbers * k + 3);
        const cells = Math.max(1, (1 << (shape & 7)) / kCell);
        const column = Math.floor(x / kCell),
            row = Math.floor(y / kCell);
        const last = Math.min(column + cells, this.across_);
        for (let r = row; r < row + cells; ++r)
            this.patches_.fill(k, r * this.across_ + column, r * this.across_ + last);
    }

    /** Inverse depth at a place of the picture [pixels from the upper left]; 0: nothing is known to be there. */
    inverse_depth_(x, y) {
        const cell = Math.floor(y / kCell) * this.across_ + Math.floor(x / kCell);
        const at = kNumbers * this.patches_[cell];
        const [px, py, shape, value, right, down] = this.depth.patches.subarray(at, at + 6);
        if (shape & kGuessed) return 0;
        const half = (1 << (shape & 7)) / 2;
        // Small patches share a cell of the index: one must not be continued far beyond itself.
        const from = (at, p) => Math.max(-half - 1, Math.min(half + 1, at - p - half));
        const slope = signed(right) * from(x, px) + signed(down) * from(y, py);
        return (value + slope / 64) * this.depth.step;
    }

    /** Whether the frame shows something in front of a place. Nothing is known of what is beside the frame. */
    hides(place) {
        const at = this.locate_(place);
        if (!at.visible) return false;
        const far = dot(subtract(place, this.view.position), this.forward_);
        const y = (1 - at.y) * this.height;
        const seen = this.inverse_depth_(at.x * this.width, y);
        return seen * (1 - kNearer) - kSteps * this.depth.step > 1 / far;
    }
}
