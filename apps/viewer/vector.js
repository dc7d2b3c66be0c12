// Vectors of three numbers, as arrays.

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);

/** The unit vector along `a`; the zero vector stays what it is. */
export function normalize(a) {
    const l = length(a);
    return l > 0 ? times(a, 1 / l) : a;
}

export const mix = (a, b, share) => add(times(a, 1 - share), times(b, share));

/** `a` turned about the unit vector `axis`, counterclockwise seen from its tip [rad] (Rodrigues). */
export function turned(a, axis, angle) {
    const c = Math.cos(angle);
    return add(
        add(times(a, c), times(cross(axis, a), Math.sin(angle))),
        times(axis, dot(axis, a) * (1 - c)),
    );
}
