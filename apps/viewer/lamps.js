// Dimmers of light groups: colour temperatures as factors of a lamp's channels, and the `lights` message.

export const kCoolest = 1800, // of the colours that may be chosen [K]
    kHottest = 10000;
const kMostPercent = 200;

// Radiance's standard primaries and its white, of equal energy: Ward Larson & Shakespeare, "Rendering with Radiance" (1998),
// ch. 10.
const kPrimaries = [
    [0.64, 0.33],
    [0.29, 0.6],
    [0.15, 0.06],
];
const kBrightness = [0.26510582, 0.67010582, 0.06478836];

/**
 * Chromaticity x, y of a black body at T kelvin, 1667 to 25000. Source: Kim et al., "Design of advanced color temperature
 * control system for HDTV applications", J. Korean Physical Society 41 (2002).
 */
export function planckian_xy(T) {
    const t = 1000 / T;
    const x =
        T <= 4000
            ? ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.17991
            : ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.24039;
    let y;
    if (T <= 2222) y = ((-1.1063814 * x - 1.3481102) * x + 2.18555832) * x - 0.20219683;
    else if (T <= 4000) y = ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867;
    else y = ((3.081758 * x - 5.8733867) * x + 3.75112997) * x - 0.37001483;
    return [x, y];
}

const determinant = ([a, b, c]) =>
    a[0] * (b[1] * c[2] - b[2] * c[1]) +
    a[1] * (b[2] * c[0] - b[0] * c[2]) +
    a[2] * (b[0] * c[1] - b[1] * c[0]);

/** The amounts of three colours (columns of X, Y, Z) that make up another one: Cramer's rule. */
const amounts = (columns, wanted) =>
    columns.map(
        (_, k) =>
            determinant(columns.map((own, i) => (i === k ? wanted : own))) / determinant(columns),
    );

const xyz_of = ([x, y]) => [x / y, 1, (1 - x - y) / y];

/**
 * Factors of a lamp's red, green and blue that give a grey lamp the colour of a black body at T kelvin, and leave its luminance
 * as it is. Colours that the primaries cannot make are the nearest that have no channel below 0.
 */
export function temperature_rgb(T) {
    const columns = kPrimaries.map(xyz_of);
    const white = amounts(columns, [1, 1, 1]);
    const rgb = amounts(columns, xyz_of(planckian_xy(T))).map((value, k) =>
        Math.max(0, value / white[k]),
    );
    const light = rgb.reduce((sum, value, k) => sum + value * kBrightness[k], 0);
    return rgb.map((value) => value / light);
}

/** A group as the scene has it. kelvin: null, or the colour that was chosen. */
export const as_built = (name) => ({ name, on: true, percent: 100, kelvin: null });

export const is_as_built = ({ on, percent, kelvin }) => on && percent === 100 && kelvin === null;

const within = (value, low, high, fallback) =>
    Number.isFinite(value) ? Math.max(low, Math.min(high, value)) : fallback;

/** A lamp from a preset or a message; what is not sound in it is as the scene has it. */
export const sound_lamp = (name, { on, percent, kelvin } = {}) => ({
    name,
    on: on !== false,
    percent: within(percent, 0, kMostPercent, 100),
    kelvin: kelvin === null || !Number.isFinite(kelvin) ? null : within(kelvin, kCoolest, kHottest),
});

/** The `lights` message of the lamps. */
export const lights_message = (lamps) => ({
    type: "lights",
    levels: lamps
        .filter((lamp) => !is_as_built(lamp))
        .map(({ name, on, percent, kelvin }) => ({
            name,
            level: on ? percent / 100 : 0,
            rgb: kelvin === null ? [1, 1, 1] : temperature_rgb(kelvin),
        })),
});

/** The colour temperature of a message's factors; null where they are grey. */
export function kelvin_of(rgb) {
    if (!Array.isArray(rgb) || rgb.every((value) => value === rgb[0])) return null;
    const ratio = rgb[2] / rgb[0];
    let [low, high] = [kCoolest, kHottest];
    for (let step = 0; step < 24; ++step) {
        const middle = (low + high) / 2,
            [red, , blue] = temperature_rgb(middle);
        if (blue / red < ratio) low = middle;
        else high = middle;
    }
    return Math.round((low + high) / 200) * 100;
}

/** The lamps that a `lights` message of the driver tells of. */
export const lamps_of = (names, levels = []) =>
    names.map((name) => {
        const told = levels.find((one) => one?.name === name);
        if (!told) return as_built(name);
        const off = told.level === 0;
        return sound_lamp(name, {
            on: !off,
            percent: off ? 100 : told.level * 100,
            kelvin: kelvin_of(told.rgb),
        });
    });
