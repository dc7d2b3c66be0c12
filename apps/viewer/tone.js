// How luminance becomes colours, as the server does it, and back: of pictures that are here the page changes exposure and
// colours by itself. Does not use the document.
import { palette_colour, share_of } from "./scale.js";

const kEfficacy = 179; // of Radiance's white light [lm/W]
const kWeights = [0.265, 0.67, 0.065]; // of red, green and blue in its luminance
const kMiddleGrey = 0.18;
const kKnee = 2 * kMiddleGrey;
const kFading = 0.03;
const kFixedWhite = 16; // of exposures that are not automatic
const kShareBelowWhite = 0.999;
const kDark = 4,
    kBright = 251; // bytes up to and from which a pixel's largest channel tells nothing of its luminance
const kSteps = 4096;

const to_linear = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
const to_srgb = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const kLinear = Float64Array.from({ length: 256 }, (_, k) => to_linear(k / 255));
/** sRGB bytes (IEC 61966-2-1), by the square root of a linear value 0..1. */
const kBytes = Uint8Array.from({ length: kSteps + 1 }, (_, k) =>
    Math.round(255 * to_srgb((k / kSteps) ** 2)),
);
const byte_of = (x) => kBytes[Math.round(kSteps * Math.sqrt(Math.min(1, Math.max(0, x))))];

/**
 * The curve that compresses highlights so that `white` becomes 1. Source: Drago et al., "Adaptive logarithmic mapping for
 * displaying high contrast scenes", Eurographics 2003, eq. 1.
 */
export class HighlightCurve {
    constructor(white) {
        this.white = Math.max(1, white);
        const w = (this.white - kKnee) / (1 - kKnee);
        let [low, high] = [1e-9, 2 * w];
        for (let k = 0; k < 60; ++k) {
            const c = (low + high) / 2;
            if (Math.log1p(c * w) > c) low = c;
            else high = c;
        }
        this.c_ = low;
    }

    /** The value shown for an exposed value x. */
    shown(x) {
        if (x <= kKnee) return x;
        if (x >= this.white) return 1;
        const u = (x - kKnee) / (1 - kKnee);
        return Math.min(1, kKnee + ((1 - kKnee) * Math.log1p(this.c_ * u)) / this.c_);
    }

    /** The exposed value that is shown as y, 0..1. */
    exposed(y) {
        if (y <= kKnee) return y;
        return kKnee + ((1 - kKnee) * Math.expm1((this.c_ * (y - kKnee)) / (1 - kKnee))) / this.c_;
    }
}

/**
 * Luminance at a quarter of a picture's size.
 * @property greys  Uint8Array, row by row from the top, width x height: grey g is 2^(low + g step) cd/m2, 0 is black
 */
export class Luminance {
    constructor({ low, step, width, height, greys }) {
        Object.assign(this, { width, height, greys });
        this.values = Float32Array.from({ length: 256 }, (_, g) => (g ? 2 ** (low + g * step) : 0));
    }

    /** At a place 0..1 from the left and the top [cd/m2]. */
    at(x, y) {
        const place = (share, size) => Math.max(0, Math.min(size - 1, Math.floor(share * size)));
        return this.values[this.greys[place(y, this.height) * this.width + place(x, this.width)]];
    }
}

/** The tone that the server would choose for a picture of this luminance: {exposure, white}. */
export function automatic_tone({ greys, values }) {
    const counts = new Array(256).fill(0);
    for (const grey of greys) ++counts[grey];
    const lit = greys.length - counts[0];
    if (lit === 0) return { exposure: 1, white: 1 };
    let sum = 0,
        below = 0,
        white = 0;
    for (let g = 1; g < 256; ++g) {
        if (counts[g] === 0) continue;
        sum += counts[g] * Math.log(values[g] / kEfficacy);
        if (below < kShareBelowWhite * lit) white = values[g] / kEfficacy;
        below += counts[g];
    }
    const exposure = kMiddleGrey / Math.exp(sum / lit);
    return { exposure, white: Math.max(1, exposure * white) };
}

/** The tone of a display's settings where they are fixed, or for a picture of this luminance. */
function tone_of({ exposure: { auto, ev } }, luminance) {
    return auto ? automatic_tone(luminance) : { exposure: 2 ** ev, white: kFixedWhite };
}

/** Whether the colours of a display can be made here: human vision cannot. */
export const can_make = (display) => display.mode === "false" || !display.human;

// Luminances by the upper bits of positive floats: 128 steps an octave.
const kDropped = 16;
const kFloat = new Float32Array(1),
    kBits = new Uint32Array(kFloat.buffer);

/** False colours of all luminances: [r, g, b, ...]. */
function false_colours(scale) {
    const bytes = new Uint8Array(3 << (31 - kDropped));
    for (let k = 0; 3 * k < bytes.length; ++k) {
        kBits[0] = (k << kDropped) | (1 << (kDropped - 1));
        const share = share_of(scale, kFloat[0]);
        bytes.set(palette_colour(share === share ? share : 0), 3 * k);
    }
    return bytes;
}

/** What writes the colour of an exposed pixel e [r, g, b] with luminance L [cd/m2] to out[at...]. */
function writer(display, luminance, exposure) {
    if (display.mode === "false") {
        const colours = false_colours(display.scale);
        return (out, at, e, L) => {
            kFloat[0] = L;
            const k = 3 * (kBits[0] >>> kDropped);
            out[at] = colours[k];
            out[at + 1] = colours[k + 1];
            out[at + 2] = colours[k + 2];
        };
    }
    const tone = tone_of(display, luminance);
    const curve = new HighlightCurve(tone.white);
    const factor = tone.exposure / exposure;
    return (out, at, e) => {
        const before = factor * Math.max(e[0], e[1], e[2]);
        const shown = curve.shown(before);
        const saturation = 1 / (1 + kFading * Math.max(before - shown, 0));
        const by = before > 0 ? (factor * shown * saturation) / before : 0;
        const white = shown * (1 - saturation);
        for (let c = 0; c < 3; ++c) out[at + c] = byte_of(by * e[c] + white);
    };
}

/** What turns bytes back: exposed(data, at, e) fills in e [r, g, b], and returns the largest byte. */
function reader(tone) {
    const curve = new HighlightCurve(tone.white);
    const before = Float64Array.from({ length: 256 }, (_, k) => curve.exposed(kLinear[k]));
    const saturation = before.map((x, k) => 1 / (1 + kFading * (x - kLinear[k])));
    const white = saturation.map((x, k) => kLinear[k] * (1 - x));
    const by = before.map((x, k) => (k > 0 ? x / (kLinear[k] * saturation[k]) : 0));
    return (data, at, e) => {
        const peak = Math.max(data[at], data[at + 1], data[at + 2]);
        for (let c = 0; c < 3; ++c)
            e[c] = Math.max(0, by[peak] * (kLinear[data[at + c]] - white[peak]));
        return peak;
    };
}

/**
 * Give a picture the colours of another display, in place.
 * @param data       r, g, b, a bytes, width x height, as a tone has made them
 * @param tone       {exposure, white} of what is there
 * @param luminance  tells what is darker or brighter than bytes can tell
 * @param display    as the `display` message has it; can_make() it
 */
export function recolour(data, width, height, tone, luminance, display) {
    const read = reader(tone),
        write = writer(display, luminance, tone.exposure);
    const to_candela = kEfficacy / tone.exposure;
    const { greys, values } = luminance;
    const columns = Int32Array.from({ length: width }, (_, x) =>
        Math.floor(((x + 0.5) * luminance.width) / width),
    );
    const e = [0, 0, 0];
    for (let y = 0, at = 0; y < height; ++y) {
        const row = Math.floor(((y + 0.5) * luminance.height) / height) * luminance.width;
        for (let x = 0; x < width; ++x, at += 4) {
            const peak = read(data, at, e);
            let L = to_candela * (kWeights[0] * e[0] + kWeights[1] * e[1] + kWeights[2] * e[2]);
            if (peak <= kDark || peak >= kBright) {
                const known = values[greys[row + columns[x]]];
                // What is known stands for four by four pixels: beside it a pixel may be as it seems.
                if (peak <= kDark ? known <= 2 * L || L === 0 : known > L) {
                    const factor = L > 0 ? known / L : 0;
                    for (let c = 0; c < 3; ++c) e[c] = L > 0 ? factor * e[c] : known / to_candela;
                    L = known;
                }
            }
            write(data, at, e, L);
        }
    }
}
