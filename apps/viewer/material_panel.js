// The panel of materials: what the surface is made of that was clicked, and other numbers for it.
import { by_id, element, remove_button } from "./dom.js";
import { colour_of, Edits, number_of, problem_of, rgb_of, rows_of, words_of } from "./edits.js";
import { notice } from "./notices.js";

const kHint = "Click a surface to see what it is made of.";
const kSlides = 1; // numbers from 0 to this have a slider

const title = (layer) => `${layer.name} (${layer.kind})`;

export class MaterialPanel {
    /**
     * @param on  {ask(x, y): the request's number, edits(message): the request's number, may_drive(), indirect(): whether
     *     there is indirect light, settled(): whether all of it is there, changed()}: changed() when the user has changed something
     */
    constructor(on) {
        this.on_ = on;
        this.choosing = false; ///< the next click tells the surface
        this.edits = new Edits();
        this.touched = false; ///< whether this page has changed a material; else they are as the server says
        this.request_ = 0; // whose answer is awaited, or 0
        this.sent_ = null; // number of the newest `edits` message of this page
        this.message_ = null; // the newest answer
        this.refused_ = []; // [{name, definition, why}]
        this.problem_ = "";
        this.follows_ = false; // whether indirect light is still that of before, or missing
        this.waiting_ = false; // for the screen's next refresh, to send the newest state
        by_id("material-undo").addEventListener("click", () => this.undo());
        by_id("material-reset").addEventListener("click", () => {
            this.edits.reset();
            this.set_();
        });
        this.show_();
    }

    /** Whether the next click chooses a surface. */
    choose(wanted) {
        this.choosing = wanted;
        by_id("material-choose").setAttribute("aria-pressed", String(wanted));
        if (wanted) notice("Click a surface, or press Enter for the middle");
    }

    /** A surface is chosen by its place in the picture (0..1 from the left and the bottom). */
    choose_at(x, y) {
        this.choose(false);
        this.request_ = this.on_.ask(x, y);
    }

    /** Take the server's `material` message. */
    answer(message) {
        if (message.id !== this.request_) return;
        this.request_ = 0;
        this.message_ = message;
        this.problem_ = "";
        this.show_();
    }

    /** Take the server's `edited` message: what is changed, and what cannot be. */
    take({ id, materials, refused }) {
        const is_older = this.waiting_ || (this.sent_ !== null && id !== this.sent_);
        if (is_older && this.on_.may_drive()) return;
        this.edits.take(materials);
        this.refused_ = Array.isArray(refused) ? refused : [];
        this.follow_light(true);
        this.show_numbers_();
    }

    /**
     * Show another side of a comparison.
     * @param other  what was returned when it was shown last; null: nothing is known of it yet
     * @returns what was shown
     */
    swap(other) {
        if (this.waiting_) this.tell();
        this.choose(false);
        const { edits, touched, sent_, message_, refused_, problem_, follows_ } = this;
        const unknown = { touched: false, sent_: null, message_: null, refused_: [], problem_: "" };
        Object.assign(this, other ?? { ...unknown, edits: new Edits(), follows_: false });
        this.request_ = 0;
        this.show_();
        return { edits, touched, sent_, message_, refused_, problem_, follows_ };
    }

    /** The scene is read again: numbers may be others. */
    outdate() {
        this.message_ = null;
        this.show_();
    }

    /** Another scene. */
    forget() {
        this.edits.forget();
        this.touched = false;
        this.refused_ = [];
        this.outdate();
    }

    /** Say the server what is changed, if that is for this page to say. */
    tell() {
        if (!this.touched || !this.on_.may_drive()) return;
        this.sent_ = this.on_.edits({ materials: this.edits.list });
    }

    /** Whether the page drives: who watches sees materials, and cannot change them. */
    drive() {
        const still = !this.on_.may_drive();
        for (const control of document.querySelectorAll("#panel-materials fieldset"))
            control.disabled = still || control.classList.contains("fixed");
        by_id("material-undo").disabled = still || !this.edits.can_undo;
        by_id("material-reset").disabled = still || this.edits.list.length === 0;
        for (const button of document.querySelectorAll("#material-edits button"))
            button.disabled = still;
    }

    /** @param begins  whether light has just become another one */
    follow_light(begins = false) {
        const follows = this.on_.indirect() && (begins || (this.follows_ && !this.on_.settled()));
        if (follows === this.follows_) return;
        this.follows_ = follows;
        this.say_();
    }

    undo() {
        if (!this.on_.may_drive() || !this.edits.can_undo) return;
        this.edits.undo();
        this.set_();
    }

    // What the user changes

    set_() {
        this.problem_ = "";
        this.send_();
        this.show_();
    }

    /** One message a refresh of the screen at most. What was refused before is over: call it before what is shown. */
    send_() {
        this.touched = true;
        this.refused_ = [];
        this.on_.changed();
        if (this.waiting_) return;
        this.waiting_ = true;
        requestAnimationFrame(() => {
            this.waiting_ = false;
            this.tell();
        });
    }

    change_(layer, index, value, box) {
        this.problem_ = problem_of(layer.names[index], value);
        box.setAttribute("aria-invalid", String(this.problem_ !== ""));
        if (this.problem_) return this.say_();
        if (!this.edits.change(layer, index, value, performance.now()))
            return notice("There is no room for more changed materials", true);
        this.changed_(layer);
    }

    paint_(layer, indices, colour) {
        const reals = [...this.edits.reals_of(layer)];
        rgb_of(colour).forEach((value, k) => (reals[indices[k]] = value));
        const key = `${layer.name} ${layer.definition} colour`;
        if (!this.edits.set(layer, reals, key, performance.now()))
            return notice("There is no room for more changed materials", true);
        this.changed_(layer);
    }

    changed_(layer) {
        this.problem_ = "";
        this.send_();
        this.show_values_(layer);
        this.show_edits_();
        this.say_();
    }

    // What is shown

    show_() {
        const layers = this.message_?.layers ?? [];
        by_id("material-layers").replaceChildren(...layers.map((one, k) => this.layer_(one, k)));
        this.show_numbers_();
    }

    show_numbers_() {
        for (const layer of this.message_?.layers ?? []) this.show_values_(layer);
        this.show_edits_();
        this.say_();
    }

    say_() {
        const text = by_id("material-text");
        const words = this.words_();
        if (text.textContent !== words) text.textContent = words;
        const problem = this.problem_ || this.refused_.map((one) => this.refusal_(one)).join(" ");
        const box = by_id("material-problem");
        if (box.textContent !== problem) box.textContent = problem;
        box.hidden = problem === "";
        by_id("material-light").hidden = !this.follows_;
    }

    refusal_({ name, why }) {
        return `${name} is not changed: ${why}.`;
    }

    words_() {
        if (!this.message_) return kHint;
        if (!this.message_.hit) return "No surface there: sky or void.";
        const { surface, layers } = this.message_;
        if (layers.length === 0) return `${surface || "The surface"} has no material.`;
        return `${surface || "A surface"} is made of ${title(layers[0])}.`;
    }

    layer_(layer, number) {
        const about = [`modified by ${layer.modifier}`, ...layer.strings].join(" · ");
        const head = [
            element("h3", { textContent: layer.name }),
            element("p", { className: "kind", textContent: `${layer.kind} · ${about}` }),
        ];
        if (layer.where) head.push(element("p", { className: "hint", textContent: layer.where }));
        if (layer.fixed) head.push(element("p", { className: "hint", textContent: layer.fixed }));
        const made = element("li", { className: "layer" }, ...head);
        if (layer.names.length === 0) return made;
        const fields = element("fieldset", { className: layer.fixed ? "fixed" : "" });
        fields.append(element("legend", { className: "unseen", textContent: title(layer) }));
        for (const row of rows_of(layer.names)) fields.append(this.row_(layer, row, number));
        made.append(fields);
        return made;
    }

    row_(layer, { quantity, indices, colour }, number) {
        const { unit } = layer.names[indices[0]];
        const row = element("div", { className: "argument" });
        const id = `material-${number}-${indices[0]}`;
        const words = unit ? `${quantity} [${unit}]` : quantity;
        row.append(element("span", { id, className: "quantity", textContent: words }));
        const line = element("div", { className: "line" });
        if (colour) line.append(this.colour_(layer, quantity, indices));
        else if (indices.length === 1 && this.slides_(layer.names[indices[0]]))
            line.append(this.slider_(layer, indices[0]));
        line.append(...indices.map((index) => this.box_(layer, index)));
        row.append(line);
        return row;
    }

    slides_({ low, high }) {
        return low >= 0 && high <= kSlides;
    }

    /** The controls of one layer and argument are found by these. */
    mark_(control, layer, index, what) {
        Object.assign(control.dataset, { material: layer.name, definition: layer.definition });
        control.dataset[what] = index;
        return control;
    }

    box_(layer, index) {
        const name = words_of(layer.names[index]);
        const box = element("input", { type: "text", inputMode: "decimal", autocomplete: "off" });
        box.spellcheck = false;
        box.setAttribute("aria-label", `${layer.name}: ${name}`);
        box.setAttribute("aria-describedby", "material-problem");
        // An answer that comes meanwhile leaves alone what is being typed.
        box.addEventListener("input", () => (box.dataset.typed = ""));
        box.addEventListener("change", () => {
            delete box.dataset.typed;
            this.change_(layer, index, number_of(box.value), box);
        });
        box.addEventListener("blur", () => {
            if (box.dataset.typed === undefined) return;
            delete box.dataset.typed;
            this.show_values_(layer);
        });
        return this.mark_(box, layer, index, "number");
    }

    slider_(layer, index) {
        const { low, high } = layer.names[index];
        const slider = element("input", { type: "range", min: low, max: high, step: 0.001 });
        slider.setAttribute("aria-label", `${layer.name}: ${words_of(layer.names[index])}, slider`);
        slider.addEventListener("input", () =>
            this.change_(layer, index, Number(slider.value), slider),
        );
        return this.mark_(slider, layer, index, "slider");
    }

    colour_(layer, quantity, indices) {
        const colour = element("input", { type: "color" });
        colour.setAttribute("aria-label", `${layer.name}: colour of the ${quantity}`);
        colour.addEventListener("input", () => this.paint_(layer, indices, colour.value));
        return this.mark_(colour, layer, indices[0], "colour");
    }

    /** Put a layer's numbers into its controls, but for one that is typed in. */
    show_values_(layer) {
        const reals = layer.fixed ? layer.reals : this.edits.reals_of(layer);
        const own = (control) =>
            control.dataset.material === layer.name &&
            Number(control.dataset.definition) === layer.definition &&
            control.closest("fieldset").classList.contains("fixed") === (layer.fixed !== "");
        for (const control of document.querySelectorAll("#material-layers input")) {
            if (!own(control) || control.dataset.typed !== undefined) continue;
            const { number, slider, colour } = control.dataset;
            if (number !== undefined) {
                control.value = String(Number(reals[number].toPrecision(6)));
                control.setAttribute("aria-invalid", "false");
            } else if (slider !== undefined) control.value = reals[slider];
            else control.value = colour_of(reals.slice(Number(colour), Number(colour) + 3));
        }
    }

    show_edits_() {
        const { list } = this.edits;
        by_id("material-edits").replaceChildren(
            ...list.map((one) =>
                element(
                    "li",
                    {},
                    element("span", { textContent: title(one) }),
                    remove_button(`the changes of ${one.name}`, () => {
                        this.edits.reset(one);
                        this.set_();
                    }),
                ),
            ),
        );
        by_id("material-changed").hidden = list.length === 0;
        by_id("write-materials").disabled = list.length === 0;
        this.drive();
    }
}
