// Daylight glare probability (DGP) of the present view, and the glare sources that cause it.
import { by_id, element } from "./dom.js";
import { glare_words, percent, rough, within_hundredths } from "./words.js";

export class Glare {
    /** @param on  {changed()}: called when the value or the sources are new */
    constructor(on) {
        this.on_ = on;
        this.id = 0; ///< number of the newest request, answered or not
        this.sources = []; ///< as in the server's `glare` message
        this.waiting_ = false;
    }

    /** Note that request `id` was sent. */
    asked(id) {
        this.id = id;
        this.waiting_ = true;
        this.sources = [];
        by_id("glare").textContent = "Looking around…";
        by_id("clear-glare").hidden = false;
        this.on_.changed();
    }

    answer({ id, done, dgp, dgp_95, sources }) {
        if (id !== this.id) return;
        this.sources = sources || [];
        this.waiting_ = done < 1;
        const words = [];
        if (done >= 1 && Number.isFinite(dgp)) {
            words.push(
                element("strong", { textContent: `DGP ${dgp.toFixed(2)}` }),
                [within_hundredths(dgp_95), glare_words(dgp, dgp_95)].filter(Boolean).join(" · "),
            );
        }
        if (this.sources.length > 0)
            words.push(` · ${this.sources.length} source${this.sources.length > 1 ? "s" : ""}`);
        if (done < 1) words.push(`Looking around… ${percent(done)}`);
        by_id("glare").replaceChildren(...words);
        by_id("glare").title = this.sources
            .map(
                (s) =>
                    `≈ ${rough(s.luminance)} cd/m², ${rough(s.solid_angle)} sr, position index ${rough(s.position_index)}`,
            )
            .join("\n");
        this.on_.changed();
    }

    /** Forget the answer: the outlines of sources hold for one view, and the eye has moved or the display was closed. */
    clear() {
        if (this.id === 0) return;
        this.id = 0;
        this.waiting_ = false;
        this.sources = [];
        by_id("glare").textContent = "Daylight glare probability of this view.";
        by_id("clear-glare").hidden = true;
        this.on_.changed();
    }
}
