// Questions about light and their answers: what is pointed at, what stays pinned, means over areas.
import { show_measurements } from "./measure_panel.js";
import { Measurements } from "./measurements.js";
import { notice } from "./notices.js";
import { Reading } from "./reading.js";
import { keep_scene_item, scene_item } from "./store.js";

const kSmallest = 3; // side of an area [CSS pixels]

const now_text = () => new Date().toISOString().replace(/\.\d+/, "");

/** The rectangle of two corners, as shares of the picture from its lower left: [x0, y0, x1, y1]. */
function shares_of([x0, y0, x1, y1]) {
    const rising = (a, b) => [a, b].map((x) => Math.max(0, Math.min(1, x))).sort((p, q) => p - q);
    const [left, right] = rising(x0 / innerWidth, x1 / innerWidth);
    const [bottom, top] = rising(1 - y0 / innerHeight, 1 - y1 / innerHeight);
    return [left, bottom, right, top];
}

export class Measuring {
    /** @param changed  something is to be drawn anew */
    constructor(session, counters, changed) {
        this.session_ = session;
        this.counters_ = counters;
        this.changed_ = changed;
        this.scene_ = null;
        this.asked_ = new Map(); // where picks under way point to, by their numbers
        this.drag = null; ///< an area that is being drawn: corners [CSS pixels]
        this.measurements = new Measurements((pins) => this.keep_(pins));
        this.reading = new Reading({ pin: (pick) => this.pin(pick), closed: changed });
    }

    /** What was measured in this scene before. */
    open_scene(name) {
        this.scene_ = null; // nothing is kept while it is only read
        this.measurements.restore(scene_item(name, "measured", {}));
        this.scene_ = name;
    }

    /** Ask what is at x, y of the picture (0..1 from the left and the bottom). */
    pick_at(x, y) {
        if (!this.session_.connection.connected) return;
        this.asked_.set(this.session_.ask("pick", { x, y }), [x, y]);
    }

    picked(message) {
        const at = this.asked_.get(message.id);
        if (!at) return;
        this.asked_.delete(message.id);
        this.counters_.last_pick = message;
        this.reading.show({ ...message, at });
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

    /** `meant`: the drag ended as it should. */
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

    /** The light settles: means of the present picture are asked for again. */
    follow_light() {
        const { shown, shown_id, view_id } = this.session_;
        if (!shown || shown_id !== view_id) return;
        const now = performance.now();
        for (const { id, rect } of this.measurements.areas_to_ask(shown, this.settled_(), now))
            this.session_.ask("rectangle", { id, rect });
    }

    /** The server keeps the driver's pins up to date. */
    tell_probes() {
        if (!this.session_.driving) return;
        const pin = ({ id, position, normal }) => ({ id, position, normal });
        this.session_.send({ type: "probes", probes: this.measurements.probes.map(pin) });
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
