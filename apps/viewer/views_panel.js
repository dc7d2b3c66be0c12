// Views to go to: those of the scene, and those saved in this browser.
import { by_id, element, remove_button } from "./dom.js";

/** The least number that no name of the list ends in. */
function free_number(list) {
    return 1 + Math.max(0, ...list.map(({ name }) => Number(/^View (\d+)$/.exec(name)?.[1] || 0)));
}

export class ViewsPanel {
    /** @param on  {go(view), kept(saved)} */
    constructor(on) {
        this.on_ = on;
        this.scene_views = []; ///< {name, view} of each view of the scene
        this.saved = []; ///< {name, view} of each view that this browser has stored
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

    restore(saved) {
        const sound = ({ view }) => Array.isArray(view?.position) && Array.isArray(view?.direction);
        this.saved = saved.filter(sound);
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

    show() {
        const views = [
            ...this.scene_views.map((entry, k) => this.entry_(entry, k)),
            ...this.saved.map((entry, k) => this.saved_entry_(entry, k)),
        ];
        by_id("views").replaceChildren(...views);
        const field = by_id("views").querySelector("input");
        field?.focus();
        field?.select();
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

    kept_() {
        this.show();
        this.on_.kept(this.saved);
    }
}
