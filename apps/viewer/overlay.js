// Marks drawn over the picture: pins at their places in the scene, areas, sources of glare.
import { shape } from "./dom.js";
import { locate, same_picture } from "./view.js";
import { known, rough } from "./words.js";

export class Overlay {
    constructor(svg) {
        this.svg_ = svg;
    }

    /**
     * Draw all marks for the view that the screen shows.
     * @param view   nothing when it is not known: then only marks that are given in the picture's plane are drawn
     * @param marks  {probes, areas, reading, drag, sources}: see measurements.js, reading.js;
     *     drag: [x0, y0, x1, y1] in CSS pixels; sources: of glare, outlines in shares of the picture;
     *     contours: as IsoluxPanel.marks() returns them
     */
    draw(view, { probes, areas, reading, drag, sources, contours }) {
        this.pixels_ = (x, y) => [x * innerWidth, (1 - y) * innerHeight];
        const shapes = sources.flatMap((source) => this.source_(source));
        // Labels lie over all lines.
        shapes.push(...contours.flatMap((contour) => this.contour_(contour)));
        shapes.push(...contours.flatMap((contour) => this.level_(contour)));
        if (view) {
            for (const area of areas)
                if (same_picture(area.view, view)) shapes.push(...this.area_(area));
            for (const probe of probes) shapes.push(...this.pin_(view, probe));
            if (reading?.position) shapes.push(...this.mark_(view, reading.position));
        }
        if (drag) shapes.push(...this.box_(drag, ""));
        if (shapes.length > 0 || this.svg_.hasChildNodes()) this.svg_.replaceChildren(...shapes);
    }

    pin_(view, probe) {
        const at = locate(view, probe.position);
        if (!at.visible) return [];
        const [x, y] = this.pixels_(at.x, at.y);
        const value = Number.isFinite(probe.illuminance)
            ? ` ${known(probe.illuminance, probe.illuminance_95, "lx")}`
            : "";
        return [
            shape("circle", { cx: x, cy: y, r: 5, class: "pin" }),
            shape("text", { x: x + 10, y, "dominant-baseline": "central" }, probe.name + value),
        ];
    }

    mark_(view, position) {
        const at = locate(view, position);
        if (!at.visible) return [];
        const [x, y] = this.pixels_(at.x, at.y);
        const cross = `M${x - 11} ${y}h7M${x + 4} ${y}h7M${x} ${y - 11}v7M${x} ${y + 4}v7`;
        return ["halo", "mark"].map((name) => shape("path", { d: cross, class: name }));
    }

    area_({ rect, name, luminance, luminance_95 }) {
        const [x0, y1] = this.pixels_(rect[0], rect[1]);
        const [x1, y0] = this.pixels_(rect[2], rect[3]);
        const value = Number.isFinite(luminance)
            ? ` ${known(luminance, luminance_95, "cd/m²")}`
            : "";
        return this.box_([x0, y0, x1, y1], name + value);
    }

    box_([x0, y0, x1, y1], words) {
        const x = Math.min(x0, x1),
            y = Math.min(y0, y1);
        const size = { width: Math.abs(x1 - x0), height: Math.abs(y1 - y0) };
        const box = shape("rect", { x, y, ...size, class: "area" });
        // The label is above the box, or inside where it would leave the window.
        const line = y > 24 ? y - 9 : y + 14;
        return words ? [box, shape("text", { x: x + 2, y: line }, words)] : [box];
    }

    contour_({ d, colour, outdated }) {
        const line = { d, class: outdated ? "contour outdated" : "contour", stroke: colour };
        return [shape("path", { d, class: "halo thin" }), shape("path", line)];
    }

    level_({ words, at }) {
        if (!at) return [];
        const place = { x: at[0], y: at[1], "text-anchor": "middle" };
        return [shape("text", { ...place, "dominant-baseline": "central" }, words)];
    }

    source_({ outline, luminance }) {
        const points = outline.map(([x, y]) => this.pixels_(x, y));
        if (points.length === 0) return [];
        const left = Math.min(...points.map((p) => p[0])),
            top = Math.min(...points.map((p) => p[1]));
        return [
            shape("polygon", { points: points.map((p) => p.join(",")).join(" "), class: "source" }),
            shape(
                "text",
                { x: left, y: top > 24 ? top - 8 : top + 16 },
                `≈ ${rough(luminance)} cd/m²`,
            ),
        ];
    }
}
