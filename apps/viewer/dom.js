// Helpers that make and find elements of the document.

export const by_id = (id) => document.getElementById(id);

/** An element with properties (className, textContent, onclick, ...) and children. */
export function element(tag, properties = {}, ...children) {
    const made = Object.assign(document.createElement(tag), properties);
    made.append(...children);
    return made;
}

/** An SVG element with attributes. */
export function shape(tag, attributes = {}, text) {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    if (text !== undefined) made.textContent = text;
    return made;
}

/** One of the icons at the top of the page. */
export function icon(name) {
    const svg = shape("svg", { "aria-hidden": "true" });
    svg.append(shape("use", { href: `#i-${name}` }));
    return svg;
}

/** A small button that removes something. */
export function remove_button(what, act) {
    const button = element(
        "button",
        { type: "button", className: "icon", onclick: act },
        icon("close"),
    );
    button.setAttribute("aria-label", `Remove ${what}`);
    return button;
}

/** The radio button of a group that is checked. */
export function choose(name, value) {
    for (const input of document.getElementsByName(name)) input.checked = input.value === value;
}
