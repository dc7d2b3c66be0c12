// The floor plan of where the walk is: the eye on it, and places to go to by a click or by keys.
import { by_id, shape } from "./dom.js";
import { notice } from "./notices.js";
import {
    heading_of,
    is_elsewhere,
    place_to_go,
    place_words,
    plan_pixels,
    plan_place,
    read_plan,
    scale_length,
    scene_place,
    shows,
    way_words,
} from "./plan.js";
import { round_number } from "./words.js";

const kAgain = 700; // least time between two requests [ms]
const kPatience = 8000; // an answer that takes longer will not come [ms]
const kWedge = 34; // length of the wedge that tells where the eye looks [CSS pixels]
const kWidest = 75; // half of its largest angle [degrees]
const kStep = 0.25, // of the cursor [eye heights]
    kLongStep = 1;
const kArrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class PlanPanel {
    /**
     * @param on  {ask(): number of the request, eye(): the view that the screen shows or null, eye_height(), walks(),
     *     go(position), may_drive()}
     */
    constructor(on) {
        this.on_ = on;
        this.plan = null; ///< the newest one, as read_plan() gives it
        this.cursor = null; ///< where the keys have gone, in cells; null: nowhere yet
        this.request_ = 0; // that no answer has come for yet, or 0
        this.asked_ = null; // of the newest request: {at: when [ms], eye: null to ask again, again: it was asked again}
        this.drawn_ = ""; // what the marks show
        const box = by_id("plan");
        box.addEventListener("click", (event) => this.click_(event));
        box.addEventListener("keydown", (event) => this.key_(event));
        matchMedia("(prefers-contrast: more)").addEventListener("change", () => this.paint_());
    }

    get open() {
        return !by_id("panel-plan").hidden;
    }

    /** Forget the plan: the scene is another one, or there is no server that would answer. */
    forget() {
        this.request_ = 0;
        this.asked_ = null;
        this.take_(null);
    }

    /** Take an answer of the server. */
    async answer(message) {
        if (message.id !== this.request_) return;
        try {
            const plan = message.width > 0 ? await read_plan(message) : null;
            if (message.id !== this.request_) return; // forgotten meanwhile
            this.take_(plan);
            if (!plan) this.say_("There is nothing here to draw a plan of.");
            const eye = this.on_.eye()?.position;
            // The server may not have known of the eye's last step; where no plan shows the eye, asking twice is enough.
            const late = eye && plan && !shows(plan, eye, this.on_.eye_height());
            if (late && !this.asked_.again) this.asked_.eye = null;
        } catch (error) {
            this.say_(`No plan: ${error.message}`);
        }
        this.request_ = 0;
    }

    /** Whether a refusal was the answer to a request of this. */
    refused(id) {
        if (id === undefined || id !== this.request_) return false;
        this.request_ = 0;
        this.asked_.eye = null; // ask again
        return true;
    }

    /** Show where the eye is; called at each refresh of the screen. */
    refresh(now) {
        if (!this.open) return;
        const view = this.on_.eye();
        if (!view) return;
        this.ask_if_needed_(view.position, now);
        if (this.plan) this.show_marks_(view);
    }

    ask_if_needed_(eye, now) {
        const height = this.on_.eye_height();
        if (this.plan && shows(this.plan, eye, height)) return;
        if (this.asked_) {
            const wait = this.request_ ? kPatience : kAgain;
            const before = this.asked_.eye;
            if (now - this.asked_.at < wait) return;
            if (before && !this.request_ && !is_elsewhere(eye, before, height)) return;
        }
        this.request_ = this.on_.ask();
        this.asked_ = { at: now, eye, again: this.asked_?.eye === null };
    }

    take_(plan) {
        this.plan = plan;
        this.cursor = null;
        this.drawn_ = "";
        by_id("plan-marks").replaceChildren();
        by_id("plan-picture").hidden = !plan;
        const drawn = this.on_.may_drive() ? "Click to go there." : "";
        this.say_(plan ? drawn : "Drawing the plan…");
        this.paint_();
    }

    paint_() {
        if (!this.plan) return;
        const canvas = by_id("plan-picture");
        canvas.width = this.plan.width;
        canvas.height = this.plan.height;
        const strong = matchMedia("(prefers-contrast: more), (forced-colors: active)").matches;
        const pixels = new ImageData(plan_pixels(this.plan, strong), this.plan.width);
        canvas.getContext("2d").putImageData(pixels, 0, 0);
    }

    say_(words) {
        const text = by_id("plan-text");
        if (text.textContent !== words) text.textContent = words;
    }

    /** How the plan lies in its box: {scale [CSS pixels a cell], left, top [CSS pixels]}. */
    layout_() {
        const { clientWidth, clientHeight } = by_id("plan");
        const { width, height } = this.plan;
        const scale = Math.min(clientWidth / width, clientHeight / height);
        return {
            scale,
            left: (clientWidth - width * scale) / 2,
            top: (clientHeight - height * scale) / 2,
        };
    }

    show_marks_(view) {
        const { scale, left, top } = this.layout_();
        const at = ([column, row]) => [left + column * scale, top + row * scale];
        const eye = at(plan_place(this.plan, view.position));
        const cursor = this.cursor && at(this.cursor);
        const heading = heading_of(view);
        const drawn = [eye, cursor, heading, view.horizontal, scale, left, top].join();
        if (drawn === this.drawn_) return;
        this.drawn_ = drawn;
        by_id("plan").setAttribute(
            "aria-label",
            `${place_words(this.plan, view)} Arrow keys choose a place, Enter goes there.`,
        );
        by_id("plan-marks").replaceChildren(
            ...this.scale_marks_(scale),
            ...this.eye_marks_(eye, heading, view.horizontal),
            ...(cursor ? this.cursor_marks_(cursor) : []),
        );
    }

    eye_marks_([x, y], [right, up], lens) {
        const half = (Math.min(lens / 2, kWidest) * Math.PI) / 180;
        const corner = (angle) => {
            const c = Math.cos(angle),
                s = Math.sin(angle);
            return [x + kWedge * (c * right - s * up), y - kWedge * (s * right + c * up)].join(" ");
        };
        const arc = `A${kWedge} ${kWedge} 0 0 1 ${corner(-half)}`;
        return [
            shape("path", { d: `M${x} ${y}L${corner(half)}${arc}Z`, class: "wedge" }),
            shape("circle", { cx: x, cy: y, r: 5, class: "eye" }),
        ];
    }

    cursor_marks_([x, y]) {
        const cross = `M${x - 12} ${y}h8M${x + 4} ${y}h8M${x} ${y - 12}v8M${x} ${y + 4}v8`;
        return ["halo", "cross"].map((name) => shape("path", { d: cross, class: name }));
    }

    /** How long a round length is, and where north is. */
    scale_marks_(scale) {
        const length = scale_length(this.plan, 0.3);
        const pixels = (length / this.plan.cell) * scale;
        const { clientWidth: width, clientHeight: height } = by_id("plan");
        const bar = `M10 ${height - 13}v4h${pixels}v-4M${width - 16} 30v-18l-4 7m4-7l4 7`;
        return [
            shape("path", { d: bar, class: "bar under" }),
            shape("path", { d: bar, class: "bar" }),
            shape("text", { x: 14, y: height - 14 }, `${round_number(length)} m`),
            shape("text", { x: width - 16, y: 43, "text-anchor": "middle" }, "N"),
        ];
    }

    click_(event) {
        if (!this.plan) return;
        const box = by_id("plan").getBoundingClientRect();
        const { scale, left, top } = this.layout_();
        const at = [event.clientX - box.left - left, event.clientY - box.top - top];
        this.cursor = null;
        this.go_(at.map((x) => x / scale));
    }

    go_(at) {
        const view = this.on_.eye();
        if (!view || !this.on_.may_drive()) return notice("Who watches goes where the driver goes");
        const height = this.on_.eye_height();
        const way = place_to_go(this.plan, at, view.position, height, this.on_.walks());
        if (way.problem) return notice(way.problem);
        this.on_.go(way.position);
    }

    key_(event) {
        if (!this.plan || event.ctrlKey || event.metaKey || event.altKey) return;
        const arrow = kArrows[event.key];
        if (!arrow && event.key !== "Enter" && event.key !== " ") return;
        // These keys would move the eye, or read the light.
        event.preventDefault();
        event.stopPropagation();
        const view = this.on_.eye();
        if (!view) return;
        if (arrow) this.move_cursor_(arrow, view, event.shiftKey ? kLongStep : kStep);
        else if (this.cursor && !event.repeat) this.go_(this.cursor);
    }

    move_cursor_(arrow, { position }, step) {
        const { width, height, cell } = this.plan;
        const from = this.cursor ?? plan_place(this.plan, position);
        const cells = (step * this.on_.eye_height()) / cell;
        const most = [width, height];
        this.cursor = from.map((x, k) =>
            Math.max(0.5, Math.min(most[k] - 0.5, x + arrow[k] * cells)),
        );
        this.say_(way_words(this.plan, this.cursor, position));
    }

    /** Where the cursor is in the scene, [x, y]; null where there is none. */
    get cursor_place() {
        return this.plan && this.cursor && scene_place(this.plan, this.cursor);
    }
}
