// Lines of equal value on a grid of numbers: marching squares (Lorensen & Cline, "Marching cubes", 1987, in the plane).

// The corners of a cell, and its edges, each from a corner to the next: [column, row] from the cell's first corner.
const kCorners = [
    [0, 0],
    [1, 0],
    [1, 1],
    [0, 1],
];

/**
 * The pairs of edges that a line connects within a cell, [from, to]: on its left is what is above the level.
 * @param above  for each corner
 * @param middle  whether the cell's middle is above, which tells how a saddle is divided
 */
function connections(above, middle) {
    const leaves = [],
        enters = [];
    above.forEach((here, k) => {
        const next = above[(k + 1) % 4];
        if (here && !next) leaves.push(k);
        if (!here && next) enters.push(k);
    });
    if (leaves.length < 2) return leaves.map((from) => [from, enters[0]]);
    return leaves.map((from) => [from, (from + (middle ? 1 : 3)) % 4]);
}

/** Chain links {from: to} into lines of what they link; those that are closed end where they begin. */
function chained(links) {
    const lines = [];
    const ends = new Set(links.values());
    const follow = (start) => {
        const line = [start];
        for (let at = start; links.has(at);) {
            const next = links.get(at);
            links.delete(at);
            line.push(next);
            at = next;
        }
        lines.push(line);
    };
    for (const start of [...links.keys()]) if (!ends.has(start)) follow(start);
    for (const start of [...links.keys()]) if (links.has(start)) follow(start);
    return lines;
}

/**
 * The lines on which values that are interpolated between the points of a grid have one level.
 * @param values  columns x rows numbers, by rows; not finite: there is none, and no line in the cells around the point
 * @returns lines of points [column, row], on the edges of cells; what is above the level lies to their left, where rows rise to the
 *     left of columns. A value that is the level counts as above it. Closed lines end where they begin.
 */
export function contour_lines(values, columns, rows, level) {
    const value = (x, y) => values[y * columns + x];
    const links = new Map();
    const places = new Map(); // of edges, by their numbers
    const edge = (x, y, k) => {
        const ends = [kCorners[k], kCorners[(k + 1) % 4]].map(([a, b]) => [x + a, y + b]);
        // From the same end for both cells at the edge, so that both find the same place.
        const [p, q] = ends[0][0] + ends[0][1] < ends[1][0] + ends[1][1] ? ends : ends.reverse();
        const key = 2 * (p[1] * columns + p[0]) + (k % 2);
        if (!places.has(key)) {
            const share = (level - value(...p)) / (value(...q) - value(...p));
            places.set(
                key,
                p.map((from, i) => from + share * (q[i] - from)),
            );
        }
        return key;
    };
    for (let y = 0; y + 1 < rows; ++y)
        for (let x = 0; x + 1 < columns; ++x) {
            const corners = kCorners.map(([a, b]) => value(x + a, y + b));
            if (!corners.every(Number.isFinite)) continue;
            const middle = corners.reduce((sum, v) => sum + v / 4, 0) >= level;
            const above = corners.map((v) => v >= level);
            for (const [from, to] of connections(above, middle))
                links.set(edge(x, y, from), edge(x, y, to));
        }
    return chained(links).map((line) => line.map((key) => places.get(key)));
}
