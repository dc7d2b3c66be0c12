// Words to the user: short notices, what the page waits for, and a scene's errors.
import { by_id, element } from "./dom.js";

const kShown = 2600,
    kShownBad = 6000; // [ms]

let timer;

/** A line that goes by itself. `bad`: something did not work. */
export function notice(text, bad = false) {
    const words = element("p", { textContent: text, className: bad ? "bad" : "" });
    by_id("notice").replaceChildren(words);
    clearTimeout(timer);
    timer = setTimeout(() => by_id("notice").replaceChildren(), bad ? kShownBad : kShown);
}

/** What the page waits for, over the whole picture; share 0..1 of it, if known. */
export function cover(text, share) {
    const box = by_id("cover"),
        bar = by_id("cover-share");
    box.classList.remove("gone");
    if (by_id("cover-text").textContent !== text) by_id("cover-text").textContent = text;
    bar.hidden = share === undefined;
    if (share !== undefined) bar.value = share;
}

export const uncover = () => by_id("cover").classList.add("gone");

/** One message of the scene's reader: where it stands and what is wrong there. */
function failure_line(message) {
    const parts = /^(.+?:\d+(?::\d+)?:)\s*(.*)$/s.exec(message);
    const line = element("li");
    if (!parts) line.textContent = message;
    else
        line.append(element("span", { className: "where", textContent: parts[1] }), ` ${parts[2]}`);
    return line;
}

/** The messages why the scene cannot be read; none: it can. */
export function show_failures(messages) {
    by_id("failures").replaceChildren(...messages.map(failure_line));
    by_id("failure").hidden = messages.length === 0;
}
