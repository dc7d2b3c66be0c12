// Where the eye goes when somebody points at a surface: onto a floor, or near a wall.
import { add, dot, length, normalize, subtract, times } from "./vector.js";

const kLevel = 0.7; // cosine to the zenith of surfaces that one stands on
const kNear = 1.1; // how near to a wall one goes [eye heights]
const kNearest = 0.3; // where one was nearer already, or a wall is seen at a flat angle [eye heights]

/**
 * The view from a place near the point that a `picked` message tells of.
 * @param view        the present view
 * @param pick        {hit, position, normal}
 * @param eye_height  of people above their floor [m]
 * @returns null when nothing was hit. On a floor the eye keeps its direction, and its height where it is about that of
 *     somebody who stands there (a table is no floor); else it looks at the point.
 */
export function view_at_pick(view, { hit, position, normal }, eye_height) {
    if (!hit || !position || !normal) return null;
    const up = normalize(view.up);
    const to_eye = subtract(view.position, position);
    const outward = normalize(dot(normal, to_eye) < 0 ? times(normal, -1) : normal);
    return dot(outward, up) > kLevel
        ? { ...view, position: add(position, times(up, height_above(dot(to_eye, up), eye_height))) }
        : near_wall(view, position, outward, eye_height);
}

const height_above = (present, usual) =>
    present > 0.4 * usual && present < 1.5 * usual ? present : usual;

function near_wall(view, point, outward, eye_height) {
    const up = normalize(view.up);
    const level = (v) => subtract(v, times(up, dot(v, up)));
    const to_eye = subtract(view.position, point);
    const facing = length(level(outward)) > 0.3;
    const away = normalize(level(facing ? outward : to_eye));
    const now = facing ? dot(to_eye, away) : length(level(to_eye));
    const apart = Math.min(kNear * eye_height, Math.max(kNearest * eye_height, now));
    const place = add(add(point, times(away, apart)), times(up, dot(to_eye, up)));
    const direction = normalize(subtract(point, place));
    const steep = Math.abs(dot(direction, up)) > 0.99;
    return { ...view, position: place, direction: steep ? view.direction : direction };
}

/** The view that looks level, in the same direction; one that looks straight up or down stays. */
export function levelled(view) {
    const up = normalize(view.up);
    const ahead = subtract(view.direction, times(up, dot(view.direction, up)));
    return length(ahead) < 1e-6 * length(view.direction)
        ? view
        : { ...view, direction: normalize(ahead) };
}
