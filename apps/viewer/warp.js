// Where what a frame shows is on the screen of another view: the mathematics of drawing the camera between frames.
import { cross, dot, normalize, subtract } from "./vector.js";
import { axes_of, same_place } from "./view.js";

const half_tangent = (degrees) => Math.tan((degrees * Math.PI) / 360);

/** Whether frames of this view can be drawn from elsewhere: perspective ones whose rays begin at the eye. */
export const can_warp = (view) => view?.type === "v" && !view.fore && !view.aft;

/** A perspective view's axes, and half its picture's size at unit distance. */
function lens_of(view) {
    return {
        ...axes_of(view),
        across: half_tangent(view.horizontal),
        along: half_tangent(view.vertical),
        shift: view.shift || 0,
        lift: view.lift || 0,
    };
}

/** The direction, of depth 1, in which a place x, y of the picture lies (0..1 from the left and the top). */
function ray_of({ forward, right, upward, across, along, shift, lift }, x, y) {
    const a = 2 * across * (x - 0.5 + shift),
        b = 2 * along * (0.5 - y + lift);
    return forward.map((f, k) => f + a * right[k] + b * upward[k]);
}

/** Clip coordinates x, y and w (without z) of a direction. */
function clip_of({ forward, right, upward, across, along, shift, lift }, d) {
    const w = dot(d, forward);
    return [dot(d, right) / across - 2 * shift * w, dot(d, upward) / along - 2 * lift * w, w];
}

/**
 * How pixels of the frame of view `from`, width x height pixels, appear in view `to`: a pixel at x, y (from the upper left)
 * of inverse depth q has the clip coordinates [x, y, w] = turn [x, y, 1] + q shift.
 * @returns {{turn, shift}}: turn: 9 numbers, column by column; shift: 3
 */
export function warp_of(from, width, height, to) {
    const source = lens_of(from),
        target = lens_of(to);
    const at = (x, y) => clip_of(target, ray_of(source, x / width, y / height));
    const origin = at(0, 0),
        right = subtract(at(1, 0), origin),
        down = subtract(at(0, 1), origin);
    return {
        turn: [...right, ...down, ...origin],
        shift: clip_of(target, subtract(from.position, to.position)),
    };
}

/** A perspective view whose picture is `factor` times as large at both sides. */
export function widened(view, factor) {
    const size = (degrees) => (Math.atan(half_tangent(degrees) * factor) * 360) / Math.PI;
    return { ...view, horizontal: size(view.horizontal), vertical: size(view.vertical) };
}

/** How far the eye turns from one view to another [rad]. */
export function turn_between(a, b) {
    const p = normalize(a.direction),
        q = normalize(b.direction);
    return Math.atan2(Math.hypot(...cross(p, q)), dot(p, q));
}

const kMargin = 0.04, // of a picture while the eye moves, at each side
    kWidest = 1.3; // a wider picture has too few pixels for what is looked at

/**
 * How much wider than the window a view is asked for, so that what comes into sight is there.
 * @param turn  how far the eye turns while the frame is shown, at most [rad]
 */
export function margin_for(view, turn) {
    const half = Math.atan(half_tangent(view.horizontal));
    const reached = Math.tan(Math.min(half + turn, 1.5)) / Math.tan(half);
    return Math.min(kWidest, Math.max(1 + kMargin, reached));
}

/** Whether a frame of view `frame` is what a screen of view `view` shows, pixel for pixel. */
export const is_picture_of = (frame, view) =>
    same_place(frame, view) &&
    (frame.shift || 0) === (view.shift || 0) &&
    (frame.lift || 0) === (view.lift || 0) &&
    Math.abs(frame.horizontal - view.horizontal) < 1e-9 * view.horizontal &&
    Math.abs(frame.vertical - view.vertical) < 1e-9 * view.vertical;
