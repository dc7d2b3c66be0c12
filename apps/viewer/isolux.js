// Illuminances on a plane: what the server's grid says, its contours, and what is saved of it.
import { contour_lines } from "./contours.js";
import { quoted } from "./path.js";
import { scale_ticks } from "./scale.js";
import { table_text } from "./table.js";
import { add, length, times } from "./vector.js";

const kMostLevels = 8;
const kWide = 8; // a maximum of so many minima gets levels in steps of 1, 2, 5

/**
 * The grid of an `isolux` message: {columns, rows, origin, across, along, normal, values}, the values [lx] by rows, NaN where a point
 * does not count; nothing where there is none yet. Throws Error where its values are not as many.
 */
export function read_grid({ columns, rows, origin, across, along, normal, values: text }) {
    if (!(columns > 0)) return null;
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    if (bytes.length !== 4 * columns * rows) throw new Error("a grid with missing values");
    const data = new DataView(bytes.buffer);
    const values = Float32Array.from({ length: columns * rows }, (_, k) =>
        data.getFloat32(4 * k, true),
    );
    return { columns, rows, origin, across, along, normal, values };
}

/** The place of a grid's column and row, which may lie between its points. */
export const place_on = ({ origin, across, along }, [column, row]) =>
    add(origin, add(times(across, column), times(along, row)));

/** Of what counts, [place, value] of each point. */
function counting(grid) {
    const points = [];
    grid.values.forEach((value, k) => {
        const at = [k % grid.columns, Math.floor(k / grid.columns)];
        if (Number.isFinite(value)) points.push([place_on(grid, at), value]);
    });
    return points;
}

/**
 * Mean, minimum and maximum illuminance over the points that count [lx], and what EN 12665 (the terms of EN 12464-1) calls illuminance
 * uniformity U_0 (minimum by mean) and diversity (minimum by maximum); nothing where no point counts. Ratios of darkness are NaN.
 */
export function statistics({ values }) {
    const counted = [...values].filter(Number.isFinite);
    if (counted.length === 0) return null;
    const mean = counted.reduce((sum, value) => sum + value, 0) / counted.length;
    const min = Math.min(...counted),
        max = Math.max(...counted);
    return { count: counted.length, mean, min, max, uniformity: min / mean, diversity: min / max };
}

/**
 * The same figures as far as an `isolux` message tells them, which it does when it is final: with `half`, how far the 95 % interval of each
 * reaches to both sides. A ratio's is that of numbers that are independent of each other.
 */
export function told_figures(grid, message) {
    const figures = statistics(grid);
    if (!figures || !Number.isFinite(message.mean)) return figures;
    const { mean, least: min, most: max } = message;
    const shares = [message.mean_95 / mean, message.least_95 / min, message.most_95 / max];
    const ratio = (a, b, share_a, share_b) => [a / b, (a / b) * Math.hypot(share_a, share_b)];
    const [uniformity, uniformity_95] = ratio(min, mean, shares[1], shares[0]);
    const [diversity, diversity_95] = ratio(min, max, shares[1], shares[2]);
    const half = {
        mean: message.mean_95,
        min: message.least_95,
        max: message.most_95,
        uniformity: uniformity_95,
        diversity: diversity_95,
    };
    return { count: figures.count, mean, min, max, uniformity, diversity, half };
}

/** Round illuminances between the least and the largest one, in steps of 1, 2 or 5 times a power of ten [lx]. */
export function levels_of({ min, max }) {
    if (!(max > min)) return [];
    const low = min > 0 ? min : max / 1000;
    const log = max > kWide * low;
    return scale_ticks({ low, high: max, log }, kMostLevels).filter((x) => x > min && x < max);
}

/** The contours of a grid: [{level [lx], share: 0..1 of the levels, lines: [[place, ...], ...]}]. */
export function contours_of(grid) {
    const figures = statistics(grid);
    const levels = figures ? levels_of(figures) : [];
    return levels.map((level, k) => ({
        level,
        share: (k + 0.5) / levels.length,
        lines: contour_lines(grid.values, grid.columns, grid.rows, level).map((line) =>
            line.map((at) => place_on(grid, at)),
        ),
    }));
}

/** The distance between neighbouring points, the larger of both [m]. */
export const spacing_of = ({ across, along }) => Math.max(length(across), length(along));

const micrometres = (place) => place.map((x) => Number(x.toFixed(6)));

/**
 * The table of a grid's points (CSV).
 * @param settings  {settled, scene, time}: repeated in every row
 */
export function grid_table(grid, settings) {
    const rows = counting(grid).map(([place, value]) => {
        const [x_m, y_m, z_m] = micrometres(place);
        return { x_m, y_m, z_m, illuminance_lx: Number(value.toPrecision(6)), ...settings };
    });
    return table_text(["x_m", "y_m", "z_m", "illuminance_lx", ...Object.keys(settings)], rows);
}

/** The grid's points as `rtrace -I` and `lightwalk trace -I` read them: x y z dx dy dz. */
export function sensor_points(grid) {
    const facing = micrometres(grid.normal).join(" ");
    return counting(grid)
        .map(([place]) => `${micrometres(place).join(" ")} ${facing}\n`)
        .join("");
}

/** The command that makes illuminances of a file of sensor points [lx]. */
export function trace_command(file, scene) {
    const [points, octree] = [file, scene || "SCENE"].map(quoted);
    return `lightwalk trace -h -I ${octree} < ${points} | rcalc -e '$1=179*(.265*$1+.670*$2+.065*$3)'`;
}
