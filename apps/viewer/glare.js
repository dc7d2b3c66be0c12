// Daylight glare probability of the present view, and the sources it comes from.
import { by_id, element } from "./dom.js";
import { glare_word, percent, quantity } from "./words.js";

export class Glare {
    /** @param on  {changed()} */
    constructor(on) {
        this.on_ = on;
        this.id = 0; ///< of the request under way or answered
        this.sources = []; ///< as the server sends them
        this.waiting_ = false;
    }

    /** A request was sent. */
    asked(id) {
        this.id = id;
        this.waiting_ = true;
        this.sources = [];
        by_id("glare").textContent = "Looking around…";
        by_id("clear-glare").hidden = false;
        this.on_.changed();
    }

    answer({ id, done, dgp, sources }) {
        if (id !== this.id) return;
        this.sources = sources || [];
        this.waiting_ = done < 1;
        const words = [];
        if (Number.isFinite(dgp))
            words.push(
                element("strong", { textContent: `DGP ${dgp.toFixed(2)}` }),
                glare_word(dgp),
            );
        if (this.sources.length > 0)
            words.push(` · ${this.sources.length} source${this.sources.length > 1 ? "s" : ""}`);
        if (done < 1) words.push(` · ${percent(done)}`);
        by_id("glare").replaceChildren(...words);
        by_id("glare").title = this.sources
            .map(
                (s) =>
                    `${quantity(s.luminance)} cd/m², ${quantity(s.solid_angle)} sr, position index ${quantity(s.position_index)}`,
            )
            .join("\n");
        this.on_.changed();
    }

    /** The eye moved, or nobody wants it any more: outlines belong to one view. */
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
