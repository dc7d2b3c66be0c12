// The panel of the sun's time: hour, day and kind of sky, where a generator writes the scene's sky; and a day that runs.
import { by_id } from "./dom.js";
import { clock_text, date_of, date_text, day_of_year, kSkies, progress_text } from "./time.js";
import { kMinutes, sun_text, time_message } from "./time.js";

const kMinutesASecond = 30; // of a day that runs
const kNextPicture = 1500; // the day goes on without a picture after this [ms]

export class TimePanel {
    /**
     * @param on  {time(message), may_drive(), changed(): the user has changed something, frames(): count of those shown,
     *     ambient(): of the settings}
     */
    constructor(on) {
        this.on_ = on;
        this.file = null; ///< {month, day, hour, sky} of the scene's files; null: there is no time
        this.time = null; ///< the same as it is shown, or wanted
        this.touched = false; ///< whether this page has changed it; else it is as the server says
        this.told = null; ///< the server's newest `time`
        this.playing = false;
        this.waiting_ = false; // for the screen's next refresh, to send the newest time
        this.place_ = undefined; // of the newest `loaded`
        by_id("time-sky").replaceChildren(
            ...kSkies.map(([value, text]) => new Option(text, value)),
        );
        by_id("time-hour").addEventListener("input", ({ target }) =>
            this.change_({ hour: Number(target.value) / 60 }),
        );
        by_id("time-day").addEventListener("input", ({ target }) =>
            this.change_(date_of(Number(target.value))),
        );
        by_id("time-sky").addEventListener("change", ({ target }) =>
            this.change_({ sky: target.value }),
        );
        by_id("time-play").addEventListener("click", () => this.play(!this.playing));
        by_id("time-reset").addEventListener("click", () => this.reset());
    }

    /**
     * Show another side of a comparison.
     * @param other  what was returned when it was shown last; null: nothing is known of it yet
     * @returns what was shown
     */
    swap(other) {
        this.play(false);
        if (this.waiting_) this.tell();
        const { place_, file, time, touched, told } = this;
        const unknown = { file: null, time: null, touched: false, told: null };
        Object.assign(this, other ?? { ...unknown, place_: undefined });
        this.show_place_();
        this.show_told_();
        this.show_();
        return { place_, file, time, touched, told };
    }

    /** @param place  of `loaded`: {time, solar, types, latitude, longitude, refused}; missing: no generator writes a sky */
    open(place) {
        this.play(false);
        this.place_ = place;
        this.file = place && !place.refused ? place.time : null;
        this.told = null;
        if (!this.file) this.time = null;
        else if (!this.touched || !this.on_.may_drive()) this.time = { ...this.file };
        this.show_place_();
        this.show_();
    }

    /** Whether a generator writes the scene's sky. */
    get is_there() {
        return Boolean(this.place_);
    }

    show_place_() {
        const place = this.place_,
            refused = place?.refused ?? "";
        by_id("time-hint").hidden = !refused;
        by_id("time-hint").textContent = refused ? `The time cannot be changed: ${refused}` : "";
        by_id("time-tools").hidden = !this.file;
        by_id("time-types").hidden = !place?.types;
        by_id("time-clock-kind").textContent = place?.solar ? "Hour, solar time" : "Hour";
    }

    /** Take what the server shows from now on. */
    take(message) {
        this.told = message;
        this.show_told_();
        if (this.file && !(this.touched && this.on_.may_drive()))
            this.time = { ...(message.time ?? this.file) };
        this.show_();
    }

    show_told_() {
        const problem = this.told?.problem ?? "";
        by_id("time-problem").textContent = problem;
        by_id("time-problem").hidden = !problem;
        if (!this.told) by_id("time-state").textContent = "";
    }

    /** Say the server which time it is, if that is for this page to say. */
    tell() {
        if (!this.file || !this.touched) return;
        this.on_.time(time_message(this.is_file_() ? null : this.time));
    }

    /** Whether the page drives: who watches sees the time, and cannot change it. */
    drive() {
        const still = !this.on_.may_drive();
        if (still) this.play(false);
        for (const control of document.querySelectorAll(
            "#time-tools input, #time-sky, #time-play, #time-reset",
        ))
            control.disabled = still;
        by_id("time-reset").disabled = still || !this.time || this.is_file_();
    }

    /** What is not exact yet, from the server's `state`. */
    follow(state) {
        if (!this.time) return;
        by_id("time-state").textContent = progress_text(
            clock_text(this.time.hour),
            state,
            this.on_.ambient(),
        );
    }

    reset() {
        this.play(false);
        this.change_({ ...this.file });
    }

    /** Let the day run: as fast as pictures of it come, but no faster than half an hour a second. */
    play(wanted) {
        if (wanted === this.playing) return;
        this.playing = wanted && this.file !== null && this.on_.may_drive();
        const button = by_id("time-play");
        button.setAttribute("aria-pressed", String(this.playing));
        button.textContent = this.playing ? "Stop" : "Play the day";
        this.ticked_ = performance.now();
        this.frames_ = this.on_.frames();
    }

    /** A refresh of the screen. */
    refresh(now) {
        if (!this.playing) return;
        const frames = this.on_.frames(),
            passed = now - this.ticked_;
        if (passed < 100 || (frames === this.frames_ && passed < kNextPicture)) return;
        this.frames_ = frames;
        this.ticked_ = now;
        const minutes = this.time.hour * 60 + (Math.min(passed, 500) / 1000) * kMinutesASecond;
        this.change_({ hour: (minutes % kMinutes) / 60 });
    }

    is_file_() {
        return Object.keys(this.file).every((key) => this.file[key] === this.time[key]);
    }

    change_(part) {
        this.time = { ...this.time, ...part };
        this.touched = true;
        this.show_();
        this.on_.changed();
        if (this.waiting_) return; // one message a refresh of the screen at most
        this.waiting_ = true;
        requestAnimationFrame(() => {
            this.waiting_ = false;
            this.tell();
        });
    }

    show_() {
        if (!this.time) return;
        const { hour, sky } = this.time;
        const day = day_of_year(this.time.month, this.time.day);
        const clock = clock_text(hour);
        by_id("time-hour").value = Math.round(hour * 60);
        by_id("time-hour").setAttribute("aria-valuetext", clock);
        by_id("time-clock").textContent = clock;
        by_id("time-day").value = day;
        by_id("time-day").setAttribute("aria-valuetext", date_text(this.time));
        by_id("time-date").textContent = date_text(this.time);
        if (sky) by_id("time-sky").value = sky;
        by_id("time-sun").textContent = this.told ? sun_text(this.told) : "";
        for (const mark of ["rise", "set"]) {
            const at = this.told?.[mark];
            by_id(`time-${mark}`).hidden = typeof at !== "number";
            if (typeof at === "number")
                by_id(`time-${mark}`).style.left = `${((100 * at) / 24).toFixed(2)}%`;
        }
        this.drive();
    }
}
