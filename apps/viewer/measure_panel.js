// The list of measurements: pins on surfaces, and means over areas.
import { by_id, element, remove_button } from "./dom.js";
import { quantity } from "./words.js";

function row(item, lux, remove) {
    const words = item.rect
        ? "mean over an area"
        : [item.surface, item.material].filter(Boolean).join(", ");
    const name = element(
        "td",
        { textContent: item.name },
        element("small", { textContent: words, title: words }),
    );
    const value = (x) => element("td", { textContent: Number.isFinite(x) ? quantity(x) : "–" });
    return element(
        "tr",
        { className: item.settled < 1 ? "unsettled" : "" },
        name,
        value(lux),
        value(item.luminance),
        element(
            "td",
            {},
            remove_button(item.name, () => remove(item.id)),
        ),
    );
}

/** Show all measurements; values that are not final yet are grey. */
export function show_measurements(measurements) {
    const remove = (id) => measurements.remove(id);
    by_id("measured").replaceChildren(
        ...measurements.probes.map((probe) => row(probe, probe.illuminance, remove)),
        ...measurements.areas.map((area) => row(area, null, remove)),
    );
    const none = measurements.count === 0;
    by_id("measurements").hidden = none;
    by_id("measure-hint").hidden = !none;
    for (const id of ["write-table", "write-table-too", "clear-table"]) by_id(id).disabled = none;
}
