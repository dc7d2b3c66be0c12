// Numbers as text for people: three significant digits, separated thousands, units.

const kThin = "\u202f";

/** A positive quantity with about three significant digits: 0.0123, 4.56, 78.9, 1 230. */
export function quantity(value) {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    if (size === 0) return "0";
    if (size < 1e-3 || size >= 1e7)
        return value.toExponential(2).replace("e", "·10^").replace("^+", "^");
    const decimals = Math.max(0, 2 - Math.floor(Math.log10(size) + 1e-9));
    const [whole, part] = value.toFixed(decimals).split(".");
    const apart = whole.replace(/\B(?=(\d{3})+$)/g, kThin);
    return part ? `${apart}.${part}` : apart;
}

/** A quantity that is known to a few per cent only: two significant digits. */
export const rough = (value) =>
    Number.isFinite(value)
        ? quantity(Number(value.toPrecision(2)))
              .replace(/(\.\d*?)0+$/, "$1")
              .replace(/\.$/, "")
        : "–";

/** A number that is round already, with all its digits: 0.05, 30, 1 000. */
export function round_number(value) {
    if (Math.abs(value) >= 1e7 || (value !== 0 && Math.abs(value) < 1e-4)) return quantity(value);
    const [whole, part] = String(value).split(".");
    const apart = whole.replace(/\B(?=(\d{3})+$)/g, kThin);
    return part ? `${apart}.${part}` : apart;
}

export const percent = (share) => `${Math.round(share * 100)}${kThin}%`;

/** A text that the server begins with a small letter. */
export const sentence = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/** What the page waits for without a connection. reason: what the server said, if anything; greeted: whether it has ever answered; wait [ms]. */
export function lost_words(reason, greeted, wait) {
    const unsaid = greeted ? "The connection to the server is lost." : "No answer from the server.";
    const when = wait >= 1000 ? ` in ${Math.round(wait / 1000)} s` : "";
    return `${reason || unsaid} Trying again${when}…`;
}

/** A rate of rays: 2.4 M, 310 k. */
export function many(value) {
    if (!Number.isFinite(value)) return "–";
    if (value >= 1e6) return `${(value / 1e6).toFixed(value < 1e7 ? 2 : 1)}${kThin}M`;
    if (value >= 1e3) return `${Math.round(value / 1e3)}${kThin}k`;
    return String(Math.round(value));
}

/**
 * How well a value is known: "± 3 %" of it, rounded up, where `half` is how far its 95 % interval reaches to both sides. Nothing where no
 * part of it is by chance, or where that is not told.
 */
export function within(value, half) {
    const share = half / Math.abs(value);
    if (!(half > 0) || !Number.isFinite(share) || share < 1e-6) return "";
    const per_cent = Math.ceil(share * 100 - 1e-9);
    const words = share < 0.01 ? "<1" : per_cent > 99 ? ">99" : String(per_cent);
    return `±${kThin}${words}${kThin}%`;
}

/** A value with its unit and how well it is known: 430 lx ± 3 %. */
export const known = (value, half, unit) =>
    [`${quantity(value)} ${unit}`, within(value, half)].filter(Boolean).join(" ");

export const place = (position) => position.map((x) => x.toFixed(2)).join(", ");

/** An exposure in stops with its sign. */
export const stops = (ev) => `${ev < 0 ? "−" : "+"}${Math.abs(ev).toFixed(1)}`;

/** The class of perceived glare for a daylight glare probability (Wienold & Christoffersen 2006). */
export function glare_word(dgp) {
    if (dgp < 0.35) return "imperceptible";
    if (dgp < 0.4) return "perceptible";
    if (dgp < 0.45) return "disturbing";
    return "intolerable";
}

/** The classes that a probability belongs to which is known to `half`: "perceptible to disturbing". */
export function glare_words(dgp, half) {
    const reach = half > 0 ? half : 0;
    const [least, most] = [glare_word(dgp - reach), glare_word(dgp + reach)];
    return least === most ? least : `${least} to ${most}`;
}

/** How well a number is known that is read to two decimals: "± 0.01", rounded up; nothing as within() has it. */
export const within_hundredths = (half) =>
    half > 1e-6 ? `±${kThin}${(Math.ceil(half * 100 - 1e-9) / 100).toFixed(2)}` : "";

const kPhases = {
    filling: "drawing",
    refining: "refining",
    ambient: "ambient light",
    done: "done",
};

/** What the server does to a picture, and how far it is where that is known. What is not done is never 100 %. */
export function phase_words(phase, share) {
    const words = kPhases[phase] ?? "";
    if (!words || phase === "done" || !(share < 1)) return words;
    return `${words} ${Math.max(0, Math.floor(share * 100))}${kThin}%`;
}

/** What the pixels of a frame in motion are, [name, share], as far as a `state` message tells. */
export function pixel_shares({ reuse, inferred, guessed }) {
    if (!Number.isFinite(reuse)) return [];
    const [near, filled] = [inferred, guessed].map((share) => (Number.isFinite(share) ? share : 0));
    return [
        ["Reused", reuse],
        ["Inferred", near],
        ["Guessed", filled],
        ["Traced", Math.max(0, 1 - reuse - near - filled)],
    ];
}
