// Questions to the server about light, and their answers: the point under the pointer, pins, means over areas.
import { show_measurements } from "./measure_panel.js";
import { Measurements } from "./measurements.js";
import { notice } from "./notices.js";
import { Reading } from "./reading.js";
import { keep_scene_item, scene_item } from "./store.js";

const kSmallest = 3; // least side of an area [CSS pixels]

const now_text = () => new Date().toISOString().replace(/\.\d+/, "");

/** The rectangle between two corners, as shares of the picture from its lower left: [x0, y0, x1, y1]. */
function shares_of([x0, y0, x1, y1]) {
    const rising = (a, b) => [a, b].map((x) => Math.max(0, Math.min(1, x))).sort((p, q) => p - q);
    const [left, right] = rising(x0 / innerWidth, x1 / innerWidth);
    const [bottom, top] = rising(1 - y0 / innerHeight, 1 - y1 / innerHeight);
    return [left, bottom, right, top];
}

export class Measuring {
    /** @param changed  called when something is to be drawn again */
    constructor(session, counters, changed) {
        this.session_ = session;
        this.counters_ = counters;
        this.changed_ = changed;
        this.scene_ = null;
        this.sides = { session_at: () => session, panel_session: session, side_at: () => "" }; ///< see Comparison
        this.asked_ = new Map(); // by request number, of picks without an answer yet: their places, or what takes the answer
        this.drag = null; ///< corners of the area that is being drawn [CSS pixels]
        this.measurements = new Measurements((pins) => this.keep_(pins));
        this.reading = new Reading({ pin: (pick) => this.pin(pick), closed: changed });
    }

    /** Load what the browser stored for this scene. */
    open_scene(name) {
        this.scene_ = null; // nothing is stored while measurements are being restored
        this.measurements.restore(scene_item(name, "measured", {}));
        this.scene_ = name;
    }

    /** Ask what the picture shows at x, y (0..1 from the left and the bottom). */
    pick_at(x, y) {
        this.point_at(x, y, null);
    }

    /**
     * Ask the same, and hand the answer to `then` instead of showing it; answers that are under way are not shown
     * any more.
     */
    point_at(x, y, then) {
        if (!this.session_.connection.connected) return;
        if (then) this.asked_.clear();
        const question = { x, y, ...this.view_shown() };
        this.asked_.set(this.sides.session_at(x).ask("pick", question), then ?? [x, y]);
    }

    /** What is seen at a place is so in the view on the screen, which may be another than the newest one: {view}, or {}. */
    view_shown() {
        const { shown, frame_view } = this.session_;
        return shown && shown !== frame_view ? { view: shown } : {};
    }

    picked(message) {
        const at = this.asked_.get(message.id);
        if (!at) return;
        this.asked_.delete(message.id);
        if (typeof at === "function") return at(message);
        this.counters_.last_pick = message;
        this.reading.show({
            ...message,
            at,
            side: this.sides.open ? this.sides.side_at(at[0]) : "",
        });
        this.changed_();
    }

    pin(pick) {
        const probe = this.measurements.pin(pick, now_text());
        notice(probe ? `Pinned as ${probe.name}` : "64 pins are the most.", !probe);
    }

    area_begin(x, y) {
        this.drag = [x, y, x, y];
    }

    area_move(x, y) {
        this.drag = [this.drag[0], this.drag[1], x, y];
        this.changed_();
    }

    /** End the drawing of an area; `meant`: false when the drag was cancelled. */
    area_end(x, y, meant) {
        const [x0, y0] = this.drag;
        this.drag = null;
        const view = this.session_.shown;
        if (meant && !view) notice("Means are taken by who drives", true);
        if (meant && view && Math.min(Math.abs(x - x0), Math.abs(y - y0)) >= kSmallest) {
            const area = this.measurements.add_area(shares_of([x0, y0, x, y]), view);
            this.session_.ask("rectangle", { id: area.id, rect: area.rect });
        }
        this.changed_();
    }

    mean(message) {
        this.counters_.last_mean = message;
        this.measurements.update_area(message, this.settled_(), now_text());
    }

    probes(message) {
        this.counters_.last_probes = message;
        this.measurements.update_probes(message, now_text());
    }

    /** The picture has been refined: request the means of its areas again. */
    follow_light() {
        const { shown, frame_view, shown_id, view_id } = this.session_;
        if (!shown || shown !== frame_view || shown_id !== view_id) return;
        const now = performance.now();
        for (const { id, rect } of this.measurements.areas_to_ask(shown, this.settled_(), now))
            this.session_.ask("rectangle", { id, rect });
    }

    /** Send all pins; the server keeps their values up to date. Only the driver may. */
    tell_probes() {
        if (!this.session_.driving) return;
        const pin = ({ id, position, normal }) => ({ id, position, normal });
        const message = { type: "probes", probes: this.measurements.probes.map(pin) };
        this.sides.panel_session.send(message);
    }

    settled_() {
        return this.counters_.state.phase === "done" ? 1 : 0;
    }

    keep_(pins_changed) {
        show_measurements(this.measurements);
        if (this.scene_ !== null) {
            const { probes, areas } = this.measurements;
            keep_scene_item(this.scene_, "measured", { probes, areas });
            if (pins_changed) this.tell_probes();
        }
        this.changed_();
    }
}
