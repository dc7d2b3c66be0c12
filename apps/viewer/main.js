// Puts the page together: makes its parts and passes events between them.
import { AddressBar } from "./address_bar.js";
import { Camera } from "./camera.js";
import { Comparison } from "./comparison.js";
import { make_counters } from "./counters.js";
import { by_id } from "./dom.js";
import { followed_text } from "./followed.js";
import { Glare } from "./glare.js";
import { Input } from "./input.js";
import { IsoluxPanel } from "./isolux_panel.js";
import { show_legend } from "./legend.js";
import { LampPanel } from "./lamp_panel.js";
import { LightPanel } from "./light_panel.js";
import { MaterialPanel } from "./material_panel.js";
import { Measuring } from "./measuring.js";
import { Navigator } from "./navigator.js";
import { cover, notice, show_failures, show_troubles, uncover } from "./notices.js";
import { Overlay } from "./overlay.js";
import { is_open, offer_panels, start_panels } from "./panels.js";
import { panel_messages } from "./panel_messages.js";
import { PathPanel } from "./path_panel.js";
import { PlanPanel } from "./plan_panel.js";
import { Roles } from "./roles.js";
import { on_resize, picture_size, scaled_into, Screen } from "./screen.js";
import { Session } from "./session.js";
import { Sides } from "./sides.js";
import { show_phase, start_figures } from "./status.js";
import { StickMark } from "./stick.js";
import { keep_scene_item, scene_item, session_id } from "./store.js";
import { fit_view, same_picture } from "./view.js";
import { TimePanel } from "./time_panel.js";
import { UnderPointer } from "./under_pointer.js";
import { ViewSender } from "./view_sender.js";
import { ViewsPanel } from "./views_panel.js";
import { start_commands } from "./commands.js";
import { lost_words, quantity, sentence } from "./words.js";

const picture = by_id("picture");

let scene = "";
let home = null; // the first view of a scene that names no views
let greeted = false; // whether a server has ever sent `welcome`
let welcomed = false; // whether the server has sent `welcome` on this connection
let awaiting_picture = true;
let interruption = ""; // why the walk begins anew; "": it does not
let max_size = [4096, 4096];
let display_number = 0; // of the newest settings of the display; frames that are after them have it, too

const navigator = new Navigator();
const screen = new Screen(picture, { drawn, skipped, failed });
const asked = new URL(location).searchParams;
const plain = asked.has("plain"); // show frames as they come
const camera = new Camera(by_id("camera"), picture, !plain, asked.has("refine"));
const sides = new Sides(
    panel_messages(() => ({
        ...{ session, counters, measuring, materials, lamps, time, commands },
        open_panels,
    })),
);
const session = new Session(session_id(), camera.available, screen, {
    ...sides.handlers("A", ["probes", "material", "edited", "lights", "time"]),
    connected: () => cover("Connected. Waiting for the scene…"),
    lost,
    welcome,
    loaded: scene_loaded,
    picked: (message) => measuring.picked(message),
    mean: (message) => measuring.mean(message),
    role: (message) => roles.update(message),
    loading: ({ text, share }) => {
        isolux.outdate("the scene is read again");
        show_failures([]);
        cover(text || "Reading the scene…", share);
    },
    failed: scene_failed,
    followed: files_followed,
    glare: (message) => {
        counters.last_glare = message;
        glare.answer(message);
    },
    plan: (message) => plan.answer(message),
    isolux: (message) => {
        counters.last_isolux = message;
        isolux.answer(message);
    },
    state: server_state,
    view: (message) => {
        session.watch(message);
        redraw();
    },
    display: (message) => {
        if (!session.driving) take_display(message);
    },
    refused: ({ text, id, view }) => {
        if (id !== undefined && (plan.refused(id) || isolux.refused(id))) return;
        if (view !== undefined) view_refused();
        counters.errors.push(text);
        notice(text, true);
    },
    interrupted,
    bye: ({ reason }) => cover(reason || "The server says goodbye."),
});
const counters = make_counters(session, navigator, camera, screen.decoder);
const overlay = new Overlay(by_id("overlay"));
const measuring = new Measuring(session, counters, redraw);
const { measurements, reading } = measuring;
const glare = new Glare({ changed: redraw });
const isolux = new IsoluxPanel({
    ask: (question) => session.ask("isolux", question),
    pick: (x, y, then) => measuring.point_at(x, y, then),
    eye: present_eye,
    ready: () => welcomed && counters.ready,
    sight: () => camera.sight,
    changed: redraw,
});
const light = new LightPanel({
    display: (display) => {
        display_number = (display_number + 1) & 255;
        tell_display();
        if (screen.want(display_number, display)) camera.recoloured();
        comparison.want(display_number, display);
        show_legend(display);
    },
    settings: (settings) => session.send({ type: "settings", ...settings }),
});
const lamps = new LampPanel({
    lights: (message) => comparison.send(message),
    kept: (presets) => keep_scene_item(scene, "lamps", presets),
    may_drive: () => session.driving,
    changed: () => {
        counters.lamps = lamps.lamps;
        commands.follow_light("a lamp is dimmed");
    },
});
const materials = new MaterialPanel({
    ask: (x, y) => comparison.ask("material", { x, y, ...measuring.view_shown() }),
    edits: (fields) => comparison.ask("edits", fields),
    may_drive: () => session.driving,
    indirect: () => light.settings.ambient !== "off",
    settled: () => comparison.panel_state.phase === "done",
    changed: () => commands.follow_light("a material is changed"),
});
const time = new TimePanel({
    time: (message) => comparison.send(message),
    may_drive: () => session.driving,
    changed: () => {
        counters.time = time.time;
    },
    frames: () => counters.frames,
    ambient: () => light.settings.ambient,
});
const comparison = new Comparison({
    ...{ session, sides, counters, plain, refine: asked.has("refine") },
    panels: [time, lamps, materials],
    display: () => ({ number: display_number, display: light.display }),
    picked: (message) => measuring.picked(message),
    changed: () => {
        draw_camera();
        redraw();
    },
    switched: () => {
        show_panel_buttons();
        measuring.tell_probes();
    },
});
measuring.sides = comparison;
const roles = new Roles({
    take: () => session.send({ type: "take" }),
    hand: (to) => session.send({ type: "hand", to }),
    changed: role_changed,
});
const views = new ViewsPanel({
    go: (view) => commands.go(view),
    kept: (saved) => keep_scene_item(scene, "views", saved),
});
const path = new PathPanel(navigator, {
    go: (view) => commands.go(view),
    may_drive: () => session.driving && navigator.view !== null,
    changed: (keys) => keep_scene_item(scene, "path", keys),
});
const plan = new PlanPanel({
    ask: () => session.ask("plan"),
    eye: present_eye,
    eye_height: () => navigator.eye_height,
    walks: () => navigator.walk,
    go: (position) => commands.go({ ...navigator.view, position }),
    may_drive: () => session.driving && navigator.view !== null,
});
const commands = start_commands({
    ...{ navigator, session, light, views, path, measuring, isolux, glare },
    ...{ lamps, materials, time, comparison, picture },
    painted: () => comparison.painted(draw_camera() ? by_id("camera") : picture),
    home: () => views.scene_views[0]?.view || home,
    scene: () => scene,
});
const sender = new ViewSender({ session, navigator, camera, size: () => size_now() });
const address = new AddressBar(session, navigator, (view) => commands.go(view, false));
commands.chosen = () => address.choose();
new Input(picture, navigator, new StickMark(by_id("stick")), {
    double_click: (x, y) => commands.go_to_point(x / innerWidth, 1 - y / innerHeight),
    click: (x, y) => commands.point(x / innerWidth, 1 - y / innerHeight),
    area_begin: (x, y) => measuring.area_begin(x, y),
    area_move: (x, y) => measuring.area_move(x, y),
    area_end: (x, y, meant) => {
        commands.want_area(false);
        measuring.area_end(x, y, meant);
    },
    area_wanted: () => commands.area_wanted,
    may_drive: () => session.driving && navigator.view !== null,
    speed: (speed) => notice(`${quantity(speed)} m/s`),
});

const under = new UnderPointer(picture, {
    wanted: () =>
        reading.pick === null &&
        (light.display.mode === "false" ||
            comparison.shows_difference ||
            is_open("light") ||
            is_open("measure")),
    luminance: (x) => comparison.luminance_at(x, luminance()),
    before: () => (comparison.shows_difference ? luminance() : null),
});

/** Of A's picture; null where it is not known. */
function luminance() {
    return camera.draws || awaiting_picture ? null : screen.luminance;
}

/** The picture's size for this window [pixels]. */
const size_now = () => picture_size(innerWidth, innerHeight, devicePixelRatio, max_size);

/** The view that the eye has, of a page that watches the driver's; null when it is not known. */
function present_eye() {
    return session.driving ? navigator.view : session.seen;
}

function redraw() {
    const { probes, areas } = measurements;
    overlay.draw(session.shown, {
        probes,
        areas,
        reading: reading.pick,
        drag: measuring.drag,
        sources: glare.sources,
        contours: isolux.marks(session.shown),
    });
    reading.follow(session.shown);
    under.show();
}

// Messages from the server -----------------------------------------------------------------------

function welcome(message) {
    roles.welcome(message);
    light.offer_clean(message.denoises === true);
    if (message.max_size) max_size = message.max_size;
    if (scene !== message.scene || !greeted) open_scene(message.scene || "");
    views.set_scene_views(message.views || []);
    welcomed = true;
    awaiting_picture = true;
    if (greeted) return say_all();
    greeted = true;
    take_display(message.display, message.settings);
    const first = address.view ?? message.view;
    home = message.view ?? first;
    if (first) navigator.place(first);
    measuring.tell_probes();
}

/** Load what the browser stored for this scene: views, keys of a path, pins. */
function open_scene(name) {
    scene = name;
    counters.scene = name;
    const short = name.split(/[\\/]/).pop() || "Lightwalk";
    by_id("scene").textContent = short;
    document.title = `${short} – Lightwalk`;
    views.restore(scene_item(name, "views", []));
    path.restore(scene_item(name, "path", []));
    isolux.clear();
    lamps.restore(scene_item(name, "lamps", []));
    materials.forget();
    measuring.open_scene(name);
}

function take_display(display, settings) {
    light.take(display, settings);
    display_number = display?.number ?? 0;
    if (screen.want(display_number, light.display)) camera.recoloured();
    comparison.want(display_number, light.display);
    show_legend(light.display);
}

const tell_display = () =>
    session.send({ ...light.display, type: "display", number: display_number });

/** After a new connection: send the server what the page knows. */
function say_all() {
    if (!session.driving) return;
    tell_display();
    session.send({ type: "settings", ...light.settings });
    lamps.tell();
    materials.tell();
    time.tell();
    measuring.tell_probes();
    navigator.touch();
}

function scene_loaded(message) {
    awaiting_picture = true;
    counters.ready = false;
    show_failures([]);
    show_troubles([]);
    if (message.views) views.set_scene_views(message.views);
    navigator.set_eye_height(message.eye_height);
    comparison.place = message.beside ?? null;
    sides.take("A", { ...message, type: "loaded" });
    plan.forget();
    cover("Drawing the first picture…");
    if (!navigator.view && views.scene_views.length > 0) {
        home = views.scene_views[0].view;
        navigator.place(home);
    }
    navigator.touch();
    measuring.tell_probes();
}

/** The scene's light groups, and where a generator writes its sky; what was dimmed, and the time that was chosen, stay so. */
function open_panels({ lights = [], time: place }) {
    lamps.open(lights);
    time.open(place);
    materials.outdate();
    show_panel_buttons();
    if (!session.driving) return;
    lamps.tell();
    time.tell();
}

/** The scene's files were edited: it is as they have it now, or they have errors. */
function files_followed(message) {
    counters.last_followed = message;
    const { problems = [], files = [] } = message;
    show_troubles(problems);
    if (problems.length > 0) return;
    sides.take("A", { ...message, type: "loaded" });
    plan.forget();
    isolux.outdate("the scene's files are edited");
    commands.follow_light("the scene's files are edited");
    if (files.length > 0) notice(followed_text(message));
}

const show_panel_buttons = () =>
    offer_panels({ lamps: lamps.lamps.length > 0, time: time.is_there });

/** The eye returns to where the newest frame was seen from, lest the same view is sent again. */
function view_refused() {
    const seen = session.frame_view ?? views.scene_views[0]?.view;
    if (seen && navigator.view && !same_picture(seen, navigator.view)) navigator.place(seen);
}

function scene_failed({ messages }) {
    counters.errors.push(...messages);
    uncover();
    show_failures(messages);
}

function lost(reason, wait) {
    forget_walk("the connection is lost");
    cover(lost_words(reason, greeted, wait));
}

/** Those who draw the walk are lost. The connection stays, and who draws it anew says `welcome`. */
function interrupted({ text }) {
    session.latency.forget();
    forget_walk("the walk begins anew");
    interruption = sentence(text);
    counters.interruptions.push(interruption);
    cover(interruption);
}

/** What the page awaited of the walk does not come any more. */
function forget_walk(why) {
    welcomed = false;
    roles.lost();
    plan.forget();
    isolux.outdate(why);
    counters.ready = false;
}

function role_changed(driving) {
    session.drive(driving);
    if (!driving) comparison.end("somebody else drives");
    lamps.drive();
    materials.drive();
    time.drive();
    if (driving && welcomed) {
        navigator.touch();
        measuring.tell_probes();
    }
}

function server_state(message) {
    counters.state = message;
    show_phase(message);
    measuring.follow_light();
    sides.take("A", message);
}

// Frames -----------------------------------------------------------------------------------------

function drawn(frame, depth, told) {
    ++counters.frames;
    const { exposure, at_rest, final, denoised } = frame;
    Object.assign(counters, { exposure, at_rest, final, denoised });
    const sent = session.drawn(frame, told);
    if (sent?.walk && sent.epoch === navigator.epoch) navigator.take_height(frame.eye);
    camera.take(session.driving && !sent ? null : session.frame_view, depth);
    light.note_exposure(exposure);
    light.denoised = denoised;
    if (awaiting_picture && session.connection.connected) {
        awaiting_picture = false;
        counters.ready = true;
        uncover();
        if (interruption) notice(interruption);
        interruption = "";
    }
    draw_camera();
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

// The page's clock: one tick a screen refresh ----------------------------------------------------

/**
 * Draw what the eye sees now, or in a page that watches what the driver's saw, if the newest frame is not just that; whether
 * the screen shows what was drawn.
 */
function draw_camera() {
    const most = size_now();
    const size = session.driving ? most : scaled_into(most, picture);
    const own = session.driving && navigator.view;
    const view = own ? fit_view(own, size.width, size.height) : session.seen;
    session.shown = camera.draw(view, size, comparison.part_of_a) ? view : session.frame_view;
    comparison.draw(view, size);
    return camera.draws;
}

/** Send the present view, unless the server has it already. */
function step_now() {
    const now = performance.now();
    if (!welcomed || !session.driving || !sender.is_due(now)) return;
    const step = navigator.tick(now);
    commands.show_walk();
    if (!step || !sender.send(step, now)) return;
    if (glare.id && !same_picture(glare.view, session.view)) glare.clear();
    if (reading.pick && !reading.pick.hit) reading.close();
}

/** Show the camera of now. */
function refresh() {
    const drew = camera.draws;
    const now = performance.now();
    if (session.driving) navigator.advance(now);
    if (draw_camera()) session.latency.shown(session.view_id, now);
    if (drew || camera.draws) redraw();
    if (welcomed && counters.ready) plan.refresh(now);
    isolux.refresh(now);
    time.refresh(now);
}

start_panels();
on_resize(redraw, () => {
    navigator.touch();
    show_legend(light.display);
    redraw();
});
addEventListener("online", () => session.connection.hurry());
document.addEventListener("visibilitychange", () => {
    if (!document.hidden) session.connection.hurry();
});
start_figures(session, navigator, picture, () => counters.state);
// A view is sent as soon as a key is pressed, not with the screen's next refresh.
navigator.on_input = () => queueMicrotask(step_now);
requestAnimationFrame(function tick() {
    step_now();
    refresh();
    requestAnimationFrame(tick);
});
window.lightwalk = counters;
