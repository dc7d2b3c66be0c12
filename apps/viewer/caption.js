// The caption under a picture that is saved: what scene, seen from where, and how radiance became colours.
import { view_options } from "./view_text.js";
import { round_number, stops } from "./words.js";

/** How radiance became colours, in words; ev: the exposure's stops. */
export function display_words({ mode, exposure, human, scale }, ev) {
    if (mode === "false") {
        const steps = scale.log ? "logarithmic" : "linear";
        return `False colour ${round_number(scale.low)} – ${round_number(scale.high)} cd/m², ${steps}`;
    }
    const how = exposure.auto ? ", automatic" : "";
    return `Exposure ${stops(ev)} EV${how}${human ? ", as the eye sees" : ""}`;
}

/** What stands under every picture that is saved as the eye was shown it, without its noise. */
export const kDenoised = "Denoised for the eye: its pixels are not what was calculated.";

const rounded = (x) => (Array.isArray(x) ? x.map(rounded) : Number(Number(x).toPrecision(5)));

/**
 * The lines of a caption.
 * @param scene  its name
 * @param view   nothing where it is not known
 * @param date   of the picture
 */
export function caption_lines(scene, view, display, ev, date) {
    const when = `${date.toISOString().slice(0, 16).replace("T", " ")} UTC`;
    const name = scene.split(/[\\/]/).pop() || "Lightwalk";
    const short = (v) =>
        Object.fromEntries(
            Object.entries(v).map(([key, x]) => [key, key === "type" ? x : rounded(x)]),
        );
    const place = view ? [view_options(short(view)).replace(/ -v[oasl] 0(?= |$)/g, "")] : [];
    return [`${name}   ${display_words(display, ev)}   ${when}`, ...place];
}

/** The lines, broken between words so that none is wider than `width`; `measure`: the width of a text. */
export function broken_lines(lines, width, measure) {
    return lines.flatMap((line) => {
        const broken = [];
        let present = "";
        for (const word of line.split(/(?<=\S) (?=\S)/)) {
            const longer = present ? `${present} ${word}` : word;
            if (present && measure(longer) > width) {
                broken.push(present);
                present = word;
            } else present = longer;
        }
        return [...broken, present];
    });
}
