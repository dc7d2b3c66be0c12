// The state of the walk: a word at the top, a progress line at the bottom, and a small table on request.
import { by_id, element } from "./dom.js";
import { many, percent, phase_words, pixel_shares, quantity } from "./words.js";

const line = (name, value) =>
    element("div", {}, element("dt", { textContent: name }), element("dd", { textContent: value }));

/** Show the server's phase at the top and its progress along the bottom. */
export function show_phase({ phase, share }) {
    by_id("phase").textContent = phase_words(phase, share);
    // Light is refined further after all of it has come; how far is not known then, and no bar is shown.
    const settling = phase !== "moving" && phase !== "done" && share < 1;
    const bar = by_id("refinement");
    bar.value = phase === "moving" ? 0 : share || 0;
    bar.classList.toggle("idle", !settling);
}

/**
 * The rows of the table.
 * @param state  the server's `state` message; nothing when none has come yet
 * @param page   {latency, latency_95 [ms], width, height, speed [m/s], walk, exposure, megabits}
 */
function show_figures(state, page) {
    const rows = [
        ["Frames a second", quantity(state.fps)],
        ...pixel_shares(state).map(([name, share]) => [name, percent(share)]),
        ["Rays a second", many(state.rays_per_second)],
        ["Refinement", phase_words(state.phase, state.share) || "–"],
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

/** Keep the table up to date while it is visible. state_now() returns the server's newest `state` message. */
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
