// The page: its parts, and who tells whom.
import { make_counters } from "./counters.js";
import { by_id } from "./dom.js";
import { Glare } from "./glare.js";
import { Input } from "./input.js";
import { show_legend } from "./legend.js";
import { LightPanel } from "./light_panel.js";
import { show_measurements } from "./measure_panel.js";
import { Measurements } from "./measurements.js";
import { Navigator } from "./navigator.js";
import { cover, notice, show_failures, uncover } from "./notices.js";
import { Overlay } from "./overlay.js";
import { start_panels } from "./panels.js";
import { Reading } from "./reading.js";
import { Roles } from "./roles.js";
import { picture_size, Screen } from "./screen.js";
import { Session } from "./session.js";
import { show_figures, show_phase } from "./status.js";
import { keep_scene_item, scene_item, session_id } from "./store.js";
import { same_picture } from "./view.js";
import { ViewsPanel } from "./views_panel.js";
import { start_commands } from "./commands.js";
import { quantity } from "./words.js";

const kFastest = 12;    // between two views: fast screens ask no more often than servers allow [ms]
const kSmallest = 3;    // side of an area [CSS pixels]
const kResized = 120;   // a window that is being resized settles first [ms]

const picture = by_id("picture");
const now_text = () => new Date().toISOString().replace(/\.\d+/, "");

let scene = "", home = null;
let greeted = false;            // ever, by a server
let welcomed = false;           // on this connection
let awaiting_picture = true;
let max_size = [4096, 4096];
let drag = null;   // an area that is being drawn [CSS pixels]

const navigator = new Navigator();
const screen = new Screen(picture, { drawn, skipped, failed });
const session = new Session(session_id(), screen, {
    connected: () => cover("Connected. Waiting for the scene…"),
    lost, welcome, loaded: scene_loaded, picked, mean, role: (message) => roles.update(message),
    loading: ({ text, share }) => {
        show_failures([]);
        cover(text || "Reading the scene…", share);
    },
    failed: scene_failed,
    probes: (message) => {
        counters.last_probes = message;
        measurements.update_probes(message, now_text());
    },
    glare: (message) => {
        counters.last_glare = message;
        glare.answer(message);
    },
    state: server_state,
    view: ({ view }) => {
        session.watch(view);
        redraw();
    },
    display: ({ display }) => {
        if (!session.driving) take_display(display);
    },
    refused: ({ text }) => {
        counters.errors.push(text);
        notice(text, true);
    },
    bye: ({ reason }) => cover(reason || "The server says goodbye."),
});
const counters = make_counters(session, navigator);
const overlay = new Overlay(by_id("overlay"));
const measurements = new Measurements(measured);
const reading = new Reading({ pin, closed: redraw });
const glare = new Glare({ changed: redraw });
const light = new LightPanel({
    display: (display) => {
        session.send({ type: "display", ...display });
        show_legend(display);
    },
    settings: (settings) => session.send({ type: "settings", ...settings }),
});
const roles = new Roles({
    take: () => session.send({ type: "take" }),
    hand: (to) => session.send({ type: "hand", to }),
    changed: role_changed,
});
const views = new ViewsPanel({
    go: (view) => commands.go(view),
    kept: (saved) => keep_scene_item(scene, "views", saved),
    keys_changed: (keys) => keep_scene_item(scene, "path", keys),
});
const commands = start_commands({
    navigator, session, light, views, measurements, reading, glare, picture, pick_at, redraw,
    home: () => views.scene_views[0]?.view || home,
    scene: () => scene,
});
new Input(picture, navigator, {
    click: (x, y) => pick_at(x / innerWidth, 1 - y / innerHeight),
    area_begin: (x, y) => (drag = [x, y, x, y]),
    area_move: (x, y) => {
        drag = [drag[0], drag[1], x, y];
        redraw();
    },
    area_end: area_drawn,
    area_wanted: () => commands.area_wanted,
    may_drive: () => session.driving && navigator.view !== null,
    speed: (speed) => notice(`${quantity(speed)} m/s`),
});

/** The picture's size for this window [pixels]. */
const size_now = () => picture_size(innerWidth, innerHeight, devicePixelRatio, max_size);

function redraw() {
    const { probes, areas } = measurements;
    overlay.draw(session.shown, { probes, areas, reading: reading.pick, drag, sources: glare.sources });
    reading.follow(session.shown);
}

// What the server says ---------------------------------------------------------------------------

function welcome(message) {
    roles.welcome(message);
    if (message.max_size) max_size = message.max_size;
    if (scene !== message.scene || !greeted) open_scene(message.scene || "");
    views.set_scene_views(message.views || []);
    welcomed = true;
    awaiting_picture = true;
    if (greeted) return say_all();
    greeted = true;
    take_display(message.display, message.settings);
    if (message.view) {
        home = message.view;
        navigator.place(message.view);
    }
    tell_probes();
}

/** What the browser keeps for this scene. */
function open_scene(name) {
    scene = name;
    counters.scene = name;
    const short = name.split(/[\\/]/).pop() || "Lightwalk";
    by_id("scene").textContent = short;
    document.title = `${short} – Lightwalk`;
    views.restore(scene_item(name, "views", []), scene_item(name, "path", []));
    measurements.restore(scene_item(name, "measured", {}));
}

function take_display(display, settings) {
    light.take(display, settings);
    show_legend(light.display);
}

/** A server that is back learns what the page knows. */
function say_all() {
    if (!session.driving) return;
    session.send({ type: "display", ...light.display });
    session.send({ type: "settings", ...light.settings });
    tell_probes();
    navigator.touch();
}

function scene_loaded(message) {
    awaiting_picture = true;
    show_failures([]);
    if (message.views) views.set_scene_views(message.views);
    navigator.set_eye_height(message.eye_height);
    cover("Drawing the first picture…");
    if (!navigator.view && views.scene_views.length > 0) {
        home = views.scene_views[0].view;
        navigator.place(home);
    }
    navigator.touch();
    tell_probes();
}

function scene_failed({ messages }) {
    counters.errors.push(...messages);
    uncover();
    show_failures(messages);
}

function lost(reason, wait) {
    welcomed = false;
    roles.lost();
    counters.ready = false;
    const words = reason || (greeted ? "The connection to the server is lost." : "No answer from the server.");
    cover(`${words} Trying again${wait >= 1000 ? ` in ${Math.round(wait / 1000)} s` : ""}…`);
}

function role_changed(driving) {
    session.driving = driving;
    if (!driving) session.shown = null;
    for (const control of document.querySelectorAll("#panel-light input, #walk")) control.disabled = !driving;
    if (driving && greeted) {
        navigator.touch();
        tell_probes();
    }
}

function server_state(message) {
    counters.state = message;
    show_phase(message);
    if (!session.shown || session.shown_id !== session.view_id) return;
    const share = message.phase === "done" ? 1 : 0;
    for (const { id, rect } of measurements.areas_to_ask(session.shown, share, performance.now()))
        session.ask("rectangle", { id, rect });
}

// Frames -----------------------------------------------------------------------------------------

function drawn(frame) {
    ++counters.frames;
    Object.assign(counters, { exposure: frame.exposure, at_rest: frame.at_rest, final: frame.final });
    const sent = session.drawn(frame);
    if (sent?.walk && sent.epoch === navigator.epoch) navigator.take_height(frame.eye);
    light.note_exposure(frame.exposure);
    if (awaiting_picture && session.connection.connected) {
        awaiting_picture = false;
        counters.ready = true;
        uncover();
    }
    redraw();
}

function skipped(frame) {
    ++counters.skipped;
    session.skipped(frame);
}

function failed(error, frame) {
    counters.errors.push(String(error));
    console.warn("lightwalk:", error);
    if (frame) session.skipped(frame);
}

// Light that is asked for ------------------------------------------------------------------------

const asked = new Map();   // where picks under way point to, by their numbers

function pick_at(x, y) {
    if (!session.connection.connected) return;
    asked.set(session.ask("pick", { x, y }), [x, y]);
}

function picked(message) {
    const at = asked.get(message.id);
    if (!at) return;
    asked.delete(message.id);
    counters.last_pick = message;
    reading.show({ ...message, at });
    redraw();
}

function pin(pick) {
    const probe = measurements.pin(pick, now_text());
    notice(probe ? `Pinned as ${probe.name}` : "64 pins are the most.", !probe);
}

function area_drawn(x, y, meant) {
    const box = drag;
    drag = null;
    commands.end_area();
    const view = session.shown;
    if (meant && view && Math.min(Math.abs(x - box[0]), Math.abs(y - box[1])) >= kSmallest) {
        const within = (value) => Math.max(0, Math.min(1, value));
        const xs = [within(box[0] / innerWidth), within(x / innerWidth)].sort((a, b) => a - b);
        const ys = [within(1 - box[1] / innerHeight), within(1 - y / innerHeight)].sort((a, b) => a - b);
        const area = measurements.add_area([xs[0], ys[0], xs[1], ys[1]], view);
        session.ask("rectangle", { id: area.id, rect: area.rect });
    }
    redraw();
}

function mean(message) {
    counters.last_mean = message;
    const settled = counters.state.phase === "done" ? 1 : 0;
    measurements.update_area(message, settled, now_text());
}

function measured(pins_changed) {
    show_measurements(measurements);
    if (greeted) keep_scene_item(scene, "measured", { probes: measurements.probes, areas: measurements.areas });
    if (pins_changed) tell_probes();
    redraw();
}

function tell_probes() {
    if (!welcomed || !session.driving) return;
    const probes = measurements.probes.map(({ id, position, normal }) => ({ id, position, normal }));
    session.send({ type: "probes", probes });
}

// The page's clock -------------------------------------------------------------------------------

let resized;
function on_resize() {
    redraw();
    clearTimeout(resized);
    resized = setTimeout(() => {
        navigator.touch();
        show_legend(light.display);
        redraw();
    }, kResized);
}

let bytes_before = 0;
function show_status() {
    const bits = (session.connection.bytes - bytes_before) * 8;
    bytes_before = session.connection.bytes;
    if (by_id("status").hidden) return;
    show_figures(counters.state, {
        latency: session.latency.quantile(0.5), latency_95: session.latency.quantile(0.95),
        width: picture.width, height: picture.height, speed: navigator.speed, walk: navigator.walk,
        megabits: bits / 1e6,
    });
}

let ticked = 0;
function tick(now) {
    requestAnimationFrame(tick);
    if (!welcomed || !session.driving || now - ticked < kFastest) return;
    ticked = now;
    const step = navigator.tick(now);
    commands.show_walk();
    if (!step || !session.send_view(step, size_now(), navigator.epoch)) return;
    if (glare.id && !same_picture(glare.view, session.view)) glare.clear();
    if (reading.pick && !reading.pick.hit) reading.close();
}

start_panels();
addEventListener("resize", on_resize);
addEventListener("online", () => session.connection.hurry());
document.addEventListener("visibilitychange", () => {
    if (!document.hidden) session.connection.hurry();
});
setInterval(show_status, 1000);
requestAnimationFrame(tick);
window.lightwalk = counters;
