// A server that speaks the walk's protocol and draws a room without a renderer, to test the page.
//
//     node fake_server.mjs --npm FOLDER [--port N] [--log]
//
// FOLDER has node_modules with ws and jpeg-js. GET /fake/NAME makes it misbehave: fail (the scene
// cannot be read), reload, drop (breaks connections), interrupt and
// resume (all that was told is forgotten), dumb and speak (no frames meanwhile), refuse, join
// and leave (another driver), edit, spoil and mend (files of the scene). The answer is how many plans were asked for.
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import {
    coarse_pieces,
    depth_piece,
    frame_bytes,
    kStrips,
    luminance_piece,
    strip_piece,
} from "./fake_frames.mjs";
import { plan_message } from "./fake_plan.mjs";
import { FakeBeside } from "./fake_beside.mjs";
import { isolux_messages } from "./fake_isolux.mjs";
import { edited_message, material_message } from "./fake_materials.mjs";
import { direction_at, look } from "./fake_scene.mjs";
import { kEyeHeight, kFollowed, kLoaded, kLost, kViews } from "./fake_told.mjs";

const { values: args } = parseArgs({
    options: {
        npm: { type: "string" },
        port: { type: "string", default: "8099" },
        log: { type: "boolean", default: false },
    },
});
const load = createRequire(path.resolve(args.npm, "none.js"));
const { WebSocketServer } = load("ws");
const jpeg = load("jpeg-js");

const kPage = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../../../apps/viewer");
const kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; " +
    "font-src 'self'; connect-src 'self'; worker-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const kTypes = {
    ".html": "text/html",
    ".js": "text/javascript",
    ".css": "text/css",
    ".svg": "image/svg+xml",
};

// The walk --------------------------------------------------------------------------------------

let display = {
    mode: "tone",
    exposure: { auto: true, ev: 0 },
    human: false,
    scale: { low: 1, high: 10000, log: true },
};
let settings = { ambient: "rest" };
let lights = { type: "lights", levels: [] };
let edited = null; // the newest answer to `edits`
let time = { type: "time", time: null };
let probes = [];
let spoiled = null, // what is wrong with edited files
    failing = false,
    dumb = false, // no frames
    guest = null, // a client that is not there
    plans = 0, // how many were asked for
    brightness = 1; // of the planes that are asked about: a scene that is read again is twice as bright
let wish = null,
    version = 0; // what is to be drawn, and how often it has changed
let lost = null; // what was drawn last, while nobody draws: {wish, view}
const clients = new Map(); // socket -> {id, drawn, strip, busy, frame, session}
const places = new Map(); // by session: where a client stood
let driver = null,
    last_id = 0;

const tell = (socket, message) => socket.readyState === 1 && socket.send(JSON.stringify(message));
const tell_all = (message) => [...clients.keys()].forEach((socket) => tell(socket, message));

function tell_roles() {
    const ids = [...[...clients.values()].map((c) => c.id), ...(guest === null ? [] : [guest])];
    for (const [socket, client] of clients)
        tell(socket, {
            type: "role",
            driver: driver === client.id,
            driver_id: driver,
            clients: ids,
        });
}

function greet(socket, client, session) {
    client.session = session;
    if (driver === null) driver = client.id;
    tell(socket, {
        type: "welcome",
        version: "fake",
        you: client.id,
        driver: driver === client.id,
        scene: "room/room.rad",
        max_size: [2560, 1600],
        fps: 30,
        views: kViews,
        view: places.get(session) || kViews[0].view,
        display,
        settings,
        denoises: true,
    });
    tell_roles();
    if (failing) return tell(socket, failing);
    for (const [k, text] of ["Reading room.rad", "Building the tree"].entries())
        tell(socket, { type: "loading", text, share: k / 2 });
    setTimeout(() => {
        tell(socket, kLoaded);
        if (spoiled) tell(socket, spoiled);
        tell(socket, lights);
        if (edited) tell(socket, edited);
        tell(socket, time_reply());
    }, 60);
}

const time_reply = () => ({
    type: "time",
    time: time.time,
    rise: 6.5,
    set: 18.25,
    altitude: 30,
    azimuth: 40,
});

/** Walking keeps the eye above the floor; the page takes the height over. */
const eye_of = ({ view, walk }) =>
    walk ? [view.position[0], view.position[1], kEyeHeight] : view.position;

function answer(socket, message) {
    const client = clients.get(socket),
        driving = driver === client.id;
    const answers = {
        hello: () => {
            if (message.beside) {
                clients.delete(socket);
                return beside.open(socket, message, driver !== null, display);
            }
            client.depth = message.depth === true;
            client.luminance = message.luminance === true;
            if (lost) return come_meanwhile(socket, client, message.session);
            greet(socket, client, message.session);
        },
        ack: () => (client.busy = false),
        view: () => {
            if (!driving) return;
            wish = { ...message, version: ++version };
            places.set(client.session, message.view);
        },
        display: () => {
            if (!driving) return;
            display = message;
            if (wish) wish.version = ++version;
            for (const other of clients.keys()) if (other !== socket) tell(other, message);
        },
        settings: () => driving && (settings = message),
        lights: () => {
            if (!driving) return;
            lights = message;
            for (const other of clients.keys()) if (other !== socket) tell(other, message);
        },
        time: () => {
            if (!driving) return;
            time = message;
            tell_all(time_reply());
        },
        pick: () => tell(socket, picked(message)),
        rectangle: () => tell(socket, mean(message)),
        probes: () =>
            driving &&
            ((probes = message.probes),
            tell(socket, measured(0.4)),
            setTimeout(() => tell(socket, measured(1)), 700)),
        glare: () => {
            tell(socket, { type: "glare", id: message.id, done: 0.5, dgp: 0.3, sources: [] });
            setTimeout(() => tell(socket, glare(message)), 250);
        },
        plan: () => {
            ++plans;
            tell(socket, planned(message));
        },
        isolux: () => {
            if (!wish)
                return tell(socket, {
                    type: "refused",
                    text: "there is no picture yet",
                    id: message.id,
                });
            isolux_messages(message, brightness).forEach((part, k) =>
                setTimeout(() => tell(socket, part), 250 * k),
            );
        },
        material: () => tell(socket, material_message(message.id, looked_at(message))),
        edits: () => {
            if (!driving) return;
            edited = edited_message(message);
            tell_all(edited);
        },
        take: () =>
            driver === null
                ? ((driver = client.id), tell_roles())
                : tell(socket, { type: "refused", text: "Somebody drives." }),
        hand: () => driving && ((driver = message.to), tell_roles()),
    };
    answers[message.type]?.();
}

const present_view = () => ({ ...wish.view, position: eye_of(wish) });
/** As the real server, there is no plan before there is a picture. */
const planned = ({ id }) =>
    wish
        ? plan_message(id, eye_of(wish)[2], kEyeHeight)
        : { type: "refused", text: "there is no picture yet", id };
const lux = (hit) => (hit.luminance * Math.PI) / 0.6;

const looked_at = ({ x, y, view = present_view() }) =>
    look(view.position, direction_at(view, x, y));

function picked({ id, ...question }) {
    const hit = looked_at(question);
    if (!hit)
        return {
            type: "picked",
            id,
            hit: false,
            luminance: 0,
            luminance_95: 0,
            illuminance: null,
            illuminance_95: null,
            distance: null,
            position: null,
            normal: null,
            material: "",
            surface: "",
        };
    return {
        type: "picked",
        id,
        hit: true,
        luminance: hit.luminance,
        luminance_95: 0.004 * hit.luminance,
        illuminance: lux(hit),
        illuminance_95: 0.023 * lux(hit),
        distance: hit.t,
        position: hit.position,
        normal: hit.normal,
        material: hit.material,
        surface: hit.surface,
    };
}

function mean({ id, rect: [x0, y0, x1, y1] }) {
    const view = present_view(),
        n = 16;
    let sum = 0;
    for (let k = 0; k < n * n; ++k)
        sum +=
            look(
                view.position,
                direction_at(
                    view,
                    x0 + ((x1 - x0) * ((k % n) + 0.5)) / n,
                    y0 + ((y1 - y0) * (Math.floor(k / n) + 0.5)) / n,
                ),
            )?.luminance || 0;
    return {
        type: "mean",
        id,
        luminance: sum / (n * n),
        luminance_95: (0.015 * sum) / (n * n),
        pixels: Math.round((x1 - x0) * (y1 - y0) * wish.width * wish.height),
    };
}

function measured(settled) {
    const values = probes.map(({ id, position, normal }) => {
        const hit = look(
            position.map((x, k) => x + 0.01 * normal[k]),
            normal.map((x) => -x),
        );
        return {
            id,
            luminance: hit.luminance * (0.8 + 0.2 * settled),
            luminance_95: 0,
            illuminance: lux(hit) * (0.8 + 0.2 * settled),
            illuminance_95: lux(hit) * (settled < 1 ? 0.12 : 0.028),
        };
    });
    return { type: "probes", probes: values, settled };
}

function glare({ id }) {
    const outline = [
        [0.36, 0.52],
        [0.52, 0.54],
        [0.52, 0.78],
        [0.36, 0.8],
    ];
    return {
        type: "glare",
        id,
        done: 1,
        dgp: 0.372,
        dgp_95: 0.006,
        sources: [{ outline, luminance: 4610, solid_angle: 0.21, position_index: 2.4 }],
    };
}

/** The next frame for a client that has drawn the one before: coarse at once, then strip by strip. */
function next_frame(socket, client) {
    if (client.busy || !wish || failing || dumb || client.session === undefined) return;
    const view = present_view();
    let pieces, flags;
    if (client.drawn !== wish.version) {
        client.drawn = wish.version;
        client.strip = 0;
        if (driver !== client.id) tell(socket, { type: "view", view, seen: wish.seen });
        pieces = coarse_pieces(jpeg, view, wish, display);
        if (client.depth) pieces.push(depth_piece(view, wish));
        if (client.luminance) pieces.push(luminance_piece(jpeg, view, wish, display));
        flags = 1;
    } else if (!wish.moving && client.strip < kStrips) {
        pieces = [strip_piece(jpeg, view, wish, client.strip++, display)];
        flags = client.strip === kStrips ? 6 : 2;
        if (display.clean && client.strip === kStrips) flags |= 8;
    } else return;
    client.busy = true;
    socket.send(frame_bytes(++client.frame, wish, view.position, flags, pieces, display));
}

/** Somebody comes while nobody draws: what was drawn last, and why it goes no further. */
function come_meanwhile(socket, client, session) {
    client.session = session;
    const { wish: last, view } = lost;
    tell(socket, { ...display, type: "display" });
    tell(socket, { type: "view", view, seen: last.seen });
    const pieces = coarse_pieces(jpeg, view, last, display);
    if (client.depth) pieces.push(depth_piece(view, last));
    if (client.luminance) pieces.push(luminance_piece(jpeg, view, last, display));
    socket.send(frame_bytes(4321, last, view.position, 7, pieces, display));
    tell(socket, { type: "loading", text: kLost, share: 0 });
}

const beside = new FakeBeside(jpeg, kLoaded, edited_message);
setInterval(() => {
    [...clients].forEach(([socket, client]) => next_frame(socket, client));
    if (wish && !dumb) beside.next_frame(present_view(), wish, display);
}, 24);
setInterval(() => {
    const [client] = clients.values();
    if (!client || !wish || failing) return;
    const done = client.strip >= kStrips;
    tell_all({
        type: "state",
        fps: 31.4,
        reuse: 0.964,
        inferred: 0.02,
        guessed: 0.012,
        rays_per_second: 2.43e6,
        ranks: 1,
        threads: 2,
        points: 512345,
        phase: wish.moving ? "moving" : done ? "done" : client.strip < 3 ? "refining" : "ambient",
        share: client.strip / kStrips,
    });
}, 200);

const pranks = {
    fail: () =>
        tell_all(
            (failing = {
                type: "failed",
                messages: [
                    'room/materials.rad:12: undefined modifier "wite_paint", did you mean "white_paint"?',
                    'room/furniture.rad:87: expected 12 real arguments for polygon "table.top.4", found 11',
                ],
            }),
        ),
    reload: () => {
        failing = false;
        brightness *= 2;
        tell_all({ type: "loading", text: "Reading room.rad again", share: 0.4 });
        setTimeout(() => tell_all(kLoaded), 300);
    },
    drop: () => {
        [...clients.keys()].forEach((socket) => socket.terminate());
        beside.socket?.terminate();
    },
    alone: () => tell_all({ ...kLoaded, beside: { refused: "many processes draw this walk" } }),
    drop_beside: () => beside.socket?.terminate(),
    interrupt: () => {
        lost = wish && { wish, view: present_view() };
        lights = { type: "lights", levels: [] };
        time = { type: "time", time: null };
        [edited, wish, probes] = [null, null, []];
        tell_all({ type: "interrupted", text: kLost });
    },
    resume: () => {
        lost = null;
        clients.forEach((client, socket) => {
            Object.assign(client, { drawn: -1, strip: 0, busy: false, frame: 0 });
            greet(socket, client, client.session);
        });
    },
    edit: () =>
        tell_all({ ...kFollowed, files: ["room.rad"], materials: 2, surfaces: 1, kept: 0.8 }),
    spoil: () =>
        tell_all(
            (spoiled = {
                ...kFollowed,
                files: ["room.rad"],
                problems: ['room.rad:12: undefined modifier "lampe", did you mean "lamp"?'],
            }),
        ),
    mend: () => ((spoiled = null), tell_all(kFollowed)),
    dumb: () => (dumb = true),
    speak: () => (dumb = false),
    refuse: () =>
        tell_all({ type: "refused", text: "A view without a direction cannot be drawn." }),
    join: () => ((guest = 77), tell_roles()),
    steal: () => ((guest = 77), (driver = 77), tell_roles()),
    leave: () => ((driver = driver === 77 ? null : driver), (guest = null), tell_roles()),
};

async function serve(request, response) {
    const { pathname } = new URL(request.url, "http://localhost");
    if (pathname.startsWith("/fake/")) {
        pranks[pathname.slice(6)]?.();
        return response.end(String(plans));
    }
    if (pathname === "/beside") return response.end(JSON.stringify(beside.told));
    if (pathname === "/save/picture.hdr")
        return setTimeout(
            () => response.end("#?RADIANCE\nVIEW= -vtv\nFORMAT=32-bit_rle_rgbe\n\n"),
            200,
        );
    if (pathname === "/save/lights.rad" || pathname === "/lights")
        return response.end(JSON.stringify(lights.levels));
    if (pathname === "/save/materials.rad" || pathname === "/materials")
        return response.end(JSON.stringify(edited?.materials ?? []));
    if (pathname === "/save/sky.rad" || pathname === "/time")
        return response.end(JSON.stringify(time));
    const name = pathname === "/" ? "index.html" : /^\/page\/([\w.-]+)$/.exec(pathname)?.[1];
    try {
        const body = await readFile(path.join(kPage, name));
        response.writeHead(200, {
            "Content-Type": kTypes[path.extname(name)] || "application/octet-stream",
            "Content-Security-Policy": kPolicy,
            "X-Content-Type-Options": "nosniff",
            "Cache-Control": "no-store",
        });
        response.end(body);
    } catch {
        response.writeHead(404).end("not here");
    }
}

const server = createServer(serve);
new WebSocketServer({ server, path: "/walk" }).on("connection", (socket) => {
    const client = { id: ++last_id, drawn: -1, strip: 0, busy: false, frame: 0 };
    clients.set(socket, client);
    socket.on("message", (data) => {
        if (args.log) console.log(String(data).slice(0, 300));
        if (beside.socket === socket) beside.answer(JSON.parse(String(data)));
        else answer(socket, JSON.parse(String(data)));
    });
    socket.on("close", () => {
        if (beside.close(socket)) return;
        clients.delete(socket);
        if (driver === client.id) driver = null;
        tell_roles();
    });
});
server.listen(Number(args.port), "127.0.0.1", () =>
    console.log(`http://127.0.0.1:${server.address().port}/`),
);
