// Views as text in Radiance's format: lines of view files, and paths of key views.
import { view_problem } from "./view.js";

/** A number with its significant digits, without an exponent where that is possible. */
function number_text(value, digits) {
    return String(Number(value.toPrecision(digits)));
}

/** The view as options of Radiance's programs, e.g. "-vtv -vp 1 2 3 -vd 0 1 0 ...". */
export function view_options(view) {
    const vector = (name, v, digits) =>
        `-v${name} ${v.map((x) => number_text(x, digits)).join(" ")}`;
    const scalar = (name, x) => `-v${name} ${number_text(x || 0, 6)}`;
    return [
        `-vt${view.type}`,
        vector("p", view.position, 8),
        vector("d", view.direction, 8),
        vector("u", view.up, 8),
        scalar("h", view.horizontal),
        scalar("v", view.vertical),
        scalar("o", view.fore),
        scalar("a", view.aft),
        scalar("s", view.shift),
        scalar("l", view.lift),
    ].join(" ");
}

/** One line of a view file. */
export const view_line = (view) => `VIEW= ${view_options(view)}\n`;

/** Keys of a path as `lightwalk animate --path` reads them: a time [s] and a view a line. */
export function path_text(keys) {
    return keys.map((key) => `${number_text(key.time, 6)} ${view_line(key.view)}`).join("");
}

const kVectors = { p: "position", d: "direction", u: "up" };
const kScalars = {
    h: "horizontal",
    v: "vertical",
    o: "fore",
    a: "aft",
    s: "shift",
    l: "lift",
};
const kStart = {
    type: "v",
    position: [0, 0, 0],
    direction: [0, 1, 0],
    up: [0, 0, 1],
    horizontal: 45,
    vertical: 45,
    fore: 0,
    aft: 0,
    shift: 0,
    lift: 0,
};
// In the files of paths a time precedes the view.
const kViewLine =
    /^\s*(?:([-+]?[\d.][-+\d.e]*)\s+)?(?:VIEW=|(?:rvu|rview|rpict|rtrace|rpiece|pinterp)(?=\s))(.*)$/;

/** The `count` numbers that follow word k, or nothing when there are fewer. */
function numbers_after(words, k, count) {
    const numbers = words.slice(k + 1, k + 1 + count).map(Number);
    return numbers.length === count && numbers.every(Number.isFinite) ? numbers : null;
}

/** The view after the options in `words` are applied, and how many options there were. */
function apply_options(words, view) {
    const changed = { ...view };
    let applied = 0;
    for (let k = 0; k < words.length; ++k) {
        const option = /^-v(t?)([a-z])$/.exec(words[k]);
        if (!option) continue;
        const [, is_type, letter] = option;
        const name = kVectors[letter] || kScalars[letter];
        if (is_type) {
            if (!"vlchas".includes(letter)) continue;
            changed.type = letter;
        } else {
            if (!name) continue;
            const numbers = numbers_after(words, k, kVectors[letter] ? 3 : 1);
            if (!numbers) continue;
            changed[name] = kVectors[letter] ? numbers : numbers[0];
            k += numbers.length;
        }
        ++applied;
    }
    return { view: changed, applied };
}

/**
 * The keys {time [s], view} of a view file or path, one for each view line; options that a line does not have are taken
 * from the line before, and a time that it does not have is a second after the last. Throws Error when there is
 * no view, and for one that cannot be drawn.
 */
export function parse_keys(text) {
    const keys = [];
    let view = kStart;
    for (const [number, line] of text.split(/\r?\n/).entries()) {
        const found = kViewLine.exec(line);
        if (!found) continue;
        const result = apply_options(found[2].trim().split(/\s+/), view);
        if (result.applied === 0) continue;
        view = result.view;
        const problem = view_problem(view);
        if (problem) throw new Error(`line ${number + 1}: ${problem}`);
        const next = keys.length === 0 ? 0 : keys.at(-1).time + 1;
        keys.push({ time: found[1] === undefined ? next : Number(found[1]), view });
    }
    if (keys.length === 0) throw new Error('no line like "VIEW= -vp x y z -vd x y z"');
    return keys;
}

/** The views of a view file or path; see parse_keys(). */
export const parse_views = (text) => parse_keys(text).map(({ view }) => view);
