// The scale of relative differences of luminance, as the server draws them (io/picture/difference_colour.h). Does not use the
// document.
const kEven = 0.1, // octaves about none in which the scale is even
    kOctaves = 4; // at its ends

const kStops = [
    [103, 169, 255],
    [33, 102, 203],
    [40, 70, 118],
    [62, 62, 64],
    [133, 72, 26],
    [217, 108, 14],
    [255, 201, 74],
];

/** Shares that are written beside the scale, of the first side. */
export const kDifferences = [15, 3, 1, 0.25, 0.05, 0, -0.05, -0.2, -0.5, -0.75, -0.9375];

/** Where luminance `now` lies on the scale, -1 to 1, against `before`. */
export function difference_place(before, now) {
    if (before === now || Number.isNaN(before) || Number.isNaN(now)) return 0;
    if (!(before > 0)) return now > 0 ? 1 : 0;
    if (!(now > 0)) return -1;
    const r = Math.log2(now / before);
    return (
        Math.sign(r) * Math.min(1, Math.log1p(Math.abs(r) / kEven) / Math.log1p(kOctaves / kEven))
    );
}

/** The colour [r, g, b] (0..255) of a place on the scale, -1 to 1. */
export function difference_colour(place) {
    const at = ((Math.max(-1, Math.min(1, place)) + 1) / 2) * (kStops.length - 1);
    const first = Math.min(Math.floor(at), kStops.length - 2);
    return kStops[first].map((c, k) => Math.round(c + (at - first) * (kStops[first + 1][k] - c)));
}

/** A relative difference as text: "+25 %". */
export function share_text(share) {
    if (!Number.isFinite(share)) return share > 0 ? "+∞" : "–";
    const percent = Math.abs(100 * share);
    const digits = percent < 9.95 && percent >= 0.05 ? 1 : 0;
    const words = percent.toFixed(digits).replace(/\.0$/, "");
    return `${words === "0" ? "" : share > 0 ? "+" : "−"}${words} %`;
}
