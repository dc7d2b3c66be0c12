// How the walk goes: a word in the head, a line at the bottom, and a small table for who asks.
import { by_id, element } from "./dom.js";
import { many, percent, quantity } from "./words.js";

const kWords = {
    moving: "",
    filling: "filling in",
    refining: "refining",
    ambient: "ambient light",
    done: "settled",
};

const line = (name, value) =>
    element("div", {}, element("dt", { textContent: name }), element("dd", { textContent: value }));

/** The server's state in the head and along the bottom. */
export function show_phase({ phase, share }) {
    const settling = phase !== "moving" && phase !== "done";
    const words = kWords[phase] ?? "";
    by_id("phase").textContent =
        settling && Number.isFinite(share) ? `${words} ${percent(share)}` : words;
    const bar = by_id("refinement");
    bar.value = phase === "done" ? 1 : settling ? share || 0 : 0;
    bar.classList.toggle("idle", !settling);
}

/**
 * The table.
 * @param state  of the server; nothing: not known yet
 * @param page   {latency, latency_95 [ms], width, height, speed [m/s], walk, exposure, megabits}
 */
function show_figures(state, page) {
    const rows = [
        ["Frames a second", quantity(state.fps)],
        ["Reused", Number.isFinite(state.reuse) ? percent(state.reuse) : "–"],
        ["Rays a second", many(state.rays_per_second)],
        ["Refinement", state.phase === "done" ? "settled" : percent(state.share || 0)],
        ["Latency", page.latency === null ? "–" : `${Math.round(page.latency)} ms`],
        ["95 % within", page.latency_95 === null ? "–" : `${Math.round(page.latency_95)} ms`],
        ["Ranks × threads", `${state.ranks ?? "–"} × ${state.threads ?? "–"}`],
        ["Points", many(state.points)],
        ["Picture", `${page.width} × ${page.height}`],
        ["Network", `${page.megabits.toFixed(1)} Mbit/s`],
        [page.walk ? "Walking" : "Flying", `${quantity(page.speed)} m/s`],
    ];
    by_id("figures").replaceChildren(...rows.map((row) => line(...row)));
}

/** Keep the table up to date while it is seen. state_now(): of the server. */
export function start_figures(session, navigator, picture, state_now) {
    let before = 0;
    setInterval(() => {
        const bits = (session.connection.bytes - before) * 8;
        before = session.connection.bytes;
        show_figures(state_now(), {
            latency: session.latency.quantile(0.5),
            latency_95: session.latency.quantile(0.95),
            width: picture.width,
            height: picture.height,
            speed: navigator.speed,
            walk: navigator.walk,
            megabits: bits / 1e6,
        });
    }, 1000);
}
