// Illuminances on planes of the room that a fake server draws, as the real server tells them.
import { read_grid, statistics } from "../../../apps/viewer/isolux.js";
import { kBall, kRoom, kTable } from "./fake_scene.mjs";

const kFine = 32; // points along a side, divisible by four
const kLamp = [-1, 0, 2.8],
    kIntensity = 1500; // [cd]

const inside = ({ low, high }, [x, y]) => x > low[0] && x < high[0] && y > low[1] && y < high[1];

/** What counts of a level plane: not what stands as high. */
function counts([x, y, z]) {
    const ball = Math.hypot(x - kBall.centre[0], y - kBall.centre[1], z - kBall.centre[2]);
    return ball > kBall.radius && !(z < kTable.high[2] - 1e-9 && inside(kTable, [x, y]));
}

/** The illuminance by a lamp below the ceiling [lx]. */
export function lamp_illuminance(place, normal) {
    const to = kLamp.map((x, k) => x - place[k]);
    const far = Math.hypot(...to);
    const cosine = to.reduce((sum, x, k) => sum + (x * normal[k]) / far, 0);
    return (kIntensity * Math.max(0, cosine)) / (far * far);
}

function grid_message(id, done, z, columns, brightness) {
    const size = [0, 1].map((k) => kRoom.high[k] - kRoom.low[k]);
    const across = [size[0] / columns, 0, 0],
        along = [0, size[1] / columns, 0];
    const origin = [kRoom.low[0] + across[0] / 2, kRoom.low[1] + along[1] / 2, z];
    const values = Buffer.alloc(4 * columns * columns);
    for (let k = 0; k < columns * columns; ++k) {
        const place = [
            origin[0] + (k % columns) * across[0],
            origin[1] + Math.floor(k / columns) * along[1],
            z,
        ];
        const value = counts(place) ? brightness * lamp_illuminance(place, [0, 0, 1]) : NaN;
        values.writeFloatLE(value, 4 * k);
    }
    const normal = [0, 0, 1];
    const grid = { columns, rows: columns, origin, across, along, normal };
    const message = { type: "isolux", id, done, ...grid, values: values.toString("base64") };
    if (done < 1) return message;
    const { mean, min: least, max: most } = statistics(read_grid(message));
    const half = { mean_95: 0.011 * mean, least_95: 0.034 * least, most_95: 0.002 * most };
    return { ...message, mean, least, most, ...half };
}

/** The answers to an `isolux` request, one after the other: level planes of the whole room; of other surfaces there are none. */
export function isolux_messages({ id, position, normal, height }, brightness) {
    const none = { type: "isolux", id, columns: 0, rows: 0 };
    if (normal && normal[2] < 0.99) return [{ ...none, done: 1 }];
    const z = height ?? position[2];
    return [
        { ...none, done: 0.01 },
        grid_message(id, 0.05, z, kFine / 4, brightness),
        grid_message(id, 1, z, kFine, brightness),
    ];
}
