// The list of measurements: pins on surfaces, and means over areas.
import { by_id, element, remove_button } from "./dom.js";
import { quantity, within } from "./words.js";

const kNothing = "\u00a0"; // as high as an interval
const kInterval = "95 % confidence interval: what chance has made of the calculation";

function row(item, [lux, lux_95], remove) {
    const words = item.rect
        ? "mean over an area"
        : [item.surface, item.material].filter(Boolean).join(", ");
    const name = element(
        "td",
        { textContent: item.name },
        element("small", { textContent: words, title: words }),
    );
    const value = (x, half) =>
        element(
            "td",
            { textContent: Number.isFinite(x) ? quantity(x) : "–" },
            element("small", { textContent: within(x, half) || kNothing, title: kInterval }),
        );
    return element(
        "tr",
        { className: item.settled < 1 ? "unsettled" : "" },
        name,
        value(lux, lux_95),
        value(item.luminance, item.luminance_95),
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
        ...measurements.probes.map((probe) =>
            row(probe, [probe.illuminance, probe.illuminance_95], remove),
        ),
        ...measurements.areas.map((area) => row(area, [], remove)),
    );
    const none = measurements.count === 0;
    by_id("measurements").hidden = none;
    by_id("measure-hint").hidden = !none;
    for (const id of ["write-table", "write-table-too", "clear-table"]) by_id(id).disabled = none;
}
