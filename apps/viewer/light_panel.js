// The panel that decides how radiance becomes colours; the state of its controls is the `display` message.
import { by_id, choose } from "./dom.js";
import { scale_problem } from "./scale.js";
import { stops } from "./words.js";

const kStep = 0.5; // change of exposure by one key press [stops]

export const default_display = () => ({
    mode: "tone",
    exposure: { auto: true, ev: 0 },
    human: false,
    clean: false,
    scale: { low: 1, high: 10000, log: true },
});

/** The value of a number as people type it, with a decimal comma or point. */
const typed = (input) => (input.value.trim() === "" ? NaN : Number(input.value.replace(",", ".")));

export class LightPanel {
    /** @param on  {display(display), settings(settings)}: called when the user has changed something */
    constructor(on) {
        this.on_ = on;
        this.display = default_display();
        this.settings = { ambient: "rest" };
        this.automatic_ev_ = 0;
        this.denoised = false; ///< whether the newest frame is
        this.listen_();
        this.show_();
    }

    /** Set the controls to the display and settings that the server has; nothing is sent. */
    take(display, settings) {
        const { mode, exposure, human, clean, scale } = { ...default_display(), ...display };
        if (display) this.display = structuredClone({ mode, exposure, human, clean, scale });
        if (settings) this.settings = { ...settings };
        this.show_();
    }

    /** Whether the server can show denoised pictures. */
    offer_clean(can) {
        by_id("clean-line").hidden = !can;
    }

    /** Note the factor that the newest frame was multiplied by: a fixed exposure starts there. */
    note_exposure(factor) {
        if (!(factor > 0)) return;
        this.automatic_ev_ = Math.log2(factor);
        if (this.display.exposure.auto) this.show_ev_();
    }

    toggle_false() {
        this.change_({ mode: this.display.mode === "false" ? "tone" : "false" });
    }

    toggle_auto() {
        const { auto } = this.display.exposure;
        this.change_({
            exposure: { auto: !auto, ev: auto ? this.present_ev : this.display.exposure.ev },
        });
    }

    /** Make the picture brighter (1) or darker (-1) by half a stop; the exposure is fixed from then on. */
    step_exposure(direction) {
        this.change_({
            exposure: { auto: false, ev: this.limited_(this.present_ev + direction * kStep) },
        });
    }

    /** The exposure of the picture [stops]. */
    get present_ev() {
        const { auto, ev } = this.display.exposure;
        return auto ? Math.round(this.automatic_ev_ * 10) / 10 : ev;
    }

    limited_(ev) {
        return Math.max(Number(by_id("ev").min), Math.min(Number(by_id("ev").max), ev));
    }

    change_(part) {
        this.display = { ...this.display, ...part };
        this.show_();
        this.on_.display(this.display);
    }

    listen_() {
        for (const input of document.getElementsByName("mode"))
            input.addEventListener("change", () => this.change_({ mode: input.value }));
        by_id("auto").addEventListener("change", () => this.toggle_auto());
        by_id("ev").addEventListener("input", (event) =>
            this.change_({ exposure: { auto: false, ev: Number(event.target.value) } }),
        );
        by_id("human").addEventListener("change", (event) =>
            this.change_({ human: event.target.checked }),
        );
        by_id("clean").addEventListener("change", (event) =>
            this.change_({ clean: event.target.checked }),
        );
        for (const input of [by_id("low"), by_id("high"), ...document.getElementsByName("steps")])
            input.addEventListener("change", () => this.read_scale_());
        for (const input of document.getElementsByName("ambient"))
            input.addEventListener("change", () => {
                this.settings = { ...this.settings, ambient: input.value };
                this.on_.settings(this.settings);
            });
    }

    /** The scale of false colours as typed; when it is not valid the panel says why, and nothing is returned. */
    read_scale_() {
        const log = document.querySelector("[name=steps]:checked").value === "log";
        const scale = { low: typed(by_id("low")), high: typed(by_id("high")), log };
        const problem = scale_problem(scale);
        this.show_problem_(problem);
        if (!problem) this.change_({ scale });
    }

    show_problem_(problem) {
        by_id("scale-problem").hidden = !problem;
        by_id("scale-problem").textContent = problem || "";
        for (const id of ["low", "high"])
            by_id(id).setAttribute("aria-invalid", String(Boolean(problem)));
    }

    show_() {
        const { mode, exposure, human, clean, scale } = this.display;
        choose("mode", mode);
        choose("steps", scale.log ? "log" : "linear");
        choose("ambient", this.settings.ambient);
        by_id("tone-controls").hidden = mode === "false";
        by_id("false-controls").hidden = mode !== "false";
        by_id("auto").checked = exposure.auto;
        by_id("human").checked = human;
        by_id("clean").checked = clean;
        by_id("low").value = scale.low;
        by_id("high").value = scale.high;
        this.show_problem_(null);
        this.show_ev_();
    }

    show_ev_() {
        const ev = this.present_ev;
        by_id("ev").value = ev;
        by_id("ev-text").textContent = `${stops(ev)} EV`;
    }
}
