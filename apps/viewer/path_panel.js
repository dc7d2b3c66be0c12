// The path: its keys, and how it is recorded, played and scrubbed.
import { by_id, element, remove_button } from "./dom.js";
import { notice } from "./notices.js";
import { path_problem, path_view, Playback, Recorder } from "./path.js";
import { fit_view, view_problem } from "./view.js";
import { parse_keys } from "./view_text.js";
import { round_number } from "./words.js";

const kBetween = 2; // time between two keys that are added by hand [s]
const kInterval = 40; // between two looks at the eye while it is recorded or led [ms]

const time_text = (seconds) => `${seconds.toFixed(1)} s`;

export class PathPanel {
    /** @param on  {go(view), may_drive(), changed(keys)} */
    constructor(navigator, on) {
        this.keys = []; ///< {time [s], view} of each key
        this.navigator_ = navigator;
        this.on_ = on;
        this.playback_ = new Playback();
        this.playing_ = null; // what Playback.start() returned
        this.way_ = null; // what the navigator calls it
        this.recorder_ = null;
        this.listen_();
        this.show_();
    }

    restore(keys) {
        const sound = ({ time, view }) => Number.isFinite(time) && view && !view_problem(view);
        this.keys = keys.filter(sound);
        this.show_();
    }

    add_key(view) {
        const time = this.keys.length === 0 ? 0 : this.keys.at(-1).time + kBetween;
        this.set_keys([...this.keys, { time, view }]);
        return this.keys.length;
    }

    /** Say how the path that was saved becomes a film. */
    tell_film(command) {
        by_id("path-text").replaceChildren(
            "A film of it, where ffmpeg is installed: ",
            element("code", { textContent: command }),
        );
    }

    set_keys(keys) {
        this.pause();
        this.keys = keys;
        this.on_.changed(keys);
        this.show_();
    }

    /** Take the path of a file. */
    async open(file) {
        try {
            const keys = parse_keys(await file.text());
            const problem = path_problem(keys);
            if (problem) throw new Error(problem);
            this.set_keys(keys);
            this.on_.go(keys[0].view);
        } catch (error) {
            notice(`${file.name}: ${error.message}`, true);
        }
    }

    toggle_record() {
        if (this.recorder_) return this.end_recording_();
        if (!this.on_.may_drive()) return;
        this.pause();
        this.recorder_ = new Recorder();
        this.recorder_.note(this.navigator_.view, performance.now());
        this.show_();
        notice("Recording: walk");
    }

    toggle_play() {
        if (this.playing_) return this.pause();
        if (!this.on_.may_drive() || this.keys.length < 2) return;
        const problem = path_problem(this.keys);
        if (problem) return notice(problem, true);
        if (this.recorder_) this.end_recording_();
        this.start_();
        this.show_();
    }

    pause() {
        if (!this.playing_) return;
        this.playing_ = null;
        if (this.navigator_.follows(this.way_)) this.navigator_.stop_transition();
        this.show_();
    }

    start_() {
        const now = performance.now();
        this.playing_ = this.playback_.start(now);
        this.way_ = this.navigator_.follow(this.playing_, now);
    }

    set_speed_(speed) {
        this.playback_.speed = speed;
        if (this.playing_) this.start_();
    }

    /** Show the view at a time of the path; `held`: the slider is still being moved. */
    scrub_(time, held) {
        if (!this.on_.may_drive() || this.keys.length < 2) return;
        this.pause();
        this.playback_.time = time;
        const view = path_view(this.keys, time);
        const now = performance.now();
        this.navigator_.follow({ at: () => view, end: held ? Infinity : now }, now);
        this.show_time_();
    }

    end_recording_() {
        const keys = this.recorder_
            .keys(this.navigator_.eye_height)
            .map(({ time, view }) => ({ time, view: fit_view(view, innerWidth, innerHeight) }));
        this.recorder_ = null;
        if (keys.length > 1) {
            this.playback_.time = 0;
            this.set_keys(keys);
            notice(`Recorded: ${keys.length} keys, ${time_text(keys.at(-1).time)}`);
        } else notice("Nothing has moved: nothing is recorded");
        this.show_();
    }

    /** Look at the eye: what is recorded, and whether somebody has taken it from the path. */
    follow_() {
        const now = performance.now();
        const { view } = this.navigator_;
        if (this.recorder_ && view && !this.recorder_.note(view, now)) this.end_recording_();
        if (!this.playing_) return;
        this.playback_.time = this.playing_.time(now);
        if (this.navigator_.follows(this.way_)) this.show_time_();
        else {
            this.playing_ = null;
            this.show_();
        }
    }

    listen_() {
        const slider = by_id("path-time");
        slider.addEventListener("input", () => this.scrub_(Number(slider.value), true));
        slider.addEventListener("change", () => this.scrub_(Number(slider.value), false));
        by_id("path-speed").addEventListener("change", (event) =>
            this.set_speed_(Number(event.target.value)),
        );
        by_id("play-path").addEventListener("click", () => this.toggle_play());
        by_id("record-path").addEventListener("click", () => this.toggle_record());
        by_id("clear-path").addEventListener("click", () => this.set_keys([]));
        by_id("open-path").addEventListener("click", () => by_id("path-file").click());
        by_id("path-file").addEventListener("change", (event) => {
            if (event.target.files[0]) this.open(event.target.files[0]);
            event.target.value = "";
        });
        setInterval(() => this.follow_(), kInterval);
    }

    show_() {
        this.playback_.set_keys(this.keys);
        by_id("keys").replaceChildren(...this.keys.map((key, k) => this.entry_(key, k)));
        by_id("clear-path").disabled = this.keys.length === 0;
        // A path needs two keys.
        const short = this.keys.length < 2;
        for (const id of ["write-path", "write-path-too", "play-path", "path-time", "path-speed"])
            by_id(id).disabled = short;
        by_id("play-path").textContent = this.playing_ ? "Pause" : "Play";
        by_id("record-path").textContent = this.recorder_ ? "Stop" : "Record";
        by_id("record-path").setAttribute("aria-pressed", String(Boolean(this.recorder_)));
        const slider = by_id("path-time");
        slider.min = this.playback_.begin;
        slider.max = Math.max(this.playback_.end, this.playback_.begin + 0.1);
        this.show_time_();
    }

    show_time_() {
        const { time } = this.playback_;
        by_id("path-time").value = time;
        by_id("path-time").setAttribute("aria-valuetext", time_text(time));
        by_id("path-now").textContent = time_text(time);
    }

    entry_({ time, view }, k) {
        const button = element(
            "button",
            { type: "button", className: "go", onclick: () => this.on_.go(view) },
            element("b", { textContent: `${round_number(Number(time.toFixed(2)))} s` }),
            element("span", { textContent: `Key ${k + 1}` }),
        );
        const remove = () => this.set_keys(this.keys.filter((_, n) => n !== k));
        return element("li", {}, button, remove_button(`key ${k + 1}`, remove));
    }
}
