// The view in the page's address: a link is a view, and the browser's Back and Forward go along views that were chosen.
// Does not use the document: the page passes the address on, and the browser's history.
import { normalize } from "./vector.js";

const kRest = 400; // how long the eye stands still before its view is put into the address [ms]

const kVectors = { vp: "position", vd: "direction", vu: "up" };
const kScalars = { vh: "horizontal", vo: "fore", va: "aft", vs: "shift", vl: "lift" };
// What is not in the address. The vertical size is never there: it follows the window.
const kUsual = {
    type: "v",
    up: [0, 0, 1],
    horizontal: 45,
    vertical: 45,
    fore: 0,
    aft: 0,
    shift: 0,
    lift: 0,
};
const kFarthest = 1e9; // largest number that the server accepts

const short = (x) => String(Number(x.toPrecision(6)));

/** The fragment of an address for a view, in the letters of Radiance's options: "#vp=3,-2.2,1.6&vd=0,1,0&vh=70". */
export function view_fragment(view) {
    const vector = (v) => v.map(short).join(",");
    const words = view.type === kUsual.type ? [] : [`vt=${view.type}`];
    for (const [key, name] of Object.entries(kVectors)) {
        const value = name === "position" ? view[name] : normalize(view[name]);
        // Five digits of a direction are less than a pixel of any screen.
        const text = vector(name === "position" ? value : value.map((x) => Number(x.toFixed(5))));
        if (name !== "up" || text !== vector(kUsual.up)) words.push(`${key}=${text}`);
    }
    for (const [key, name] of Object.entries(kScalars)) {
        const text = short(view[name] || 0);
        if (name === "horizontal" || text !== "0") words.push(`${key}=${text}`);
    }
    return `#${words.join("&")}`;
}

/** `count` numbers that commas separate, or nothing. */
function numbers_of(text, count) {
    const words = text.split(",");
    const numbers = words.map(Number);
    const sound = (x, k) => words[k].trim() !== "" && Math.abs(x) <= kFarthest;
    return numbers.length === count && numbers.every(sound) ? numbers : null;
}

/** The view of an address's fragment; null when it names none, or one that cannot be drawn. */
export function fragment_view(fragment) {
    const view = { ...kUsual };
    for (const [key, text] of new URLSearchParams(fragment.replace(/^#/, ""))) {
        const name = kVectors[key] ?? kScalars[key];
        const numbers = name ? numbers_of(text, kVectors[key] ? 3 : 1) : null;
        if (key === "vt" && /^[vlchas]$/.test(text)) view.type = text;
        else if (!numbers) return null;
        else view[name] = kVectors[key] ? numbers : numbers[0];
    }
    if (!view.position || !view.direction || !(view.horizontal > 0)) return null;
    const forward = normalize(view.direction),
        up = normalize(view.up);
    const cosine = forward.reduce((sum, x, k) => sum + x * up[k], 0);
    const still = (v) => v.every((x) => x === 0);
    return still(forward) || still(up) || Math.abs(cosine) > 1 - 1e-9 ? null : view;
}

export class Address {
    /** @param write  (fragment, new_entry): puts the fragment into the address, as a new entry of the history or not */
    constructor(write) {
        this.write_ = write;
        this.text_ = null; // the fragment that is in the address
        this.seen_ = null;
        this.since_ = 0; // when the view became what it is [ms]
        this.chosen_ = false;
    }

    /** The eye goes to a view that was chosen: where it comes to rest becomes a new entry of the history. */
    choose() {
        this.chosen_ = true;
    }

    /** The address was changed by the browser. */
    read(fragment) {
        this.text_ = fragment;
        this.chosen_ = false;
    }

    /** Look at the eye some times a second; `now` in ms. What is in the address follows it when it rests. */
    follow(view, moving, now) {
        const text = view_fragment(view);
        if (moving || text !== this.seen_) {
            this.seen_ = text;
            this.since_ = now;
            return;
        }
        if (now - this.since_ < kRest || text === this.text_) return;
        this.write_(text, this.chosen_ && this.text_ !== null);
        this.text_ = text;
        this.chosen_ = false;
    }
}
