// Full screen, where the browser has it: telephones often do not.
import { by_id } from "./dom.js";
import { notice } from "./notices.js";

export async function toggle_full_screen() {
    try {
        if (document.fullscreenElement) await document.exitFullscreen();
        else await document.documentElement.requestFullscreen();
    } catch {
        notice("The browser allows no full screen here", true);
    }
}

/** Make its button work; it is not shown where the browser has no full screen. */
export function start_full_screen() {
    const button = by_id("full-screen");
    button.hidden = !document.fullscreenEnabled;
    button.addEventListener("click", toggle_full_screen);
    document.addEventListener("fullscreenchange", () =>
        button.setAttribute("aria-pressed", String(Boolean(document.fullscreenElement))),
    );
}
