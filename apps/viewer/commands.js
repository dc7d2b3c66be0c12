// What buttons and keys do, each named once.
import { caption_lines, kDenoised } from "./caption.js";
import { token_query } from "./connection.js";
import { by_id } from "./dom.js";
import { levelled, view_at_pick } from "./go_there.js";
import { toggle_full_screen } from "./full_screen.js";
import { notice } from "./notices.js";
import { close_panel, is_open, toggle_help, toggle_panel, toggle_status } from "./panels.js";
import {
    download,
    download_text,
    file_name,
    full_picture,
    picture_blob,
    server_file,
} from "./save.js";
import { film_command } from "./path.js";
import { listen_for_shortcuts } from "./shortcuts.js";
import { measurement_table } from "./table.js";
import { view_problem } from "./view.js";
import { parse_views, path_text, view_line } from "./view_text.js";

/** Whether the system asks for reduced motion: the eye then goes to another view at once, without a transition. */
const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

class Commands {
    /** @param page  the parts of the page, and functions home() and scene() for the present home view and scene name */
    constructor(page) {
        Object.assign(this, page);
        this.area_wanted = false;
        this.walk_shown_ = true;
        this.chosen = () => {}; ///< called when the eye goes to a view that was chosen
    }

    // Places

    /** Go to a view; `chosen`: it becomes an entry of the browser's history. */
    go(view, chosen = true) {
        if (!view || !this.session.driving) return;
        const problem = view_problem(view);
        if (problem) return notice(`The view cannot be drawn: ${problem}`, true);
        if (chosen) this.chosen();
        this.navigator.jump(view, performance.now(), still() ? 0 : undefined);
        this.show_back_();
    }

    /** Go to the floor, or near the wall, that the picture shows at x, y (0..1 from the left and the bottom). */
    go_to_point(x, y) {
        if (!this.session.driving) return;
        this.measuring.reading.close();
        this.measuring.point_at(x, y, (pick) => {
            const { view, eye_height } = this.navigator;
            const there = view_at_pick(view, pick, eye_height);
            if (there) this.go(there);
            else notice("No surface there: sky or void");
        });
    }

    look_level() {
        if (this.navigator.view) this.go(levelled(this.navigator.view), false);
    }

    back() {
        if (!this.session.driving) return;
        if (!this.navigator.undo(performance.now(), still() ? 0 : undefined))
            notice("No jump to undo");
        this.show_back_();
    }

    show_back_() {
        by_id("go-back").disabled = !this.navigator.can_undo;
    }

    toggle_walk() {
        if (!this.session.driving) return;
        this.navigator.set_walk(!this.navigator.walk);
        this.show_walk();
    }

    /** Show on the button whether the eye walks or flies; keys change that as well. */
    show_walk() {
        const { walk } = this.navigator;
        if (walk === this.walk_shown_) return;
        this.walk_shown_ = walk;
        const button = by_id("walk");
        button.setAttribute("aria-pressed", String(walk));
        button.querySelector("use").setAttribute("href", walk ? "#i-walk" : "#i-fly");
        button.querySelector("span").textContent = walk ? "Walk" : "Fly";
        notice(walk ? "Walking: the eye keeps its height" : "Flying: E and Q rise and sink");
    }

    /** The present view, its horizontal and vertical sizes fitted to the window. */
    present_view() {
        const { shown, frame_view, shown_id, view_id, view } = this.session;
        return ((shown !== frame_view || shown_id === view_id) && shown) || view;
    }

    save_view(naming) {
        const view = this.present_view();
        if (!view) return;
        const name = this.views.save(view, undefined, naming);
        if (!naming) notice(`Saved as ${name}`);
    }

    add_key() {
        const view = this.present_view();
        if (view) notice(`Key ${this.path.add_key(view)}`);
    }

    async open_views(file) {
        try {
            const views = parse_views(await file.text());
            const name = file.name.replace(/\.[^.]*$/, "");
            views.forEach((view, k) =>
                this.views.save(view, views.length > 1 ? `${name} ${k + 1}` : name),
            );
            this.go(views[0]);
        } catch (error) {
            notice(`${file.name}: ${error.message}`, true);
        }
    }

    // Light that changes

    /** Glare is another one in other light: it is asked for again once dimmers and time rest. */
    follow_light(why) {
        if (this.comparison.side === "B") return; // these are of the walk
        clearTimeout(this.light_rests_);
        this.light_rests_ = setTimeout(() => {
            if (this.glare.id !== 0) this.ask_glare();
            this.isolux.outdate(why);
        }, 300);
    }

    /** A file of the side that the panels show. */
    side_file_(name) {
        return server_file(`${this.comparison.folder}${name}`, token_query(location.href));
    }

    async write_sky() {
        try {
            if (this.session.driving) this.time.tell();
            download(await this.side_file_("sky.rad"), this.name_("sky.rad"));
        } catch (error) {
            notice(`No file of the sky: ${error.message}`, true);
        }
    }

    async write_lamps() {
        try {
            const { driving } = this.session;
            if (driving) this.lamps.tell();
            const text = await this.side_file_("lights.rad");
            download(text, this.name_("lights.rad"));
        } catch (error) {
            notice(`No file of lamps: ${error.message}`, true);
        }
    }

    async write_materials() {
        try {
            if (this.session.driving) this.materials.tell();
            const text = await this.side_file_("materials.rad");
            download(text, this.name_("materials.rad"));
        } catch (error) {
            notice(`No file of materials: ${error.message}`, true);
        }
    }

    // Light

    want_area(wanted) {
        this.area_wanted = wanted;
        by_id("area").setAttribute("aria-pressed", String(wanted));
        if (wanted) notice("Drag over the area");
    }

    /** Read the light at x, y (0..1 from the left and the bottom), or choose the surface there for isolux or its material. */
    point(x, y) {
        if (this.materials.choosing) {
            if (this.comparison.open) this.comparison.choose(this.comparison.side_at(x));
            this.materials.choose_at(x, y);
            if (!is_open("materials")) toggle_panel("materials");
            return;
        }
        if (!this.isolux.choosing) return this.measuring.pick_at(x, y);
        this.isolux.choose_at(x, y);
        if (!is_open("measure")) toggle_panel("measure");
    }

    ask_glare() {
        if (!this.session.view) return;
        this.glare.view = this.present_view();
        this.glare.asked(this.session.ask("glare"));
    }

    // Files

    name_(kind) {
        return file_name(this.scene(), kind);
    }

    /** The lines under pictures, where they are wanted. */
    caption_() {
        const { display, present_ev, denoised } = this.light;
        const clean = denoised ? [kDenoised] : [];
        if (!by_id("caption").checked) return clean;
        const view = this.present_view();
        return [...caption_lines(this.scene(), view, display, present_ev, new Date()), ...clean];
    }

    async write_png() {
        try {
            const { display } = this.light;
            const picture = await picture_blob(this.painted(), display, this.caption_());
            download(picture, this.name_("png"));
        } catch (error) {
            notice(`No picture: ${error.message}`, true);
        }
    }

    async write_hdr() {
        const button = by_id("write-hdr");
        button.disabled = true;
        notice("Drawing in full quality…");
        try {
            download(await full_picture(token_query(location.href)), this.name_("hdr"));
            notice("Saved");
        } catch (error) {
            notice(`No picture: ${error.message}`, true);
        } finally {
            button.disabled = false;
        }
    }

    write_view() {
        const view = this.present_view();
        if (view) download_text(view_line(view), this.name_("vf"));
    }

    write_path() {
        const name = this.name_("path.vf");
        download_text(path_text(this.path.keys), name);
        this.path.tell_film(film_command(name, this.scene()));
    }

    write_table() {
        const { probes, areas } = this.measuring.measurements;
        const settings = { ambient: this.light.settings.ambient, scene: this.scene() };
        download_text(measurement_table(probes, areas, settings), this.name_("csv"));
    }

    write_isolux() {
        const time = new Date().toISOString().replace(/\.\d+/, "");
        const settings = { scene: this.scene(), time };
        download_text(this.isolux.table(settings), this.name_("isolux.csv"));
    }

    write_points() {
        const name = this.name_("pts");
        download_text(this.isolux.points(), name);
        this.isolux.tell_command(name, this.scene());
    }

    /** Choose a surface, for its material or for isolux: one of these. */
    choose_material(wanted) {
        if (wanted) this.isolux.choose(false);
        this.materials.choose(wanted);
    }

    choose_isolux(wanted) {
        if (wanted) this.materials.choose(false);
        this.isolux.choose(wanted);
    }

    /** Cancel one thing: the choice of an area or a surface, else the reading, else the open panel, else the display of glare. */
    escape() {
        if (this.area_wanted) this.want_area(false);
        else if (this.isolux.choosing) this.isolux.choose(false);
        else if (this.materials.choosing) this.materials.choose(false);
        else if (!this.measuring.reading.close() && !close_panel()) this.glare.clear();
        this.picture.focus({ preventScroll: true });
    }
}

/** What each button does, by its element id. */
function listen_for_buttons(commands) {
    const { measuring, isolux, glare } = commands;
    const buttons = {
        "save-view": () => commands.save_view(true),
        "go-home": () => commands.go(commands.home()),
        "go-back": () => commands.back(),
        "open-views": () => by_id("views-file").click(),
        "write-view": () => commands.write_view(),
        "write-view-too": () => commands.write_view(),
        "add-key": () => commands.add_key(),
        "write-path": () => commands.write_path(),
        "write-path-too": () => commands.write_path(),
        "write-table": () => commands.write_table(),
        "write-table-too": () => commands.write_table(),
        "clear-table": () => measuring.measurements.clear(),
        "isolux-surface": () => commands.choose_isolux(!isolux.choosing),
        "isolux-floor": () => isolux.above_floor(),
        "write-isolux": () => commands.write_isolux(),
        "write-points": () => commands.write_points(),
        "clear-isolux": () => isolux.clear(),
        "write-lamps": () => commands.write_lamps(),
        "material-choose": () => commands.choose_material(!commands.materials.choosing),
        "write-materials": () => commands.write_materials(),
        "write-sky": () => commands.write_sky(),
        "write-png": () => commands.write_png(),
        "write-hdr": () => commands.write_hdr(),
        "ask-glare": () => commands.ask_glare(),
        "clear-glare": () => glare.clear(),
        area: () => commands.want_area(!commands.area_wanted),
        walk: () => commands.toggle_walk(),
        level: () => commands.look_level(),
        "show-status": toggle_status,
    };
    for (const [id, act] of Object.entries(buttons))
        by_id(id).addEventListener("click", () => act());
    by_id("isolux-height").addEventListener("keydown", (event) => {
        if (event.key === "Enter") isolux.above_floor();
    });
    by_id("views-file").addEventListener("change", (event) => {
        if (event.target.files[0]) commands.open_views(event.target.files[0]);
        event.target.value = "";
    });
}

function keys_of(commands) {
    const { lamps, light, time, views, measuring } = commands;
    const drive = (act) => () => commands.session.driving && act();
    const middle = () => commands.point(0.5, 0.5);
    const keys = {
        "?": toggle_help,
        h: () => commands.go(commands.home()),
        g: () => commands.toggle_walk(),
        t: () => commands.look_level(),
        z: toggle_full_screen,
        Backspace: () => commands.back(),
        b: () => commands.save_view(false),
        k: () => commands.add_key(),
        j: () => commands.path.toggle_record(),
        o: () => commands.path.toggle_play(),
        p: () => measuring.reading.pin(),
        r: () => commands.want_area(!commands.area_wanted),
        c: () => commands.choose_isolux(!commands.isolux.choosing),
        y: () => commands.choose_material(!commands.materials.choosing),
        f: drive(() => light.toggle_false()),
        x: drive(() => light.toggle_auto()),
        "-": drive(() => light.step_exposure(-1)),
        _: drive(() => light.step_exposure(-1)),
        "+": drive(() => light.step_exposure(1)),
        "=": drive(() => light.step_exposure(1)),
        l: () => toggle_panel("light"),
        v: () => toggle_panel("views"),
        m: () => toggle_panel("measure"),
        n: () => toggle_panel("plan"),
        u: () => lamps.lamps.length > 0 && toggle_panel("lamps"),
        0: () => time.file && toggle_panel("time"),
        ".": () => commands.comparison.toggle(),
        ",": () => commands.comparison.show_difference(!commands.comparison.shows_difference),
        i: toggle_status,
        Enter: middle,
        " ": middle,
        Escape: () => commands.escape(),
    };
    for (let k = 0; k < 9; ++k) keys[k + 1] = () => commands.go(views.at(k)?.view);
    return keys;
}

/** Make buttons and keys work. */
export function start_commands(page) {
    const commands = new Commands(page);
    listen_for_buttons(commands);
    listen_for_shortcuts(keys_of(commands), page.picture);
    return commands;
}
