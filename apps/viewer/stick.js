// Thumbs: one that moves the eye as a stick does, in the left half of the screen, and one that looks.
export const kStickRadius = 56; // how far a thumb goes for full speed [CSS pixels]
const kIdle = 0.12; // what counts as no motion, as a share of that
const kTogether = 150; // fingers that come within this are a pair, unless they are far apart [ms]
const kPair = 0.55; // farthest that the fingers of a pair are apart, as a share of the screen's width

/** What a thumb asks for, [right, forward], each -1 to 1, from where it came down and where it is [CSS pixels]. */
export function stick_wish(from, to) {
    const x = (to[0] - from[0]) / kStickRadius,
        y = (from[1] - to[1]) / kStickRadius;
    const size = Math.hypot(x, y);
    if (size <= kIdle) return [0, 0];
    // From 0 at the edge of what is idle to 1 at the radius.
    const share = Math.min(1, (size - kIdle) / (1 - kIdle)) / size;
    return [x * share, y * share];
}

/** Whether a finger that comes down at x moves the eye, on a screen that is `width` wide [CSS pixels]. */
export const is_stick_side = (x, width) => x < width / 2;

/** Whether two fingers are a pair, which moves and zooms: they came together, and near each other. */
export const is_pair = (first, second, width) =>
    second.time - first.time < kTogether &&
    Math.hypot(second.at[0] - first.at[0], second.at[1] - first.at[1]) < kPair * width;

/** The mark that shows the stick under the thumb. */
export class StickMark {
    constructor(element) {
        this.element_ = element;
    }

    show(from, to) {
        const wish = stick_wish(from, to);
        this.element_.hidden = false;
        this.element_.style.translate = `${from[0]}px ${from[1]}px`;
        this.element_.firstElementChild.style.translate = `${wish[0] * kStickRadius}px ${-wish[1] * kStickRadius}px`;
    }

    hide() {
        this.element_.hidden = true;
    }
}
