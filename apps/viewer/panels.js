// Panels over the picture: opened on request, and hidden when nobody uses them.
import { by_id } from "./dom.js";
import { start_full_screen } from "./full_screen.js";

const kIdle = 3500; // the dock fades after so long without input [ms]
const kIdleMoving = 700; // the same time while the eye moves [ms]

/** The element id of the panel that is open, or nothing. */
let open = null;

/** Whether a panel of that name is open. */
export const is_open = (name) => open === name;

const button_of = (name) => document.querySelector(`#dock [data-panel=${name}]`);

/** Open a panel and close the one that is open. The id of the open panel, or nothing, only closes it. */
export function toggle_panel(name) {
    if (open) {
        by_id(`panel-${open}`).hidden = true;
        button_of(open).setAttribute("aria-expanded", "false");
    }
    open = name === open ? null : name;
    if (!open) return;
    by_id(`panel-${open}`).hidden = false;
    button_of(open).setAttribute("aria-expanded", "true");
}

export function close_panel() {
    if (!open) return false;
    const button = button_of(open);
    const inside = by_id(`panel-${open}`).contains(document.activeElement);
    toggle_panel(null);
    if (inside) button.focus();
    return true;
}

/** Show the buttons of panels that are of use, and close a panel that is not. @param there  {name: whether it is of use} */
export function offer_panels(there) {
    for (const [name, is_there] of Object.entries(there)) {
        button_of(name).hidden = !is_there;
        if (!is_there && is_open(name)) close_panel();
    }
}

/** The dock and the head fade while nobody uses them, at once while the eye moves. */
function fade_when_idle() {
    let timer;
    const set = (alone) => document.body.classList.toggle("alone", alone && !open);
    const wake = (idle) => {
        set(false);
        clearTimeout(timer);
        timer = setTimeout(() => set(true), idle);
    };
    for (const name of ["pointermove", "pointerdown", "focusin"])
        addEventListener(name, (event) =>
            wake(event.buttons && event.target.id === "picture" ? kIdleMoving : kIdle),
        );
    addEventListener("keydown", (event) => {
        if (event.key === "Tab" || event.key === "Escape") wake(kIdle);
    });
    wake(2 * kIdle);
}

export function start_panels() {
    start_full_screen();
    for (const button of document.querySelectorAll("#dock [data-panel]"))
        button.addEventListener("click", () => toggle_panel(button.dataset.panel));
    const help = by_id("help");
    by_id("show-help").addEventListener("click", () => help.showModal());
    by_id("close-help").addEventListener("click", () => help.close());
    help.addEventListener("click", (event) => {
        if (event.target === help) help.close();
    });
    fade_when_idle();
}

export function toggle_help() {
    const help = by_id("help");
    if (help.open) help.close();
    else help.showModal();
}

/** Show or hide the small table of figures. */
export function toggle_status() {
    const shown = by_id("status").hidden;
    by_id("status").hidden = !shown;
    by_id("show-status").setAttribute("aria-pressed", String(shown));
}
