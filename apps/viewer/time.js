// Days and hours as text and as numbers of sliders, and the `time` message.

const kMonths = [
    ["January", 31],
    ["February", 28],
    ["March", 31],
    ["April", 30],
    ["May", 31],
    ["June", 30],
    ["July", 31],
    ["August", 31],
    ["September", 30],
    ["October", 31],
    ["November", 30],
    ["December", 31],
];
export const kMinutes = 24 * 60; // of a day
export const kLastDay = 365;

/** The kinds of sky that gensky knows, by its options. */
export const kSkies = [
    ["+s", "Clear, with sun"],
    ["-s", "Clear, without sun"],
    ["+i", "Intermediate, with sun"],
    ["-i", "Intermediate, without sun"],
    ["-c", "Overcast"],
    ["-u", "Uniform"],
];

/** The day of the year, 1 to 365, of a month and a day of it, both from 1. */
export const day_of_year = (month, day) =>
    kMonths.slice(0, month - 1).reduce((sum, [, days]) => sum + days, 0) +
    Math.min(day, kMonths[month - 1][1]);

/** Month and day of a day of the year, 1 to 365. */
export function date_of(day) {
    let left = Math.max(1, Math.min(kLastDay, Math.round(day)));
    for (let month = 0; ; ++month) {
        const days = kMonths[month][1];
        if (left <= days) return { month: month + 1, day: left };
        left -= days;
    }
}

export const date_text = ({ month, day }) => `${day} ${kMonths[month - 1][0]}`;

/** Hours as "14:18". */
export function clock_text(hour) {
    const minutes = Math.round(hour * 60) % kMinutes;
    return `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}`;
}

/** The `time` message. @param time  {month, day, hour, sky} or null: as the scene's files have it */
export const time_message = (time) => ({ type: "time", time });

const degrees = (x) => `${Math.round(Math.abs(x))}°`;

/** What is told of the sun: a `time` reply of the server. */
export function sun_text({ rise, set, altitude }) {
    const now = altitude < 0 ? `sun ${degrees(altitude)} below` : `sun ${degrees(altitude)} high`;
    const day =
        typeof rise === "number" && typeof set === "number"
            ? `Sunrise ${clock_text(rise)}, sunset ${clock_text(set)}`
            : altitude < 0
              ? "The sun does not rise"
              : "The sun does not set";
    return `${day}; ${now}`;
}

/**
 * What the picture shows of the light so far, or "" where it is exact.
 * @param state  the newest of the server, of this light
 * @param ambient  see `settings`: whether indirect light is wanted
 */
export function progress_text(clock, state, ambient) {
    const follows = state.inferred > 0 ? "indirect light is a draft" : "indirect light follows";
    if (state.phase === "moving") return `Light of ${clock}, coarse`;
    if (state.phase === "filling")
        return `Light of ${clock}: ${Math.round(100 * state.share)} % of the picture${ambient === "off" ? "" : `, ${follows}`}`;
    if (state.phase === "ambient")
        return `Light of ${clock}; indirect light: ${Math.round(100 * state.share)} %${state.inferred > 0 ? ", else a draft" : ""}`;
    if (state.phase === "refining") return `Light of ${clock}; edges become finer`;
    return `Light of ${clock}`;
}
