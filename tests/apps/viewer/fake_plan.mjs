// The floor plan of the room that a fake server draws, as the real server tells it.
import { deflateSync } from "node:zlib";
import { kBall, kRoom, kTable, kWindows } from "./fake_scene.mjs";

const kCell = 0.05; // [m]
const kMargin = 1; // around the room [m]
const kEdge = 253,
    kPane = 254,
    kWall = 255;

const inside = ({ low, high }, x, y, by = 0) =>
    x > low[0] - by && x < high[0] + by && y > low[1] - by && y < high[1] + by;

/** What the plan shows at a place, for an eye 1.6 m above the floor. */
function value_at(x, y, eye_height) {
    if (!inside(kRoom, x, y)) return 0;
    if (!inside(kRoom, x, y, -kCell))
        return y > 2.9 && kWindows.some(([a, b]) => x > a && x < b) ? kPane : kWall;
    const depth = (top) => Math.round((99 * (1.6 - top)) / eye_height);
    if (inside(kTable, x, y)) return inside(kTable, x, y, -kCell) ? depth(kTable.high[2]) : kEdge;
    const from = Math.hypot(x - kBall.centre[0], y - kBall.centre[1]) / kBall.radius;
    return from < 1 ? (from > 0.93 ? kEdge : depth(1.4)) : depth(0);
}

/** The answer to a `plan` request of an eye that is at this height [m]. */
export function plan_message(id, z, eye_height) {
    const origin = [kRoom.low[0] - kMargin, kRoom.low[1] - kMargin];
    const size = [0, 1].map((k) =>
        Math.round((kRoom.high[k] - kRoom.low[k] + 2 * kMargin) / kCell),
    );
    const [width, height] = size;
    const cells = Buffer.alloc(width * height);
    for (let row = 0; row < height; ++row)
        for (let column = 0; column < width; ++column) {
            const x = origin[0] + (column + 0.5) * kCell,
                y = origin[1] + (height - row - 0.5) * kCell;
            cells[row * width + column] = value_at(x, y, eye_height);
        }
    return {
        type: "plan",
        id,
        width,
        height,
        origin,
        cell: kCell,
        z: z - 0.01 * eye_height,
        cells: deflateSync(cells).toString("base64"),
    };
}
