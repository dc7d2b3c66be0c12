// The panel of dimmers: a level, a switch and a colour for each group of lamps, and presets of them.
import { by_id, element } from "./dom.js";
import { as_built, kCoolest, kHottest, lamps_of, lights_message, sound_lamp } from "./lamps.js";
import { notice } from "./notices.js";

const kOwn = kCoolest - 100; // of the slider: the colour that the scene has
const kMostPresets = 50;

const input = (properties) => element("input", properties);

export class LampPanel {
    /** @param on  {lights(message), kept(presets), may_drive(), changed()}: called when the user has changed something */
    constructor(on) {
        this.on_ = on;
        this.lamps = []; ///< [{name, on, percent, kelvin}]
        this.presets = []; ///< [{name, lamps}]
        this.touched = false; ///< whether this page has changed a lamp; else they are as the server says
        this.told_ = []; // levels of the newest message
        this.waiting_ = false; // for the screen's next refresh, to send the newest state
        by_id("lamps-reset").addEventListener("click", () =>
            this.set_(this.lamps.map(({ name }) => as_built(name))),
        );
        by_id("lamps-save").addEventListener("submit", (event) => {
            event.preventDefault();
            this.save_(by_id("lamps-name").value.trim());
        });
        by_id("lamps-preset").addEventListener("change", ({ target }) =>
            this.choose_(target.value),
        );
        by_id("lamps-forget").addEventListener("click", () => this.forget_());
    }

    /** The scene has these light groups; lamps of the same names stay as they are. */
    open(names = []) {
        const before = this.lamps;
        const own = this.touched && this.on_.may_drive();
        this.lamps = own
            ? names.map((name) => sound_lamp(name, before.find((lamp) => lamp.name === name) ?? {}))
            : lamps_of(names, this.told_);
        this.show_();
    }

    /**
     * Show another side of a comparison.
     * @param other  what was returned when it was shown last; null: nothing is known of it yet
     * @returns what was shown
     */
    swap(other) {
        if (this.waiting_) this.tell();
        const { lamps, touched, told_ } = this;
        Object.assign(this, other ?? { lamps: [], touched: false, told_: [] });
        by_id("lamps-preset").value = "";
        this.show_();
        return { lamps, touched, told_ };
    }

    /** Take what the browser has stored of the scene's presets. */
    restore(presets) {
        this.presets = presets
            .filter((one) => typeof one?.name === "string" && Array.isArray(one.lamps))
            .slice(0, kMostPresets);
        this.show_presets_("");
    }

    /** Take what the driver has set, or this page before it was loaded anew; nothing is sent. */
    take({ levels }) {
        this.told_ = levels ?? [];
        this.lamps = lamps_of(
            this.lamps.map(({ name }) => name),
            levels,
        );
        this.show_();
    }

    /** Say the server how the lamps are, if that is for this page to say. */
    tell() {
        if (this.touched && this.lamps.length > 0) this.on_.lights(lights_message(this.lamps));
    }

    /** Whether the page drives: who watches sees the dimmers, and cannot move them. */
    drive() {
        const still = !this.on_.may_drive();
        for (const control of document.querySelectorAll(
            "#panel-lamps input, #lamps-reset, #lamps-preset",
        ))
            control.disabled = still && control.id !== "lamps-name";
    }

    set_(lamps) {
        this.lamps = lamps;
        this.show_();
        this.send_();
    }

    /** One message a refresh of the screen at most. */
    send_() {
        this.touched = true;
        this.on_.changed();
        if (this.waiting_) return;
        this.waiting_ = true;
        requestAnimationFrame(() => {
            this.waiting_ = false;
            this.tell();
        });
    }

    change_(index, part) {
        this.lamps[index] = { ...this.lamps[index], ...part };
        this.show_values_(index);
        by_id("lamps-preset").value = "";
        this.send_();
    }

    show_() {
        const some = this.lamps.length > 0;
        by_id("lamps-hint").hidden = some;
        by_id("lamps-tools").hidden = !some;
        by_id("lamps").replaceChildren(...this.lamps.map((lamp, index) => this.row_(lamp, index)));
        this.lamps.forEach((_, index) => this.show_values_(index));
        this.drive();
    }

    row_({ name }, index) {
        const level = input({ type: "range", min: 0, max: 200, step: 1, className: "level" });
        const number = input({ type: "number", min: 0, max: 200, step: 1, className: "percent" });
        const power = input({ type: "checkbox", className: "switch" });
        const colour = input({
            type: "range",
            min: kOwn,
            max: kHottest,
            step: 100,
            className: "kelvin",
        });
        level.setAttribute("aria-label", `Level of ${name}`);
        number.setAttribute("aria-label", `Level of ${name} in percent`);
        colour.setAttribute("aria-label", `Colour of ${name}`);
        const percent = ({ target }) => {
            if (target.value === "" || !target.checkValidity()) return;
            this.change_(index, { percent: Number(target.value), on: true });
        };
        level.addEventListener("input", percent);
        number.addEventListener("change", percent);
        power.addEventListener("change", () => this.change_(index, { on: power.checked }));
        colour.addEventListener("input", () => {
            const kelvin = Number(colour.value);
            this.change_(index, { kelvin: kelvin < kCoolest ? null : kelvin });
        });
        return element(
            "li",
            { className: "lamp" },
            element("label", { className: "line" }, element("span", { textContent: name }), power),
            element(
                "div",
                { className: "line" },
                level,
                number,
                element("span", { className: "unit", textContent: "%" }),
            ),
            element(
                "div",
                { className: "line" },
                colour,
                element("output", { className: "colour" }),
            ),
        );
    }

    show_values_(index) {
        const { on, percent, kelvin } = this.lamps[index];
        const row = by_id("lamps").children[index];
        const shown = Math.round(percent);
        row.classList.toggle("off", !on);
        row.querySelector(".switch").checked = on;
        row.querySelector(".level").value = shown;
        row.querySelector(".percent").value = shown;
        row.querySelector(".kelvin").value = kelvin ?? kOwn;
        const words = kelvin === null ? "own colour" : `${kelvin} K`;
        row.querySelector(".kelvin").setAttribute("aria-valuetext", words);
        row.querySelector(".colour").textContent = words;
    }

    // Presets

    save_(name) {
        if (!name) return notice("Type a name for the preset first", true);
        const lamps = structuredClone(this.lamps);
        const others = this.presets.filter((one) => one.name !== name);
        if (others.length >= kMostPresets) return notice("There is no room for more presets", true);
        this.presets = [...others, { name, lamps }];
        by_id("lamps-name").value = "";
        this.on_.kept(this.presets);
        this.show_presets_(name);
        notice(`Saved as ${name}`);
    }

    choose_(name) {
        const preset = this.presets.find((one) => one.name === name);
        by_id("lamps-forget").disabled = !preset;
        if (!preset) return;
        this.set_(
            this.lamps.map((lamp) =>
                sound_lamp(
                    lamp.name,
                    preset.lamps.find((one) => one?.name === lamp.name),
                ),
            ),
        );
    }

    forget_() {
        const name = by_id("lamps-preset").value;
        this.presets = this.presets.filter((one) => one.name !== name);
        this.on_.kept(this.presets);
        this.show_presets_("");
    }

    show_presets_(chosen) {
        by_id("lamps-preset").replaceChildren(
            element("option", { value: "", textContent: "Presets…" }),
            ...this.presets.map(({ name }) =>
                element("option", { value: name, textContent: name }),
            ),
        );
        by_id("lamps-preset").value = chosen;
        by_id("lamps-forget").disabled = chosen === "";
    }
}
