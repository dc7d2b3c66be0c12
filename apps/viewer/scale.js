// False colours: which colour stands for which luminance. The server uses the same colour map.

// Mikhailov, "Turbo, an improved rainbow colormap for visualization", Google Research (2019), by
// its polynomials, from the constant up: red, green, blue.
const kTurbo = [
    [0.13572138, 4.6153926, -42.66032258, 132.13108234, -152.94239396, 59.28637943],
    [0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604],
    [0.1066733, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973],
];

/** The colour [r, g, b] (0..255) at `share` 0..1 of the scale; values outside 0..1 get the colour of the nearer end. */
export function palette_colour(share) {
    const x = Math.max(0, Math.min(1, share));
    return kTurbo.map((terms) => {
        const value = terms.reduceRight((sum, term) => sum * x + term, 0);
        return Math.round(255 * Math.max(0, Math.min(1, value)));
    });
}

export const colour_text = ([r, g, b]) => `rgb(${r} ${g} ${b})`;

/** Where a luminance lies on the scale: 0 at its low end, 1 at its high end. */
export function share_of(scale, luminance) {
    if (!scale.log) return (luminance - scale.low) / (scale.high - scale.low);
    return Math.log(luminance / scale.low) / Math.log(scale.high / scale.low);
}

/** What is wrong with a scale, or nothing. */
export function scale_problem({ low, high, log }) {
    if (!Number.isFinite(low) || !Number.isFinite(high)) return "Both limits must be numbers.";
    if (log && !(low > 0)) return "A logarithmic scale begins above 0.";
    if (low < 0) return "Luminance is not negative.";
    if (!(high > low)) return "The upper limit must be above the lower one.";
    return null;
}

/** Round numbers for a linear scale. */
function linear_ticks(low, high, most) {
    const rough = (high - low) / most;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * (1 - 1e-9));
    const ticks = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high * (1 + 1e-9); ++k)
        ticks.push(Number((k * step).toPrecision(12)));
    return ticks;
}

/** Round numbers for a logarithmic scale: 1, 2, 5 of each decade, or 1 and 3, or 1, as many as fit. */
function log_ticks(low, high, most) {
    const within = (x) => x >= low * (1 - 1e-9) && x <= high * (1 + 1e-9);
    let ticks = [];
    for (const steps of [[1, 2, 5], [1, 3], [1]]) {
        ticks = [];
        for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e)
            for (const s of steps) ticks.push(Number((s * 10 ** e).toPrecision(12)));
        ticks = ticks.filter(within);
        if (ticks.length <= most) break;
    }
    return ticks.length >= 2 ? ticks : linear_ticks(low, high, most);
}

/** Luminances to write beside the scale, about `most` of them, low first [cd/m2]. */
export function scale_ticks(scale, most = 8) {
    return scale.log
        ? log_ticks(scale.low, scale.high, most)
        : linear_ticks(scale.low, scale.high, most);
}
