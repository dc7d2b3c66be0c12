// Views to go to: those of the scene, those saved in this browser, and the keys of a path.
import { by_id, element, remove_button } from "./dom.js";
import { round_number } from "./words.js";

const kBetween = 2; // time between two keys of a path [s]

/** The least number that no name of the list ends in. */
function free_number(list) {
    return 1 + Math.max(0, ...list.map(({ name }) => Number(/^View (\d+)$/.exec(name)?.[1] || 0)));
}

export class ViewsPanel {
    /** @param on  {go(view), kept(saved), keys_changed(keys)} */
    constructor(on) {
        this.on_ = on;
        this.scene_views = []; ///< {name, view} of each view of the scene
        this.saved = []; ///< {name, view} of each view that this browser has stored
        this.keys = []; ///< {time, view} of each key of the path
        this.naming_ = -1; // index of the saved view whose name is being typed, or -1
    }

    /** View number k = 0, 1, ..., counted through the scene's views and then the saved ones. */
    at(k) {
        return [...this.scene_views, ...this.saved][k];
    }

    set_scene_views(views) {
        this.scene_views = views;
        this.show();
    }

    restore(saved, keys) {
        const sound = ({ view }) => Array.isArray(view?.position) && Array.isArray(view?.direction);
        this.saved = saved.filter(sound);
        this.keys = keys.filter(sound);
        this.show();
    }

    /** Save a view; `naming`: let the user type its name. Returns the name. */
    save(view, name, naming = false) {
        const given = name || `View ${free_number(this.saved)}`;
        this.saved.push({ name: given, view });
        if (naming) this.naming_ = this.saved.length - 1;
        this.kept_();
        return given;
    }

    add_key(view) {
        const time = this.keys.length === 0 ? 0 : this.keys.at(-1).time + kBetween;
        this.keys.push({ time, view });
        this.keys_changed_();
        return this.keys.length;
    }

    clear_keys() {
        this.keys = [];
        this.keys_changed_();
    }

    show() {
        const views = [
            ...this.scene_views.map((entry, k) => this.entry_(entry, k)),
            ...this.saved.map((entry, k) => this.saved_entry_(entry, k)),
        ];
        by_id("views").replaceChildren(...views);
        const field = by_id("views").querySelector("input");
        field?.focus();
        field?.select();
        by_id("keys").replaceChildren(...this.keys.map((key, k) => this.key_entry_(key, k)));
        by_id("clear-path").disabled = this.keys.length === 0;
        // A path needs two keys.
        for (const id of ["write-path", "write-path-too"])
            by_id(id).disabled = this.keys.length < 2;
    }

    entry_({ name, view }, k) {
        const number = k < 9 ? String(k + 1) : "";
        const button = element(
            "button",
            { type: "button", className: "go", onclick: () => this.on_.go(view) },
            element("b", { textContent: number }),
            element("span", { textContent: name }),
        );
        return element("li", {}, button);
    }

    saved_entry_(entry, k) {
        const line =
            this.naming_ === k
                ? this.name_field_(entry)
                : this.entry_(entry, this.scene_views.length + k);
        line.ondblclick = () => {
            this.naming_ = k;
            this.show();
        };
        line.title = "Double-click to rename";
        line.append(
            remove_button(entry.name, () => {
                this.saved.splice(k, 1);
                this.kept_();
            }),
        );
        return line;
    }

    name_field_(entry) {
        const field = element("input", { type: "text", value: entry.name, maxLength: 80 });
        field.setAttribute("aria-label", "Name of the view");
        const done = (name) => {
            if (this.naming_ < 0) return;
            this.naming_ = -1;
            entry.name = name.trim() || entry.name;
            this.kept_();
        };
        field.onblur = () => done(field.value);
        field.onkeydown = (event) => {
            if (event.key === "Enter") done(field.value);
            if (event.key === "Escape") done(entry.name);
            event.stopPropagation();
        };
        return element("li", {}, field);
    }

    key_entry_({ time, view }, k) {
        const button = element(
            "button",
            { type: "button", className: "go", onclick: () => this.on_.go(view) },
            element("b", { textContent: `${round_number(time)} s` }),
            element("span", { textContent: `Key ${k + 1}` }),
        );
        return element(
            "li",
            {},
            button,
            remove_button(`key ${k + 1}`, () => {
                this.keys.splice(k, 1);
                this.keys_changed_();
            }),
        );
    }

    kept_() {
        this.show();
        this.on_.kept(this.saved);
    }

    keys_changed_() {
        this.show();
        this.on_.keys_changed(this.keys);
    }
}
