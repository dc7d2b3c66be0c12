// Paths: keys of views over time, as `lightwalk animate --path` takes them.
import { dot, length, normalize, subtract } from "./vector.js";

const kNumbers = ["horizontal", "vertical", "fore", "aft", "shift", "lift"];
const kVectors = ["position", "direction", "up"];

const numbers_of = (view) => [
    ...kVectors.flatMap((name) => view[name]),
    ...kNumbers.map((name) => view[name] || 0),
];

function view_of(type, n) {
    const view = { type, position: n.slice(0, 3), direction: n.slice(3, 6), up: n.slice(6, 9) };
    kNumbers.forEach((name, k) => (view[name] = n[9 + k]));
    // Splines overshoot zero where a clipping distance ends or begins.
    return { ...view, fore: Math.max(view.fore, 0), aft: Math.max(view.aft, 0) };
}

/** What is wrong with the keys {time, view} of a path; nothing where it can be played. */
export function path_problem(keys) {
    for (let k = 1; k < keys.length; ++k) {
        if (!(keys[k].time > keys[k - 1].time)) return "the times of a path must rise";
        if (keys[k].view.type !== keys[0].view.type) return "the views of a path are of one type";
    }
    return keys.length > 0 ? null : "a path needs a view";
}

/** A file's name as a shell takes it. */
export function quoted(name) {
    if (/^[\w./+:@%][\w./+:@%-]*$/.test(name)) return name;
    return `'${name.replaceAll("'", "'\\''")}'`;
}

/** The command that makes a film of a path's file. */
export function film_command(file, scene) {
    const film = file.replace(/(\.path)?\.vf$/, ".mp4");
    const named = [file, film, scene || "SCENE"].map(quoted);
    return `lightwalk animate --path ${named[0]} -o ${named[1]} ${named[2]}`;
}

/**
 * The view at a time [s]: a cubic Hermite spline of all numbers of a view, whose slope at a key is that of the line between
 * its neighbours (Catmull & Rom, "A class of local interpolating splines", 1974, for keys at any times), as in
 * `animate`. Before the first key and after the last one it stands still.
 */
export function path_view(keys, time) {
    const last = keys.length - 1;
    if (!(time > keys[0].time)) return keys[0].view;
    if (time >= keys[last].time) return keys[last].view;
    const i = index_before(keys, time);
    const value = (k) => numbers_of(keys[Math.max(0, Math.min(last, k))].view);
    const at = (k) => keys[Math.max(0, Math.min(last, k))].time;
    const [before, from, to, after] = [value(i - 1), value(i), value(i + 1), value(i + 2)];
    const span = at(i + 1) - at(i);
    const s = (time - at(i)) / span,
        r = 1 - s;
    const numbers = from.map((x, n) => {
        const leaving = (to[n] - before[n]) / (at(i + 1) - at(i - 1));
        const coming = (after[n] - x) / (at(i + 2) - at(i));
        return (
            r * r * (1 + 2 * s) * x +
            s * s * (1 + 2 * r) * to[n] +
            span * s * r * (r * leaving - s * coming)
        );
    });
    return view_of(keys[i].view.type, numbers);
}

/** The index of the last key that is not after `time`. */
function index_before(keys, time) {
    let low = 0,
        high = keys.length - 1;
    while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (keys[middle].time <= time) low = middle;
        else high = middle;
    }
    return low;
}

const kClose = 0.01; // how far a recorded path may be from what was walked [eye heights]
const kAligned = (0.25 * Math.PI) / 180; // the same for directions [rad]

/** How far two views are apart, in tolerances. */
function apart(a, b, eye_height) {
    const angle = (p, q) => Math.acos(Math.min(1, dot(normalize(p), normalize(q))));
    return Math.max(
        length(subtract(a.position, b.position)) / (kClose * eye_height),
        angle(a.direction, b.direction) / kAligned,
        angle(a.up, b.up) / kAligned,
        Math.abs(a.horizontal - b.horizontal) / 0.25,
    );
}

/**
 * Few of the samples {time, view}, such that the path through them is everywhere near all: from the first and the last one
 * on, between any two keys the sample that is farthest from the path is added, until all are near it.
 */
export function thinned(samples, eye_height = 1.6) {
    if (samples.length < 3) return samples;
    const chosen = new Set([0, samples.length - 1]);
    for (;;) {
        const order = [...chosen].sort((a, b) => a - b);
        const keys = order.map((k) => samples[k]);
        const before = chosen.size;
        for (let k = 1; k < order.length; ++k) {
            let worst = 1,
                which = null;
            for (let n = order[k - 1] + 1; n < order[k]; ++n) {
                const error = apart(path_view(keys, samples[n].time), samples[n].view, eye_height);
                if (error > worst) [worst, which] = [error, n];
            }
            if (which !== null) chosen.add(which);
        }
        if (chosen.size === before) return keys;
    }
}

const kSampling = 50; // least time between two samples of a recording [ms]
const kLongest = 600; // longest recording [s]

/** Records how the eye moves; times begin when it is first seen to do so. */
export class Recorder {
    constructor() {
        this.samples_ = [];
        this.begin_ = null;
    }

    /** Note where the eye is at a time [ms]; false: the recording has become as long as one may be. */
    note(view, now) {
        const first = this.samples_.length === 0;
        this.begin_ ??= now;
        const before = this.samples_.at(-1);
        if (!first && before.view.type !== view.type) return false;
        const time = (now - this.begin_) / 1000;
        if (!first && time - before.time < kSampling / 1000) return true;
        // What comes before the first step is no part of the path.
        if (this.samples_.length === 1 && apart(before.view, view, 1) < 1e-6) {
            this.begin_ = now;
            return true;
        }
        this.samples_.push({ time: Number(time.toFixed(3)), view });
        return time < kLongest;
    }

    /** The keys of what was recorded; standing still at the end is no part of it. */
    keys(eye_height) {
        const samples = [...this.samples_];
        while (samples.length > 2 && apart(samples.at(-1).view, samples.at(-2).view, 1) < 1e-6)
            samples.pop();
        return thinned(samples, eye_height);
    }
}

/** The clock of a path that is played. */
export class Playback {
    constructor() {
        this.keys = [];
        this.speed = 1;
        this.time = 0; ///< where on the path one is [s]
    }

    get begin() {
        return this.keys[0]?.time ?? 0;
    }

    get end() {
        return this.keys.at(-1)?.time ?? 0;
    }

    set_keys(keys) {
        this.keys = keys;
        this.time = Math.max(this.begin, Math.min(this.end, this.time));
    }

    /** From `now` [ms] on: the view and the time on the path as functions of the clock [ms], and when the path ends [ms]. */
    start(now) {
        if (this.time >= this.end) this.time = this.begin;
        const { keys, speed, time: from } = this;
        const time = (clock) =>
            Math.min(this.end, from + (speed * Math.max(0, clock - now)) / 1000);
        return {
            time,
            at: (clock) => path_view(keys, time(clock)),
            end: now + (1000 * (this.end - from)) / speed,
        };
    }
}
