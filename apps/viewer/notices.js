// Texts for the user: short notices, what the page waits for, and the errors of a scene.
import { by_id, element } from "./dom.js";

const kShown = 2600,
    kShownBad = 6000; // [ms]
const kTroubles = 4; // that are shown beside the picture

let timer;

/** Show a line of text that disappears by itself. `bad`: it says that something failed. */
export function notice(text, bad = false) {
    const words = element("p", { textContent: text, className: bad ? "bad" : "" });
    by_id("notice").replaceChildren(words);
    clearTimeout(timer);
    timer = setTimeout(() => by_id("notice").replaceChildren(), bad ? kShownBad : kShown);
}

/** Cover the picture with a text that says what the page waits for; share: progress 0..1, if known. */
export function cover(text, share) {
    const box = by_id("cover"),
        bar = by_id("cover-share");
    box.classList.remove("gone");
    if (by_id("cover-text").textContent !== text) by_id("cover-text").textContent = text;
    bar.hidden = share === undefined;
    if (share !== undefined) bar.value = share;
}

export const uncover = () => by_id("cover").classList.add("gone");

/** An element for one error message of a scene: file and line, and what is wrong there. */
function failure_line(message) {
    const parts = /^(.+?:\d+(?::\d+)?:)\s*(.*)$/s.exec(message);
    const line = element("li");
    if (!parts) line.textContent = message;
    else
        line.append(element("span", { className: "where", textContent: parts[1] }), ` ${parts[2]}`);
    return line;
}

/** Show why the scene is still as it was before its files were edited; an empty list: it is as they have it. */
export function show_troubles(messages) {
    by_id("troubles").replaceChildren(...messages.slice(0, kTroubles).map(failure_line));
    const more = messages.length - kTroubles;
    if (more > 0) by_id("troubles").append(element("li", { textContent: `and ${more} more` }));
    by_id("trouble").hidden = messages.length === 0;
}

/** Show the errors for which the scene cannot be read; an empty list hides them. */
export function show_failures(messages) {
    by_id("failures").replaceChildren(...messages.map(failure_line));
    by_id("failure").hidden = messages.length === 0;
}
