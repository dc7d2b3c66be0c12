// The measurements that are kept: pins on surfaces and means over areas. Data only: does not use the document.
import { same_picture } from "./view.js";

const kMostProbes = 64; // the server keeps no more pins up to date
const kAskAgain = 1000; // time between two requests for a mean while the picture is being refined [ms]

const next_name = (letter, list) =>
    letter + (1 + Math.max(0, ...list.map(({ name }) => Number(name.slice(1)) || 0)));

/** Of an answer of the server the values: luminance [cd/m²], illuminance [lx], each with its half of a 95 % interval. */
const values_of = ({ illuminance, illuminance_95, luminance, luminance_95 }) => ({
    illuminance,
    illuminance_95,
    luminance,
    luminance_95,
});

export class Measurements {
    /** @param changed  called after each change; its argument says whether pins were added or removed */
    constructor(changed) {
        this.changed_ = changed;
        this.probes = []; ///< {id, name, position, normal, material, surface, settled, time, and values}
        this.last_id_ = 0; // ids are never reused, as answers to a removed one may still arrive
        this.areas = []; ///< {id, name, rect, view, pixels, settled, time, and values}
    }

    get count() {
        return this.probes.length + this.areas.length;
    }

    /** Restore what the browser stored on an earlier visit; entries that are not valid are left out. */
    restore({ probes = [], areas = [] }) {
        const triple = (v) => Array.isArray(v) && v.length === 3 && v.every(Number.isFinite);
        this.probes = probes
            .filter((p) => triple(p.position) && triple(p.normal))
            .slice(0, kMostProbes);
        this.areas = areas.filter((a) => Array.isArray(a.rect) && triple(a.view?.position));
        for (const area of this.areas) area.asked = 0;
        this.last_id_ = Math.max(0, ...[...this.probes, ...this.areas].map(({ id }) => id || 0));
        this.changed_(true);
    }

    /** Add a pin where a pick hit a surface. Returns the new probe, or nothing when there are too many. */
    pin(pick, time) {
        if (this.probes.length >= kMostProbes) return null;
        const { position, normal, material, surface } = pick;
        const probe = {
            id: ++this.last_id_,
            name: next_name("P", this.probes),
            position,
            normal,
            material,
            surface,
            ...values_of(pick),
            settled: 0,
            time,
        };
        this.probes.push(probe);
        this.changed_(true);
        return probe;
    }

    /** Add an area of a view; `id` is the number of the request for its mean. */
    add_area(rect, view) {
        const area = {
            id: ++this.last_id_,
            name: next_name("A", this.areas),
            rect,
            view,
            luminance: null,
            pixels: 0,
            settled: 0,
            time: "",
        };
        this.areas.push(area);
        this.changed_(false);
        return area;
    }

    remove(id) {
        const pins = this.probes.length;
        this.probes = this.probes.filter((probe) => probe.id !== id);
        this.areas = this.areas.filter((area) => area.id !== id);
        this.changed_(this.probes.length !== pins);
    }

    clear() {
        this.probes = [];
        this.areas = [];
        this.changed_(true);
    }

    /** Take over the server's newest values of all pins. */
    update_probes({ probes, settled }, time) {
        for (const answer of probes) {
            const probe = this.probes.find((p) => p.id === answer.id);
            if (probe) Object.assign(probe, values_of(answer), { settled, time });
        }
        this.changed_(false);
    }

    /** Take over the server's answer for an area; false when there is no such area. */
    update_area({ id, luminance, luminance_95, pixels }, settled, time) {
        const area = this.areas.find((a) => a.id === id);
        if (!area) return false;
        Object.assign(area, { luminance, luminance_95, pixels, settled, time });
        this.changed_(false);
        return true;
    }

    /** The areas drawn in the present view whose means are to be requested again. */
    areas_to_ask(view, share, now) {
        return this.areas.filter((area) => {
            if (area.settled >= 1 || !same_picture(area.view, view)) return false;
            if (share < 1 && now - (area.asked || 0) < kAskAgain) return false;
            if (share >= 1 && now - (area.asked || 0) < kAskAgain / 4) return false;
            area.asked = now;
            return true;
        });
    }
}
