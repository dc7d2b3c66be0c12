// A small room that a fake server draws without a renderer: a window, a chequered floor, a ball, a
// wall of known luminance. Radiance in cd/m2, for pictures that change with the view as real ones do.
import { HighlightCurve } from "../../../apps/viewer/tone.js";

export const kRoom = { low: [-4, -3, 0], high: [4, 3, 3] };
export const kWindows = [
    [-3.2, -1.2],
    [-0.4, 1.6],
]; // x ranges in the wall y = 3
export const kBall = { centre: [1.6, 0.6, 0.7], radius: 0.7 };
export const kTable = { low: [-2.2, -0.6, 0], high: [-0.9, 0.9, 0.75] };
export const kKnownWall = { luminance: 120, material: "plaster", surface: "west_wall" }; // x = -4

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
];
const unit = ([x, y, z]) => {
    const length = Math.hypot(x, y, z);
    return [x / length, y / length, z / length];
};

/** Where a ray leaves (inside) or enters (outside) a box: {t, axis, sign}. */
function box_hit(origin, direction, { low, high }, inside) {
    let near = -Infinity,
        far = Infinity,
        near_axis = 0,
        far_axis = 0;
    for (let k = 0; k < 3; ++k) {
        const a = (low[k] - origin[k]) / direction[k],
            b = (high[k] - origin[k]) / direction[k];
        if (Math.min(a, b) > near) [near, near_axis] = [Math.min(a, b), k];
        if (Math.max(a, b) < far) [far, far_axis] = [Math.max(a, b), k];
    }
    if (near > far) return null;
    const t = inside ? far : near,
        axis = inside ? far_axis : near_axis;
    return t > 1e-6 ? { t, axis, sign: Math.sign(direction[axis]) } : null;
}

function ball_hit(origin, direction, { centre, radius }) {
    const to = sub(centre, origin),
        along = dot(to, direction);
    const rest = radius * radius - (dot(to, to) - along * along);
    const t = along - Math.sqrt(rest);
    return rest > 0 && t > 1e-6 ? t : null;
}

/** Light of the windows on a point, without shadows: enough for the eye to see depth. */
function daylight(position, normal) {
    let sum = 12;
    for (const [x0, x1] of kWindows) {
        const to = sub([(x0 + x1) / 2, 3, 1.6], position),
            r2 = dot(to, to);
        sum += (1500 * Math.max(0, dot(to, normal)) * Math.max(0.05, to[1])) / (r2 * r2 + 1);
    }
    return sum;
}

/** What a ray meets: {t, position, normal, luminance, colour, material, surface}. */
export function look(origin, direction) {
    const at = (t) => [
        origin[0] + t * direction[0],
        origin[1] + t * direction[1],
        origin[2] + t * direction[2],
    ];
    const wall = box_hit(origin, direction, kRoom, true);
    if (!wall) return null;
    let t = wall.t,
        colour = [1, 1, 1],
        luminance,
        material = "plaster",
        surface;
    let normal = [0, 0, 0];
    normal[wall.axis] = -wall.sign;
    let position = at(t);
    const side = `${"xyz"[wall.axis]}${wall.sign > 0 ? "+" : "-"}`;
    surface = {
        "x-": "west_wall",
        "x+": "east_wall",
        "y-": "south_wall",
        "y+": "north_wall",
        "z-": "floor",
        "z+": "ceiling",
    }[side];
    const pane =
        side === "y+" &&
        kWindows.some(([a, b]) => position[0] > a && position[0] < b) &&
        position[2] > 0.9 &&
        position[2] < 2.4;
    if (pane)
        [luminance, colour, material, surface] = [
            3500 + 1500 * (position[2] - 0.9),
            [0.82, 0.92, 1],
            "sky_pane",
            "window",
        ];
    else if (side === "x-") luminance = kKnownWall.luminance;
    else {
        luminance = daylight(position, normal) * 0.55;
        if (side === "z-") {
            const dark = (Math.floor(position[0] * 2) + Math.floor(position[1] * 2)) & 1;
            luminance *= dark ? 0.35 : 0.9;
            colour = [1, 0.82, 0.62];
            material = "oak";
        }
    }
    const table = box_hit(origin, direction, kTable, false);
    if (table && table.t < t) {
        t = table.t;
        position = at(t);
        normal = [0, 0, 0];
        normal[table.axis] = -table.sign;
        [luminance, colour, material, surface] = [
            daylight(position, normal) * 0.4,
            [0.75, 0.85, 1],
            "lacquer",
            "table",
        ];
    }
    const ball = ball_hit(origin, direction, kBall);
    if (ball !== null && ball < t) {
        t = ball;
        position = at(t);
        normal = unit(sub(position, kBall.centre));
        [luminance, colour, material, surface] = [
            daylight(position, normal) * 0.6,
            [1, 0.45, 0.3],
            "terracotta",
            "ball",
        ];
    }
    return { t, position, normal, luminance, colour, material, surface };
}

/** Of a perspective view: what gives the direction of a place x, y (0..1 from the lower left). */
export function directions_of(view) {
    const forward = unit(view.direction),
        right = unit(cross(forward, view.up)),
        up = cross(right, forward);
    const w = 2 * Math.tan((view.horizontal * Math.PI) / 360),
        h = 2 * Math.tan((view.vertical * Math.PI) / 360);
    const along = (k, x, y) => forward[k] + right[k] * w * (x - 0.5) + up[k] * h * (y - 0.5);
    return (x, y) => unit([along(0, x, y), along(1, x, y), along(2, x, y)]);
}

export const direction_at = (view, x, y) => directions_of(view)(x, y);

/** How far ahead lies what a view shows along one of its directions [m]. */
export function depth_along(view, direction) {
    const t = look(view.position, direction)?.t ?? Infinity;
    return t * dot(direction, unit(view.direction));
}

const turbo = (() => {
    const terms = [
        [0.13572138, 4.6153926, -42.66032258, 132.13108234, -152.94239396, 59.28637943],
        [0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604],
        [0.1066733, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973],
    ];
    return (x) =>
        terms.map(
            (t) =>
                255 *
                Math.max(
                    0,
                    Math.min(
                        1,
                        t.reduceRight((s, c) => s * x + c, 0),
                    ),
                ),
        );
})();

/** Of what is coloured [cd/m2]. */
export const luminance_of = ({ luminance, colour: [r, g, b] }) =>
    luminance * (0.265 * r + 0.67 * g + 0.065 * b);

/** Colour bytes of a luminance as a display message wants it. */
function colour_of(hit, display, factor) {
    if (!hit) return [0, 0, 0];
    if (display.mode === "false") {
        const { low, high, log } = display.scale;
        const L = luminance_of(hit);
        const share = log ? Math.log(L / low) / Math.log(high / low) : (L - low) / (high - low);
        return turbo(Math.max(0, Math.min(1, share)));
    }
    const L = (hit.luminance / 179) * factor,
        peak = L * Math.max(...hit.colour),
        shown = kCurve.shown(peak);
    const saturation = 1 / (1 + 0.03 * (peak - shown));
    return hit.colour.map((c) => {
        const x = shown * (1 - saturation + (saturation * c * L) / peak);
        return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
    });
}

export const kWhite = 16; // exposed value that is shown as white
const kCurve = new HighlightCurve(kWhite);

/** The factor that exposure makes of radiance. */
export const exposure_of = (display) => (display.exposure.auto ? 1.1 : 2 ** display.exposure.ev);

/** RGBA bytes of rows [from, to) of a picture of a view. */
export function paint(view, width, height, from, to, display) {
    const bytes = Buffer.alloc(width * (to - from) * 4, 255);
    const factor = exposure_of(display);
    const direction = directions_of(view);
    let k = 0;
    for (let y = from; y < to; ++y)
        for (let x = 0; x < width; ++x, k += 4) {
            const hit = look(view.position, direction((x + 0.5) / width, 1 - (y + 0.5) / height));
            const [r, g, b] = colour_of(hit, display, factor);
            bytes[k] = r;
            bytes[k + 1] = g;
            bytes[k + 2] = b;
        }
    return bytes;
}
