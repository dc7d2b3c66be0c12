// Isolux: the plane that is asked about, its figures, and what is drawn of it over the picture.
import { by_id, element } from "./dom.js";
import { contours_of, grid_table, read_grid, sensor_points, spacing_of } from "./isolux.js";
import { told_figures, trace_command } from "./isolux.js";
import { notice } from "./notices.js";
import { colour_text, palette_colour } from "./scale.js";
import { label_place, path_of, strokes_of } from "./strokes.js";
import { known, quantity, rough, round_number, within } from "./words.js";

const kAgain = 500; // least time between two requests that repeat one [ms]
const kHint = "Contours of illuminance on a plane, and how uniform it is.";
const kHighest = 1e6; // of planes above the floor [m]

const ratio = (x, half) =>
    [x >= 0.1 ? x.toFixed(2) : rough(x), within(x, half)].filter(Boolean).join(" ");

export class IsoluxPanel {
    /**
     * @param on  {ask(question): its number, pick(x, y, then), eye(): the view that the screen shows or null, ready(), sight():
     *     of the newest frame or null, changed()}
     */
    constructor(on) {
        this.on_ = on;
        this.choosing = false; ///< the next click tells the surface
        this.question_ = null; // {position, normal} or {position, height}
        this.where_ = ""; // the same in words
        this.request_ = 0; // whose answers are awaited, or 0
        this.again_ = false; // whether it is to be asked again
        this.asked_ = 0; // when it was asked [ms]
        this.grid = null; ///< the newest one, as read_grid() returns it
        this.figures = null; ///< see told_figures()
        this.done = 0; ///< share of the calculation
        this.outdated = ""; ///< why the grid is not of the present light
        this.contours_ = [];
    }

    /** Whether the next click chooses a surface. */
    choose(wanted) {
        this.choosing = wanted;
        by_id("isolux-surface").setAttribute("aria-pressed", String(wanted));
        if (wanted) notice("Click a surface, or press Enter for the middle");
    }

    /** A surface is chosen by its place in the picture (0..1 from the left and the bottom). */
    choose_at(x, y) {
        this.choose(false);
        this.on_.pick(x, y, (pick) => {
            if (!pick.hit) return notice("No surface there: sky or void");
            const { position, normal, surface, material } = pick;
            const where = `On ${[surface, material].filter(Boolean).join(", ") || "a surface"}`;
            this.begin_({ position, normal }, where);
        });
    }

    /** The plane above the floor of where the eye is. */
    above_floor() {
        const eye = this.on_.eye();
        if (!eye) return;
        const box = by_id("isolux-height");
        const height = Number(box.value.trim().replace(",", ".") || NaN);
        const sound = height >= 0 && height <= kHighest;
        box.setAttribute("aria-invalid", String(!sound));
        if (!sound) return this.say_("The height must be a number, not negative.");
        this.begin_(
            { position: eye.position, height },
            `${round_number(height)} m above the floor`,
        );
    }

    begin_(question, where) {
        this.clear();
        this.question_ = question;
        this.where_ = where;
        this.ask_();
        this.show_();
    }

    ask_() {
        this.again_ = false;
        this.asked_ = performance.now();
        this.request_ = this.on_.ask(this.question_);
    }

    /** Take an answer of the server. */
    answer(message) {
        if (message.id !== this.request_) return;
        try {
            const grid = read_grid(message);
            this.done = message.done;
            if (grid || message.done >= 1) this.take_(grid, message);
        } catch (error) {
            this.clear();
            this.say_(`No isolux: ${error.message}`);
        }
        this.show_();
    }

    take_(grid, message) {
        this.grid = grid;
        this.figures = grid && told_figures(grid, message);
        this.contours_ = grid ? contours_of(grid) : [];
        this.outdated = "";
        this.on_.changed();
    }

    /** Whether a refusal was the answer to a request of this; it is asked again. */
    refused(id) {
        if (id === undefined || id !== this.request_) return false;
        this.request_ = 0;
        this.again_ = true;
        return true;
    }

    /** The light is another one, or may be: what is shown holds no more, and is asked for again as soon as that can be. */
    outdate(why) {
        if (!this.question_) return;
        this.outdated = why;
        this.request_ = 0;
        this.again_ = true;
        this.show_();
        this.on_.changed();
    }

    /** Called at each refresh of the screen. */
    refresh(now) {
        if (this.again_ && now - this.asked_ >= kAgain && this.on_.ready()) this.ask_();
    }

    clear() {
        this.question_ = null;
        this.request_ = 0;
        this.again_ = false;
        this.done = 0;
        by_id("isolux-command").replaceChildren();
        this.take_(null, null);
        this.show_();
    }

    // What is saved

    /** @param settings  {scene, time} */
    table(settings) {
        return grid_table(this.grid, { settled: this.outdated ? 0 : this.done, ...settings });
    }

    points() {
        return sensor_points(this.grid);
    }

    /** Say how the file of points becomes illuminances. */
    tell_command(file, scene) {
        by_id("isolux-command").replaceChildren(
            "Its illuminances, with the options of light that the walk has: ",
            element("code", { textContent: trace_command(file, scene) }),
        );
    }

    // What is shown

    /** Contours as marks over the picture: {d, colour, words, at, outdated}. */
    marks(view) {
        if (!view || this.contours_.length === 0) return [];
        const size = [innerWidth, innerHeight];
        const sight = this.on_.sight();
        const hidden = (place) => sight !== null && sight.hides(place);
        const taken = [];
        return this.contours_.flatMap(({ level, share, lines }) => {
            const strokes = lines.flatMap((line) => strokes_of(view, line, size, hidden));
            if (strokes.length === 0) return [];
            const at = label_place(strokes, size, taken);
            if (at) taken.push(at);
            return {
                d: path_of(strokes),
                colour: colour_text(palette_colour(0.1 + 0.85 * share)),
                words: `${round_number(level)} lx`,
                at,
                outdated: this.outdated !== "",
            };
        });
    }

    say_(words) {
        const text = by_id("isolux-text");
        if (text.textContent !== words) text.textContent = words;
    }

    show_() {
        const share = by_id("isolux-share");
        share.hidden = !this.question_ || (this.done >= 1 && !this.outdated);
        share.value = this.done;
        by_id("isolux-figures").hidden = !this.figures;
        by_id("isolux-files").hidden = !this.question_;
        for (const id of ["write-isolux", "write-points"]) by_id(id).disabled = !this.grid;
        this.say_(this.words_());
        if (!this.figures) return;
        const { mean, min, max, uniformity, diversity, count, half = {} } = this.figures;
        const line = (name, value) =>
            element(
                "div",
                {},
                element("dt", { textContent: name }),
                element("dd", { textContent: value }),
            );
        by_id("isolux-figures").className = this.done < 1 || this.outdated ? "unsettled" : "";
        by_id("isolux-figures").replaceChildren(
            line("Mean", known(mean, half.mean, "lx")),
            line("Minimum", known(min, half.min, "lx")),
            line("Maximum", known(max, half.max, "lx")),
            line("Uniformity (min/mean)", ratio(uniformity, half.uniformity)),
            line("Diversity (min/max)", ratio(diversity, half.diversity)),
            line("Points", `${count}, ${quantity(spacing_of(this.grid))} m apart`),
        );
    }

    /** Not how far it is: this is read out whenever it changes. */
    words_() {
        if (!this.question_) return kHint;
        if (this.outdated) return `${this.where_}. Out of date: ${this.outdated}.`;
        if (!this.grid)
            return `${this.where_}. ${this.done >= 1 ? "There is no plane there." : "Looking for the plane…"}`;
        return `${this.where_}. ${this.done >= 1 ? "Final." : "Coarse, not final yet."}`;
    }
}
