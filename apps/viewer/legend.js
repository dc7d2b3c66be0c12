// The legend of false colours: beside the picture, and in pictures that are saved.
import { difference_colour, difference_place, kDifferences, share_text } from "./difference.js";
import { by_id, shape } from "./dom.js";
import { colour_text, palette_colour, scale_ticks, share_of } from "./scale.js";
import { round_number } from "./words.js";

const kSteps = 48; // colour stops of the gradient
const kWidth = 14; // width of the bar [CSS pixels]
const kPerTick = 34; // height of the bar for each number beside it [CSS pixels]

const ticks_for = (scale, height) => scale_ticks(scale, Math.max(2, Math.floor(height / kPerTick)));

function gradient() {
    const made = shape("linearGradient", { id: "scale-colours", x1: 0, y1: 1, x2: 0, y2: 0 });
    for (let k = 0; k <= kSteps; ++k)
        made.append(
            shape("stop", {
                offset: k / kSteps,
                "stop-color": colour_text(palette_colour(k / kSteps)),
            }),
        );
    return made;
}

/** Draw the legend of differences, or hide it. */
export function show_difference_legend(shown) {
    by_id("difference-legend").hidden = !shown;
    if (!shown) return;
    const svg = by_id("difference-bar"),
        height = svg.clientHeight || 200;
    const colours = shape("linearGradient", {
        id: "difference-colours",
        x1: 0,
        y1: 1,
        x2: 0,
        y2: 0,
    });
    for (let k = 0; k <= kSteps; ++k)
        colours.append(
            shape("stop", {
                offset: k / kSteps,
                "stop-color": colour_text(difference_colour((2 * k) / kSteps - 1)),
            }),
        );
    const bar = { x: 0.5, y: 0.5, width: kWidth, height: height - 1, rx: 2 };
    svg.replaceChildren(colours, shape("rect", { ...bar, fill: "url(#difference-colours)" }));
    for (const share of kDifferences) {
        const y = height - ((difference_place(1, 1 + share) + 1) / 2) * (height - 1) - 0.5;
        svg.append(
            shape("line", { x1: kWidth, x2: kWidth + 5, y1: y, y2: y, class: "tick" }),
            shape("text", { x: kWidth + 10, y, "dominant-baseline": "central" }, share_text(share)),
        );
    }
}

/** Draw the legend beside the picture, or hide it. */
export function show_legend(display) {
    by_id("legend").hidden = display.mode !== "false";
    if (display.mode !== "false") return;
    const svg = by_id("legend-bar"),
        { scale } = display;
    const height = svg.clientHeight || 200;
    const bar = { x: 0.5, y: 0.5, width: kWidth, height: height - 1, rx: 2 };
    svg.replaceChildren(gradient(), shape("rect", { ...bar, fill: "url(#scale-colours)" }));
    for (const tick of ticks_for(scale, height)) {
        const y = height - share_of(scale, tick) * (height - 1) - 0.5;
        svg.append(
            shape("line", { x1: kWidth, x2: kWidth + 5, y1: y, y2: y, class: "tick" }),
            shape(
                "text",
                { x: kWidth + 10, y, "dominant-baseline": "central" },
                round_number(tick),
            ),
        );
    }
    const steps = scale.log ? "logarithmic" : "linear";
    svg.setAttribute(
        "aria-label",
        `${steps} scale from ${round_number(scale.low)} to ${round_number(scale.high)} candela per square metre`,
    );
}

/** Paint the legend into a picture of `height` pixels, in the size that it has in the page. */
export function paint_legend(context, scale, height, zoom) {
    const bar = {
        left: 18 * zoom,
        width: kWidth * zoom,
        height: Math.min(380 * zoom, height * 0.6),
    };
    const top = (height - bar.height) / 2;
    for (let y = 0; y < bar.height; ++y) {
        context.fillStyle = colour_text(palette_colour(1 - y / bar.height));
        context.fillRect(bar.left, top + y, bar.width, 1.5);
    }
    context.font = `${13 * zoom}px system-ui, sans-serif`;
    context.textBaseline = "middle";
    context.lineJoin = "round";
    context.lineWidth = 3 * zoom;
    context.strokeStyle = "rgb(0 0 0 / 65%)";
    const write = (text, x, y) => {
        context.strokeText(text, x, y);
        context.fillStyle = "#fff";
        context.fillText(text, x, y);
    };
    write("cd/m²", bar.left, top - 14 * zoom);
    for (const tick of ticks_for(scale, bar.height / zoom)) {
        const y = top + bar.height * (1 - share_of(scale, tick));
        context.fillStyle = "#fff";
        context.fillRect(bar.left + bar.width, y - zoom / 2, 5 * zoom, zoom);
        write(round_number(tick), bar.left + bar.width + 10 * zoom, y);
    }
}
