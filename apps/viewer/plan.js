// The floor plan: where its cells are in the scene, what they show, and where a click on them leads.
// What the cells mean is said in io/net/README.md.
import { dot, normalize } from "./vector.js";
import { quantity } from "./words.js";

export const kEdge = 253,
    kPane = 254,
    kWall = 255;
const kDeepest = 250;
const kDepthUnit = 0.01; // of the cells' depths [eye heights]
const kStorey = 0.5; // farther above or below the section the plan is another one [eye heights]
const kOtherPlace = 0.5; // how far the eye goes before a plan that does not show it is asked for again [eye heights]
const kStanding = 1.5; // what is farther below the eye is the floor of a lower storey [eye heights]

/** The bytes that a text holds: in base64, a zlib stream. */
export async function inflate(text) {
    const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The plan of a `plan` message: {width, height, origin, cell, z, cells}; throws where its cells are not as many. */
export async function read_plan({ width, height, origin, cell, z, cells: text }) {
    const cells = await inflate(text);
    if (cells.length !== width * height) throw new Error("a plan with missing cells");
    return { width, height, origin, cell, z, cells };
}

/** Where a place of the scene is on a plan, in cells from its left and its top. */
export const plan_place = ({ height, origin, cell }, [x, y]) => [
    (x - origin[0]) / cell,
    height - (y - origin[1]) / cell,
];

/** The place [x, y] of the scene that is `column` and `row` cells from the left and the top of a plan. */
export const scene_place = ({ height, origin, cell }, [column, row]) => [
    origin[0] + column * cell,
    origin[1] + (height - row) * cell,
];

/** What a plan shows at a place, in cells; 0 beside it. */
export function cell_at({ width, height, cells }, [column, row]) {
    const x = Math.floor(column),
        y = Math.floor(row);
    return x >= 0 && y >= 0 && x < width && y < height ? cells[y * width + x] : 0;
}

/** Whether a plan shows where an eye is: it is over the plan's cells, and on its storey. */
export function shows(plan, [x, y, z], eye_height) {
    const [column, row] = plan_place(plan, [x, y]);
    const level = Math.abs(z - plan.z) <= kStorey * eye_height;
    return level && column >= 0 && row >= 0 && column <= plan.width && row <= plan.height;
}

/** Whether an eye is so far from where it was that a plan may be another one. */
export const is_elsewhere = (eye, before, eye_height) =>
    Math.hypot(...eye.map((x, k) => x - before[k])) > kOtherPlace * eye_height;

/**
 * Where one goes to a place of a plan, in cells: {position}, or {problem}: why one cannot.
 * @param eye   where it is now
 * @param walk  the eye stands on what is below it; else it keeps its height
 */
export function place_to_go(plan, at, eye, eye_height, walk) {
    const value = cell_at(plan, at);
    if (value === 0) return { problem: "Nothing to stand on there" };
    if (value === kWall) return { problem: "A wall is there" };
    if (value === kPane) return { problem: "A pane is there" };
    const [x, y] = scene_place(plan, at);
    if (!walk || value >= kDeepest) return { position: [x, y, eye[2]] };
    const ground = plan.z - value * kDepthUnit * eye_height;
    // On this storey the server keeps the height above the floor, and no table counts as one.
    const level = eye[2] - ground < kStanding * eye_height;
    return { position: [x, y, level ? eye[2] : ground + eye_height] };
}

/** The direction in which a view looks, seen from above: unit [x, y]; where it looks straight down, up the picture. */
export function heading_of({ direction, up }) {
    const level = Math.hypot(direction[0], direction[1]);
    const [x, y] = level > 1e-6 ? direction : dot(direction, [0, 0, 1]) < 0 ? up : [0, 1];
    const [h, v] = normalize([x, y, 0]);
    return h || v ? [h, v] : [0, 1];
}

const kWinds = "north north-east east south-east south south-west west north-west".split(" ");

/** The point of the compass toward [x, y], y being north. */
export const wind = ([x, y]) => kWinds[(Math.round(Math.atan2(x, y) / (Math.PI / 4)) + 8) % 8];

/** Where a view is on a plan, in words. */
export function place_words(plan, view) {
    const [column, row] = plan_place(plan, view.position);
    const from = (cells) => `${quantity(Math.max(0, cells * plan.cell))} m`;
    return (
        `The eye is ${from(column)} from the left and ${from(plan.height - row)} from the lower side, ` +
        `facing ${wind(heading_of(view))}.`
    );
}

/** Where a place of a plan, in cells, lies from an eye, in words. */
export function way_words(plan, at, eye) {
    const [x, y] = scene_place(plan, at);
    const way = [x - eye[0], y - eye[1]];
    const far = Math.hypot(...way);
    if (far < plan.cell) return "where you are";
    const what = { [kWall]: ": a wall", [kPane]: ": a pane", 0: ": nothing to stand on" };
    return `${quantity(far)} m ${wind(way)}${what[cell_at(plan, at)] ?? ""}`;
}

/** The longest round length that takes at most a share of a plan's width [m]. */
export function scale_length(plan, share) {
    const most = plan.width * plan.cell * share;
    const unit = 10 ** Math.floor(Math.log10(most));
    return unit * [5, 2, 1].find((factor) => factor * unit <= most * (1 + 1e-9));
}

// Inks, as red, green, blue: what is on the level of the floor is paper.
const kInks = {
    quiet: {
        wall: [14, 16, 18],
        pane: [58, 128, 172],
        edge: [116, 111, 103],
        paper: [214, 210, 201],
    },
    strong: { wall: [0, 0, 0], pane: [0, 84, 150], edge: [70, 70, 70], paper: [255, 255, 255] },
};

/** Of the paper's brightness: darker what is higher than the floor, and what is a storey below. */
function tone(value) {
    const depth = value * kDepthUnit; // [eye heights]
    return depth < 1 ? 1 - 0.24 * (1 - depth) : 1 - 0.14 * Math.min(1, Math.max(0, depth - 1.1));
}

/** RGBA bytes of a plan; `strong`: with more contrast. What is empty is transparent. */
export function plan_pixels({ width, height, cells }, strong) {
    const ink = kInks[strong ? "strong" : "quiet"];
    const colours = new Uint32Array(256); // little-endian, as canvases are on all that browsers run on
    for (let value = 1; value < 256; ++value) {
        const inked = { [kWall]: ink.wall, [kPane]: ink.pane, [kEdge]: ink.edge }[value];
        const [r, g, b] = inked ?? ink.paper.map((x) => Math.round(x * tone(value)));
        colours[value] = ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
    }
    return new Uint8ClampedArray(
        Uint32Array.from(cells.subarray(0, width * height), (value) => colours[value]).buffer,
    );
}
