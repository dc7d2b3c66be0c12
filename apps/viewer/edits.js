// Changed materials: which numbers they have in place of their own, step by step, and as a message.

export const kMostEdits = 64; // of one walk
const kMostSteps = 100; // that can be undone
const kOneStep = 1000; // changes of one number within this time are one step [ms]

const same = (a, b) => a.name === b.name && a.definition === b.definition;
const equal = (a, b) => a.length === b.length && a.every((value, k) => value === b[k]);

/** What a message tells of changed materials; what is not sound is left out. */
export const sound_edits = (materials) =>
    (Array.isArray(materials) ? materials : [])
        .filter(
            (one) =>
                typeof one?.name === "string" &&
                typeof one.kind === "string" &&
                Number.isInteger(one.definition) &&
                Array.isArray(one.reals) &&
                one.reals.every(Number.isFinite),
        )
        .slice(0, kMostEdits)
        .map(({ name, definition, kind, reals }) => ({ name, definition, kind, reals }));

export class Edits {
    constructor() {
        this.list = []; ///< [{name, definition, kind, reals}]: materials that are not as the scene has them
        this.before_ = []; // lists of before, the newest last
        this.last_ = { key: "", time: -Infinity };
    }

    /** The numbers of a layer (see material_panel.js) as they are now. */
    reals_of(layer) {
        return this.list.find((one) => same(one, layer))?.reals ?? layer.built;
    }

    is_changed(layer) {
        return this.list.some((one) => same(one, layer));
    }

    /** Change one number of a layer; returns whether there is room for it. */
    change(layer, index, value, time) {
        const reals = [...this.reals_of(layer)];
        reals[index] = value;
        return this.set(layer, reals, `${layer.name} ${layer.definition} ${index}`, time);
    }

    /** Give a layer these numbers. Changes of the same key one after the other are one step to be undone. */
    set(layer, reals, key = "", time = 0) {
        const { name, definition, kind, built } = layer;
        const others = this.list.filter((one) => !same(one, layer));
        if (others.length >= kMostEdits) return false;
        const more = equal(reals, built) ? [] : [{ name, definition, kind, reals }];
        const goes_on = key !== "" && key === this.last_.key && time - this.last_.time < kOneStep;
        this.last_ = { key, time };
        this.step_([...others, ...more], goes_on);
        return true;
    }

    /** Make materials as the scene has them: one, or all. */
    reset(layer) {
        this.last_ = { key: "", time: 0 };
        this.step_(layer ? this.list.filter((one) => !same(one, layer)) : [], false);
    }

    get can_undo() {
        return this.before_.length > 0;
    }

    undo() {
        if (this.before_.length === 0) return;
        this.list = this.before_.pop();
        this.last_ = { key: "", time: 0 };
    }

    /** Take what the server says; there is nothing to undo of it. */
    take(materials) {
        this.list = sound_edits(materials);
    }

    forget() {
        this.list = [];
        this.before_ = [];
    }

    step_(list, goes_on) {
        if (!goes_on) this.before_ = [...this.before_, this.list].slice(-kMostSteps);
        this.list = list;
    }
}

/** A number as a person has typed it, with a decimal point or comma; NaN where it is none. */
export const number_of = (text) => {
    const words = String(text).trim().replace(",", ".");
    return words === "" ? NaN : Number(words);
};

const shown = (value) => String(Number(value.toPrecision(6)));
const unit_of = ({ unit }) => (unit ? ` ${unit}` : "");

/** What an argument is called. */
export const words_of = ({ quantity, channel }) => (channel ? `${quantity}, ${channel}` : quantity);

/** Why an argument cannot be this number; "": it can. */
export function problem_of(argument, value) {
    const { low, high } = argument;
    if (!Number.isFinite(value)) return `The ${words_of(argument)} must be a number.`;
    if (value >= low && value <= high) return "";
    return `The ${words_of(argument)} must be from ${shown(low)} to ${shown(high)}${unit_of(argument)}.`;
}

/** Arguments as they are shown: those of red, green and blue in a row as one. Each: {quantity, indices, colour}. */
export function rows_of(names) {
    const rows = [];
    for (const [index, { quantity, channel, high }] of names.entries()) {
        const last = rows.at(-1);
        if (channel && last?.quantity === quantity) last.indices.push(index);
        else rows.push({ quantity, indices: [index], colour: channel === "red" && high <= 1 });
    }
    return rows;
}

// Colours of a screen: IEC 61966-2-1 (sRGB). Its primaries are near Radiance's.
const kKnee = 0.0031308;
const encode = (x) => (x <= kKnee ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const decode = (x) => (x <= 12.92 * kKnee ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);

/** Three channels from 0 to 1 as "#rrggbb", and back, to four digits. */
export const colour_of = (rgb) =>
    `#${rgb
        .map((x) =>
            Math.round(255 * encode(Math.max(0, Math.min(1, x))))
                .toString(16)
                .padStart(2, "0"),
        )
        .join("")}`;
export const rgb_of = (colour) =>
    [1, 3, 5].map((at) => Number(decode(parseInt(colour.slice(at, at + 2), 16) / 255).toFixed(4)));
