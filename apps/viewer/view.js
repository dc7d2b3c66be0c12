// Radiance's views: where a point appears in the picture, and the angles that fit a window.
// See the manual page rpict(1), "-vt".
import { cross, dot, length, normalize, subtract } from "./vector.js";

const kFarthest = 1e9; // largest number that the server accepts
const kLeast = 1e-6; // sizes and clipping distances below this are none

const radians = (degrees) => (degrees * Math.PI) / 180;
const degrees = (angle) => (angle * 180) / Math.PI;

/** Largest vertical size of a perspective view in a tall window [degrees]; larger ones look distorted. */
const kTallest = 80;

/** Largest sizes of each view type [degrees] that can be drawn. */
const kLargest = {
    v: [179, kTallest],
    l: [Infinity, Infinity],
    c: [360, 179],
    h: [180, 180],
    a: [360, 360],
    s: [359, 359],
};

/** The extent, at unit distance, of a picture with a horizontal or vertical size [degrees]; `straight`: the
 * direction along the axis of a cylindrical view. */
function extent_of(type, size, straight) {
    switch (type) {
        case "v":
            return 2 * Math.tan(radians(size) / 2);
        case "h":
            return 2 * Math.sin(radians(Math.min(size, 180)) / 2);
        case "s":
            return 2 * Math.tan(radians(size) / 4);
        case "c":
            return straight ? 2 * Math.tan(radians(size) / 2) : radians(size);
        case "a":
            return radians(size);
        default:
            return size;
    }
}

/** The inverse of extent_of(); sizes beyond what the type can show become its largest. */
function size_of(type, extent, straight) {
    switch (type) {
        case "v":
            return degrees(2 * Math.atan(extent / 2));
        case "h":
            return degrees(2 * Math.asin(Math.min(extent / 2, 1)));
        case "s":
            return degrees(4 * Math.atan(extent / 2));
        case "c":
            return straight ? degrees(2 * Math.atan(extent / 2)) : degrees(extent);
        case "a":
            return degrees(extent);
        default:
            return extent;
    }
}

/**
 * The view with sizes that fill a picture of width x height without distortion. The horizontal size is kept and
 * the vertical one computed; where that is larger than the type allows, the horizontal one is reduced.
 */
export function fit_view(view, width, height) {
    const [widest, tallest] = kLargest[view.type];
    const aspect = height / width;
    const horizontal = Math.min(view.horizontal, widest);
    const wanted = extent_of(view.type, horizontal, false) * aspect;
    const most = extent_of(view.type, tallest, true);
    if (wanted <= most) return { ...view, horizontal, vertical: size_of(view.type, wanted, true) };
    return { ...view, horizontal: size_of(view.type, most / aspect, false), vertical: tallest };
}

/** The view's axes as unit vectors: forward, right, and upward in the picture. */
export function axes_of(view) {
    const forward = normalize(view.direction);
    const right = normalize(cross(forward, normalize(view.up)));
    return { forward, right, upward: cross(right, forward) };
}

/** Project a direction onto the image surface of the view type, in units of distance 1. */
function on_image(type, right, upward, forward) {
    const distance = Math.hypot(right, upward, forward);
    switch (type) {
        case "l":
            return { x: right, y: upward, in_front: forward > 0 };
        case "c": {
            const radius = Math.hypot(right, forward);
            return { x: Math.atan2(right, forward), y: upward / radius, in_front: radius > 0 };
        }
        case "h":
            return { x: right / distance, y: upward / distance, in_front: forward > 0 };
        case "a": {
            const sine = Math.hypot(right, upward);
            const stretch = sine > 0 ? Math.atan2(sine, forward) / sine : 1 / distance;
            return { x: right * stretch, y: upward * stretch, in_front: distance > 0 };
        }
        case "s": {
            const across = distance + forward;
            return { x: right / across, y: upward / across, in_front: across > 0 };
        }
        default:
            return { x: right / forward, y: upward / forward, in_front: forward > 0 };
    }
}

/** A function that does what locate() does, for many points of one view. */
export function locator(view) {
    const { forward, right, upward } = axes_of(view);
    const across = extent_of(view.type, view.horizontal, false),
        along = extent_of(view.type, view.vertical, true);
    return (point) => {
        const d = subtract(point, view.position);
        const image = on_image(view.type, dot(d, right), dot(d, upward), dot(d, forward));
        const x = image.x / across + 0.5 - (view.shift || 0);
        const y = image.y / along + 0.5 - (view.lift || 0);
        const visible = image.in_front && x > 0 && x < 1 && y > 0 && y < 1;
        return { x, y, distance: length(d), visible };
    };
}

/**
 * Where a point appears: x, y in 0..1 from the left and the bottom of the picture, its distance
 * from the eye [m], and whether it lies within the picture (whether something hides it is not known here).
 */
export const locate = (view, point) => locator(view)(point);

/** How far a drag across the whole width of the picture turns the eye [rad]. */
export function angle_across(view) {
    return view.type === "l" ? 1 : radians(Math.min(view.horizontal, 120));
}

/** Whether two views have the same eye, direction and type; sizes may differ, as they follow the window. */
export function same_place(a, b) {
    const near = (p, q) => length(subtract(p, q)) < 1e-6 * (1 + length(p));
    return (
        a.type === b.type &&
        near(a.position, b.position) &&
        near(normalize(a.direction), normalize(b.direction)) &&
        near(normalize(a.up), normalize(b.up))
    );
}

/** Whether two views are the same, sizes included. */
export const same_picture = (a, b) =>
    same_place(a, b) &&
    Math.abs(a.horizontal - b.horizontal) < 1e-6 &&
    Math.abs(a.vertical - b.vertical) < 1e-6;

/**
 * Why a view cannot be drawn; "" where it can. Sizes that are too large for the type are no reason, as fit_view() limits
 * them.
 */
export function view_problem(view) {
    const {
        type,
        position,
        direction,
        up,
        horizontal,
        fore = 0,
        aft = 0,
        shift = 0,
        lift = 0,
    } = view;
    if (!(type in kLargest)) return `unknown view type '${type}'`;
    const numbers = [position, direction, up].flat().concat(horizontal, fore, aft, shift, lift);
    if (numbers.length !== 14 || !numbers.every((x) => Math.abs(x) <= kFarthest))
        return "a number is missing or larger than 1e9";
    if (fore < -kLeast || aft < -kLeast || (aft > kLeast && aft <= fore))
        return "illegal fore/aft clipping plane";
    if (length(direction) === 0) return "zero view direction";
    if (length(up) === 0) return "zero view up vector";
    if (length(cross(normalize(direction), normalize(up))) < 1e-12)
        return "view up parallel to view direction";
    return horizontal > kLeast ? "" : "illegal horizontal view size";
}
