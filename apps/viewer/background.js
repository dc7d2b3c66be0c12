// What lies behind a frame's surfaces where the frame does not show it: a coarse sheet that continues what is farther.
import { kNumbers } from "./depth.js";

const kCell = 16; // [pixels]
const kNearer = 1.15; // ratio of inverse depths from which on a cell hides its neighbour
const kReach = 8; // how far what is farther continues behind what is nearer [cells]

/** The farthest pixel of each cell: its inverse depth [steps] and its place. */
function farthest_pixels({ patches, count }, columns, rows) {
    const size = columns * rows;
    const depth = new Float32Array(size).fill(Infinity);
    const x = new Float32Array(size),
        y = new Float32Array(size);
    for (let k = 0, at = 0; k < count; ++k, at += kNumbers) {
        const side = 1 << (patches[at + 2] & 7),
            value = patches[at + 3];
        const middle_x = patches[at] + side / 2,
            middle_y = patches[at + 1] + side / 2;
        for (let v = patches[at + 1]; v < patches[at + 1] + side; v += kCell)
            for (let u = patches[at]; u < patches[at] + side; u += kCell) {
                const cell = Math.floor(v / kCell) * columns + Math.floor(u / kCell);
                if (value >= depth[cell]) continue;
                depth[cell] = value;
                x[cell] = side > kCell ? u + kCell / 2 : middle_x;
                y[cell] = side > kCell ? v + kCell / 2 : middle_y;
            }
    }
    return { depth, x, y };
}

/** Let cells before others take over what is behind them: at first where they meet, then ever deeper. */
function continue_behind({ depth, x, y }, columns, rows) {
    const own = depth.slice(),
        last_row = columns * (rows - 1);
    const taken = new Uint8Array(depth.length);
    for (let round = 0; round < kReach; ++round) {
        const found = [];
        for (let cell = 0; cell < depth.length; ++cell) {
            if (taken[cell]) continue;
            const column = cell % columns;
            let best = cell;
            if (column > 0 && depth[cell - 1] < depth[best]) best = cell - 1;
            if (column < columns - 1 && depth[cell + 1] < depth[best]) best = cell + 1;
            if (cell >= columns && depth[cell - columns] < depth[best]) best = cell - columns;
            if (cell < last_row && depth[cell + columns] < depth[best]) best = cell + columns;
            if (best !== cell && own[cell] > kNearer * depth[best] + 1)
                found.push(cell, depth[best], x[best], y[best]);
        }
        for (let k = 0; k < found.length; k += 4) {
            const cell = found[k];
            depth[cell] = found[k + 1];
            x[cell] = found[k + 2];
            y[cell] = found[k + 3];
            taken[cell] = 1;
        }
        if (found.length === 0) return;
    }
}

/**
 * The sheet behind the frame of width x height pixels: a grid of `columns` x `rows` places.
 * @returns {{columns, rows, places}}: places: 5 numbers each: x, y where it is in the picture, far outside at the grid's border;
 *     its inverse depth [steps]; x, y of the pixel whose colour it has
 */
export function background_of(depth, width, height) {
    const columns = Math.ceil(width / kCell),
        rows = Math.ceil(height / kCell);
    const cells = farthest_pixels(depth, columns, rows);
    continue_behind(cells, columns, rows);
    const places = new Float32Array(5 * columns * rows);
    const along = (k, cells_there, size) =>
        k === 0 ? -size : k === cells_there - 1 ? 2 * size : Math.min((k + 0.5) * kCell, size);
    for (let row = 0, cell = 0; row < rows; ++row)
        for (let column = 0; column < columns; ++column, ++cell)
            places.set(
                [
                    along(column, columns, width),
                    along(row, rows, height),
                    cells.depth[cell],
                    cells.x[cell],
                    cells.y[cell],
                ],
                5 * cell,
            );
    return { columns, rows, places };
}

/** Corners of the triangles of a grid. */
export function grid_triangles(columns, rows) {
    const corners = [];
    for (let row = 0; row + 1 < rows; ++row)
        for (let column = 0; column + 1 < columns; ++column) {
            const a = row * columns + column,
                b = a + columns;
            corners.push(a, a + 1, b, b, a + 1, b + 1);
        }
    return new Uint32Array(corners);
}
