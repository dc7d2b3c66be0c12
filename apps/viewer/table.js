// All measurements as a table that spreadsheets read (CSV, RFC 4180).
import { view_options } from "./view_text.js";

const kColumns = [
    "kind",
    "name",
    "illuminance_lx",
    "illuminance_95_lx",
    "luminance_cd_m2",
    "luminance_95_cd_m2",
    "x_m",
    "y_m",
    "z_m",
    "normal_x",
    "normal_y",
    "normal_z",
    "material",
    "surface",
    "settled",
    "left",
    "bottom",
    "right",
    "top",
    "pixels",
    "view",
    "ambient",
    "scene",
    "time",
];

/** A cell of the table; text that a spreadsheet would take for a formula is marked as text. */
function cell(value) {
    if (value === null || value === undefined) return "";
    if (typeof value === "number") return Number.isFinite(value) ? String(value) : "";
    const text = /^[=+\-@\t\r]/.test(value) ? `'${value}` : String(value);
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

function probe_row(probe) {
    const [x_m, y_m, z_m] = probe.position;
    const [normal_x, normal_y, normal_z] = probe.normal;
    return {
        kind: "probe",
        name: probe.name,
        x_m,
        y_m,
        z_m,
        normal_x,
        normal_y,
        normal_z,
        illuminance_lx: probe.illuminance,
        illuminance_95_lx: probe.illuminance_95,
        luminance_cd_m2: probe.luminance,
        luminance_95_cd_m2: probe.luminance_95,
        material: probe.material,
        surface: probe.surface,
        settled: probe.settled,
        time: probe.time,
    };
}

function area_row(area) {
    const [left, bottom, right, top] = area.rect;
    const [x_m, y_m, z_m] = area.view.position;
    return {
        kind: "mean",
        name: area.name,
        x_m,
        y_m,
        z_m,
        luminance_cd_m2: area.luminance,
        luminance_95_cd_m2: area.luminance_95,
        left,
        bottom,
        right,
        top,
        pixels: area.pixels,
        settled: area.settled,
        time: area.time,
        // With "VIEW= " before it the cell does not begin with a minus, which a spreadsheet takes for a formula.
        view: `VIEW= ${view_options(area.view)}`,
    };
}

/** A table (CSV): its columns' names, and the rows, objects of these names. */
export function table_text(columns, rows) {
    const lines = rows.map((row) => columns.map((name) => cell(row[name])).join(","));
    return [columns.join(","), ...lines].join("\r\n") + "\r\n";
}

/**
 * The table of all pins and means.
 * @param settings  {scene, ambient}: repeated in every row
 * Numbers with 95 in their names: how far the 95 % interval of the value before reaches to both sides.
 * The position of a mean is that of the eye; its corners are shares of the picture.
 */
export function measurement_table(probes, areas, settings) {
    const rows = [...probes.map(probe_row), ...areas.map(area_row)];
    return table_text(
        kColumns,
        rows.map((row) => ({ ...row, ...settings })),
    );
}
