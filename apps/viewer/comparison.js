// Two states of a scene side by side, A | B: the walk, and what the server draws beside it from the same eye.
import { Camera } from "./camera.js";
import { by_id, choose, element } from "./dom.js";
import { Divider } from "./divider.js";
import { show_difference_legend } from "./legend.js";
import { notice } from "./notices.js";
import { Screen } from "./screen.js";
import { Session } from "./session.js";
import { session_id } from "./store.js";
import { clock_text } from "./time.js";

const kTries = 6; // in a row to reach the server, where the walk itself does
const kPanelTypes = ["material", "edited", "lights", "time", "probes", "state"];

const canvas_of = (id) => {
    const canvas = element("canvas", { id, className: "beside", hidden: true });
    canvas.setAttribute("aria-hidden", "true");
    return canvas;
};

/** What there is of side B while somebody compares. */
class Beside {
    /** @param on  of Session, and drawn() */
    constructor(plain, refine, on) {
        this.picture = canvas_of("picture-b");
        this.canvas = canvas_of("camera-b");
        by_id("camera").after(this.picture, this.canvas);
        this.frames = 0;
        this.final = this.at_rest = false;
        this.state = {};
        this.screen = new Screen(this.picture, {
            drawn: (frame, depth, told) => {
                this.session.drawn(frame, told);
                this.camera.take(this.session.frame_view, depth);
                this.picture.hidden = false;
                ++this.frames;
                Object.assign(this, { final: frame.final, at_rest: frame.at_rest });
                on.drawn();
            },
            skipped: (frame) => this.session.skipped(frame),
            failed: (error, frame) => {
                console.warn("lightwalk:", error);
                if (frame) this.session.skipped(frame);
            },
        });
        this.camera = new Camera(this.canvas, this.picture, !plain, refine);
        this.session = new Session(session_id(), this.camera.available, this.screen, on, true);
    }

    end() {
        this.session.connection.close();
        this.screen.end();
        this.camera.end();
        this.picture.remove();
        this.canvas.remove();
    }
}

export class Comparison {
    /**
     * @param page  {session, sides, counters, panels: [those with swap()], plain, refine: as main has them, display():
     *     {number, display}, picked(message), changed(): something is to be drawn again, switched(): the panels show the other side}
     */
    constructor(page) {
        Object.assign(this, page);
        this.place = null; ///< `beside` of the server's `loaded`
        this.beside_ = null; // null: nothing is compared
        this.difference_ = false;
        this.kept_ = this.panels.map(() => null); // what the panels do not show
        this.told_ = new Map(); // the newest messages about B's state, by type
        this.tries_ = 0;
        this.divider = new Divider(() => this.changed());
        for (const button of document.querySelectorAll("button.compare, #end-compare"))
            button.addEventListener("click", () => this.toggle());
        by_id("difference").addEventListener("click", () =>
            this.show_difference(!this.difference_),
        );
        for (const input of document.getElementsByName("side"))
            input.addEventListener("change", () => this.choose(input.value));
    }

    get open() {
        return this.beside_ !== null;
    }

    /** That the panels show. */
    get side() {
        return this.sides.shown;
    }

    /** The session of the side that the panels show. */
    get panel_session() {
        return this.sides.shown === "B" ? this.beside_.session : this.session;
    }

    /** The server's newest `state` of that side. */
    get panel_state() {
        return this.sides.shown === "B" ? this.beside_.state : this.counters.state;
    }

    /** Where files of that side are. */
    get folder() {
        return this.sides.shown === "B" ? "beside/" : "";
    }

    /** Whose picture is at x, 0..1 from the left. */
    side_at(x) {
        return this.beside_?.frames > 0 && x > this.divider.at ? "B" : "A";
    }

    session_at(x) {
        return this.side_at(x) === "B" ? this.beside_.session : this.session;
    }

    /** Luminance of the picture at x, see Screen; null where the picture is not a frame. */
    luminance_at(x, of_a) {
        if (this.side_at(x) === "A") return of_a;
        return this.beside_.camera.draws ? null : this.beside_.screen.luminance;
    }

    get shows_difference() {
        return this.open && this.difference_;
    }

    toggle() {
        if (this.open) this.end();
        else this.start();
    }

    start() {
        const { refused } = this.place ?? {};
        if (refused) return notice(`There is nothing to compare: ${refused}`, true);
        if (!this.place || !this.session.driving) return notice("Who drives compares", true);
        this.told_.clear();
        this.sides.forget("B");
        this.tries_ = 0;
        this.beside_ = new Beside(this.plain, this.refine, {
            ...this.sides.handlers(
                "B",
                kPanelTypes.filter((type) => type !== "state"),
            ),
            drawn: () => {
                this.tries_ = 0;
                this.say_();
                this.changed();
            },
            connected: () => {},
            lost: (reason) => this.lost_(reason),
            loading: ({ text }) => (by_id("side-b").textContent = `B · ${text}…`),
            loaded: (message) => {
                this.sides.take("B", message);
                for (const told of this.told_.values()) this.beside_.session.send(told);
            },
            failed: ({ messages }) => this.end(messages.join(" ")),
            state: (message) => {
                this.beside_.state = message;
                this.sides.take("B", message);
                this.say_();
            },
            view: (message) => this.beside_.session.watch(message),
            picked: (message) => this.picked(message),
            refused: ({ text }) => notice(text, true),
        });
        const { number, display } = this.display();
        this.beside_.screen.want(number, display);
        this.show_(true);
        this.say_();
        notice("Panels change B; the walk is A");
        this.choose("B");
    }

    /** @param why  it ends, where nobody has asked for it */
    end(why = "") {
        if (!this.open) return;
        this.choose("A");
        this.show_difference(false);
        this.beside_.end();
        this.beside_ = null;
        this.kept_ = this.panels.map(() => null);
        this.show_(false);
        if (why) notice(`The comparison ends: ${why}`, true);
        this.changed();
    }

    lost_(reason) {
        if (!this.session.connection.connected || ++this.tries_ < kTries) return;
        setTimeout(() => this.end(reason || "the server does not answer"));
    }

    /** The panels show a side from now on. */
    choose(side) {
        choose("side", side);
        if (side === this.sides.shown || !this.open) return;
        const before = this.panels.map((panel, k) => panel.swap(this.kept_[k]));
        this.kept_ = before;
        document.body.dataset.side = side;
        this.sides.show(side);
        this.switched();
        this.say_();
    }

    /** Send what the panels say. */
    send(message) {
        this.sides.note(this.sides.shown, message);
        if (this.sides.shown === "B") this.told_.set(message.type, message);
        this.say_();
        return this.panel_session.send(message);
    }

    ask(type, fields) {
        const session = this.panel_session;
        if (this.sides.shown === "B" && type === "edits")
            this.told_.set(type, { ...fields, type, id: 0 });
        return session.ask(type, fields);
    }

    show_difference(shown) {
        if (!this.open || shown === this.difference_) return;
        this.difference_ = shown;
        by_id("difference").setAttribute("aria-pressed", String(shown));
        const message = { type: "difference", shown };
        this.told_.set(message.type, message);
        this.beside_.session.send(message);
        this.beside_.camera.forget();
        show_difference_legend(shown);
        const { number, display } = this.display();
        if (!shown) this.want(number, display);
    }

    /** The colours of the pictures are others. */
    want(number, display) {
        if (!this.open || this.difference_) return;
        if (this.beside_.screen.want(number, display)) this.beside_.camera.recoloured();
    }

    /** Draw what B shows of a view, see Camera.draw(). */
    draw(view, size) {
        if (this.beside_?.frames > 0) this.beside_.camera.draw(view, size, [this.divider.at, 1]);
    }

    /** The part of the picture that is to be seen of A. */
    get part_of_a() {
        return this.beside_?.frames > 0 ? [0, this.divider.at] : [0, 1];
    }

    /** Both pictures as they are seen, of the size of A's. Where nothing is compared, A's. */
    painted(a) {
        if (!(this.beside_?.frames > 0)) return a;
        const { width, height } = a;
        const both = element("canvas", { width, height });
        const context = both.getContext("2d");
        const { camera, canvas, picture } = this.beside_;
        const x = Math.round(this.divider.at * width);
        context.drawImage(a, 0, 0);
        context.save();
        context.beginPath();
        context.rect(x, 0, width - x, height);
        context.clip();
        context.drawImage(camera.draws ? canvas : picture, 0, 0, width, height);
        context.restore();
        context.fillStyle = "#e8eaec";
        context.fillRect(x - 1, 0, 2, height);
        return both;
    }

    show_(shown) {
        this.divider.show(shown);
        for (const id of ["side-a", "side-b", "comparison"]) by_id(id).hidden = !shown;
        document.body.dataset.side = shown ? this.sides.shown : "";
        for (const button of document.querySelectorAll("button.compare"))
            button.setAttribute("aria-pressed", String(shown));
        this.counters.beside = this.beside_;
    }

    /** What each side is, beside the divider. */
    say_() {
        if (!this.open) return;
        for (const side of ["A", "B"]) {
            const { hour, materials, lamps, settled } = this.sides.about[side];
            const count = (n, word) => (n > 0 ? [`${n} ${word}${n > 1 ? "s" : ""}`] : []);
            const own = side === "B" && this.place.scene;
            const words = [
                side,
                ...(own ? [this.place.scene.split(/[\\/]/).pop()] : []),
                ...(hour === undefined ? [] : [clock_text(hour)]),
                ...count(materials, "material"),
                ...count(lamps, "lamp"),
            ];
            const waits = settled === false || (side === "B" && this.beside_.frames === 0);
            const text = words.join(" · ") + (waits ? " …" : "");
            const label = by_id(`side-${side.toLowerCase()}`);
            if (label.textContent !== text) label.textContent = text;
        }
    }
}
