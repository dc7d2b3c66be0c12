// Lines of the scene on the screen: what is seen of them, and where their labels stand.
import { dot, subtract } from "./vector.js";
import { axes_of, locator } from "./view.js";

const kNear = 0.02; // of its distance: what is less far ahead is beside the eye
const kJump = 0.4; // of the picture: lines of panoramas that leave it at one side, and come back at the other
const kLabelled = 70; // least length of a stroke with a label [CSS pixels]
const kLabel = [64, 18]; // size of a label, with some room [CSS pixels]

const apart = ([a, b], [c, d]) => Math.hypot(a - c, b - d);

/**
 * What is seen of a line, as strokes of points on the screen [CSS pixels].
 * @param line    places in the scene
 * @param hidden  a function that tells whether something is in front of a place
 */
export function strokes_of(view, line, [width, height], hidden) {
    const { forward } = axes_of(view);
    const locate = locator(view);
    const strokes = [];
    let stroke = [];
    const end = () => {
        const inside = ([x, y]) => x > 0 && x < width && y > 0 && y < height;
        if (stroke.length > 1 && stroke.some(inside)) strokes.push(stroke);
        stroke = [];
    };
    for (const place of line) {
        const at = locate(place);
        const ahead = dot(subtract(place, view.position), forward);
        const seen = view.type === "v" ? ahead > kNear * at.distance : at.visible;
        if (!seen || hidden(place)) {
            end();
            continue;
        }
        const point = [at.x * width, (1 - at.y) * height];
        const last = stroke.at(-1);
        if (last && view.type !== "v" && apart(last, point) > kJump * width) end();
        stroke.push(point);
    }
    end();
    return strokes;
}

/** Strokes as the data of an SVG path. */
export const path_of = (strokes) =>
    strokes
        .map((stroke) => `M${stroke.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L")}`)
        .join("");

/** The points of a list from its middle outward. */
function from_middle(points) {
    const middle = points.length >> 1;
    return points
        .map((point, k) => [Math.abs(k - middle), point])
        .sort(([a], [b]) => a - b)
        .map(([, point]) => point);
}

/**
 * Where a label stands on strokes: near the middle of one that is long enough, the longest if possible, and apart from
 * other labels; nothing where there is no such place.
 * @param taken  the places of other labels
 */
export function label_place(strokes, [width, height], taken) {
    const far = ([x, y]) =>
        taken.every(([u, v]) => Math.abs(x - u) > kLabel[0] || Math.abs(y - v) > kLabel[1]);
    const lines = [];
    for (const stroke of strokes) {
        const inside = stroke.filter(([x, y]) => x > 0 && x < width && y > 0 && y < height);
        let size = 0;
        for (let k = 1; k < inside.length; ++k) size += apart(inside[k - 1], inside[k]);
        if (size > kLabelled) lines.push({ size, inside });
    }
    lines.sort((a, b) => b.size - a.size);
    for (const { inside } of lines) {
        const place = from_middle(inside).find(far);
        if (place) return place;
    }
    return null;
}
