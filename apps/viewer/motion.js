// How the eye moves: pure functions from one view to the next.
import { add, cross, dot, mix, normalize, subtract, times, turned } from "./vector.js";
import { axes_of } from "./view.js";

/** What a held key asks for: [right, forward, up, turn right, look up], each -1, 0 or 1. */
export const kKeys = {
    KeyW: [0, 1, 0, 0, 0],
    ArrowUp: [0, 1, 0, 0, 0],
    KeyS: [0, -1, 0, 0, 0],
    ArrowDown: [0, -1, 0, 0, 0],
    KeyA: [-1, 0, 0, 0, 0],
    KeyD: [1, 0, 0, 0, 0],
    KeyE: [0, 0, 1, 0, 0],
    KeyQ: [0, 0, -1, 0, 0],
    ArrowLeft: [0, 0, 0, -1, 0],
    ArrowRight: [0, 0, 0, 1, 0],
    PageUp: [0, 0, 0, 0, 1],
    PageDown: [0, 0, 0, 0, -1],
};

export const kSettle = 0.05; // time constant of starting and stopping [s]
export const kTurnRate = 1.2; // how fast keys turn the eye [rad/s]
const kSteepest = (89 * Math.PI) / 180; // how far the eye looks up and down [rad]
const kStill = 1e-3; // share of full speed below which the eye counts as standing

/** The sum of what the held keys ask for: opposite keys cancel, and two keys for one direction count once. */
export function wish_of(keys) {
    const wish = [0, 0, 0, 0, 0];
    for (const code of keys) (kKeys[code] || []).forEach((x, k) => (wish[k] += x));
    return wish.map((x) => Math.max(-1, Math.min(1, x)));
}

/** The rates of motion after dt seconds: they approach the wish exponentially, and become exactly 0 where it is 0. */
export function next_rates(rates, wish, dt) {
    const share = 1 - Math.exp(-dt / kSettle);
    return rates.map((rate, k) => {
        const next = rate + (wish[k] - rate) * share;
        return wish[k] === 0 && Math.abs(next) < kStill * 20 ? 0 : next;
    });
}

/** The view after the eye has turned by `yaw` to the right and `pitch` up [rad], never past the zenith. */
export function looked(view, yaw, pitch) {
    const up = normalize(view.up);
    const level = turned(normalize(view.direction), up, -yaw);
    const elevation = Math.asin(Math.max(-1, Math.min(1, dot(level, up))));
    const wanted = Math.max(-kSteepest, Math.min(kSteepest, elevation + pitch));
    const right = normalize(cross(level, up));
    return { ...view, direction: turned(level, right, wanted - elevation) };
}

/**
 * The view after the eye has moved [m] to the right, forward and up. When walking, forward is horizontal, so that
 * looking down does not lead into the floor; when flying it is where the eye looks.
 */
export function moved(view, [right, forward, up], walk) {
    const axes = axes_of(view);
    const zenith = normalize(view.up);
    const ahead = walk ? normalize(cross(zenith, axes.right)) : axes.forward;
    const step = add(add(times(axes.right, right), times(ahead, forward)), times(zenith, up));
    return { ...view, position: add(view.position, step) };
}

/** The view after dt seconds of motion at these rates; `speed` in m/s. */
export function advanced(view, rates, dt, speed, walk) {
    const [right, forward, up, yaw, pitch] = rates;
    const turning = yaw !== 0 || pitch !== 0;
    const looking = turning ? looked(view, yaw * kTurnRate * dt, pitch * kTurnRate * dt) : view;
    return moved(
        looking,
        [right, forward, up].map((rate) => rate * speed * dt),
        walk,
    );
}

/** The view with its eye moved to the height of `eye`, as the server finds it when somebody walks over steps. */
export function at_height(view, eye) {
    const up = normalize(view.up);
    const rise = dot(subtract(eye, view.position), up);
    return { ...view, position: add(view.position, times(up, rise)) };
}

/** The view with a narrower (factor < 1) or wider lens, within the limits of its type. */
export function zoomed(view, factor) {
    const [least, most] =
        view.type === "l" ? [1e-3, 1e6] : view.type === "v" ? [4, 130] : [10, 180];
    return { ...view, horizontal: Math.max(least, Math.min(most, view.horizontal * factor)) };
}

/** Interpolates directions along the shortest arc; `share` 0..1. */
function swung(from, to, share) {
    const a = normalize(from),
        b = normalize(to);
    const angle = Math.acos(Math.max(-1, Math.min(1, dot(a, b))));
    if (angle < 1e-6) return b;
    let axis = cross(a, b);
    // Between opposite directions every arc is a shortest one.
    if (dot(axis, axis) < 1e-12) axis = cross(a, Math.abs(a[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]);
    return turned(a, normalize(axis), angle * share);
}

/** Interpolates directions as a person turns: about the vertical axis and up or down, never over the zenith. */
function turned_between(from, to, up, share) {
    const a = normalize(from),
        b = normalize(to),
        zenith = normalize(up);
    const level = (v) => subtract(v, times(zenith, dot(v, zenith)));
    const elevation = (v) => Math.asin(Math.max(-1, Math.min(1, dot(v, zenith))));
    const start = level(a),
        end = level(b);
    const yaw = Math.atan2(dot(zenith, cross(start, end)), dot(start, end));
    const ahead = normalize(turned(dot(start, start) > 1e-12 ? start : end, zenith, yaw * share));
    const rise = elevation(a) + (elevation(b) - elevation(a)) * share;
    return add(times(ahead, Math.cos(rise)), times(zenith, Math.sin(rise)));
}

/** The view of a smooth transition between two views of one type; share 0..1 of the time, slow at both ends. */
export function between(from, to, share) {
    if (share >= 1 || from.type !== to.type) return to;
    const s = share * share * (3 - 2 * share);
    const up = swung(from.up, to.up, s);
    return {
        ...to,
        position: mix(from.position, to.position, s),
        direction: turned_between(from.direction, to.direction, up, s),
        up,
        horizontal: from.horizontal + (to.horizontal - from.horizontal) * s,
    };
}
