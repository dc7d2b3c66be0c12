// Keys that trigger an action once; the page's help lists them.

/** Whether a key press belongs to a control that takes text or to an open dialog. */
function elsewhere(target) {
    return (
        target instanceof HTMLElement &&
        (target.matches(
            "input:not([type=checkbox], [type=radio], [type=range]), select, textarea",
        ) ||
            target.closest("dialog"))
    );
}

/**
 * @param actions  the action of each key, by the character that it types ("?", "+", "1") or its name ("Enter")
 * Letters work in upper and lower case. Enter and the space bar work only while the picture has the focus, as
 * they press buttons elsewhere.
 */
export function listen_for_shortcuts(actions, picture) {
    addEventListener("keydown", (event) => {
        if (event.defaultPrevented || event.repeat || elsewhere(event.target)) return;
        const undo = event.key.toLowerCase() === "z" && (event.ctrlKey || event.metaKey);
        if (!undo && (event.ctrlKey || event.metaKey || event.altKey)) return;
        const name = undo
            ? "Backspace"
            : event.key.length === 1
              ? event.key.toLowerCase()
              : event.key;
        if ((name === "Enter" || name === " ") && event.target !== picture) return;
        const act = actions[name];
        if (!act) return;
        event.preventDefault();
        act(event);
    });
}
