// Files for the user: pictures, views, tables.
import { broken_lines } from "./caption.js";
import { element } from "./dom.js";
import { paint_legend } from "./legend.js";

/** A file name of the scene, the date and time, and an extension, e.g. "lodge-20260131-154500.png". */
export function file_name(scene, kind, now = new Date()) {
    const base =
        (scene || "lightwalk")
            .split(/[\\/]/)
            .pop()
            .replace(/\.[^.]*$/, "") || "lightwalk";
    const two = (x) => String(x).padStart(2, "0");
    const day = `${now.getFullYear()}${two(now.getMonth() + 1)}${two(now.getDate())}`;
    const time = `${two(now.getHours())}${two(now.getMinutes())}${two(now.getSeconds())}`;
    return `${base}-${day}-${time}.${kind}`;
}

/** Let the browser download a file. */
export function download(blob, name) {
    const address = URL.createObjectURL(blob);
    element("a", { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
}

export const download_text = (text, name) =>
    download(new Blob([text], { type: "text/plain" }), name);

/**
 * Save the picture as the screen shows it; with false colours their legend is painted into it.
 * @param caption  lines of text, which are written under the picture
 */
export function picture_blob(canvas, display, caption = []) {
    const zoom = canvas.width / innerWidth;
    const source =
        display.mode === "false" || caption.length > 0 ? captioned(canvas, caption, zoom) : canvas;
    if (display.mode === "false")
        paint_legend(source.getContext("2d"), display.scale, canvas.height, zoom);
    return new Promise((resolve, reject) =>
        source.toBlob(
            (blob) => (blob ? resolve(blob) : reject(new Error("no memory for the picture"))),
            "image/png",
        ),
    );
}

/** A copy of the picture with lines of text under it. */
function captioned(canvas, caption, zoom) {
    const line = 18 * zoom,
        margin = 12 * zoom,
        font = `${13 * zoom}px system-ui, sans-serif`;
    const source = element("canvas", { width: canvas.width, height: canvas.height });
    const context = source.getContext("2d");
    context.font = font;
    const measure = (text) => context.measureText(text).width;
    const lines = broken_lines(caption, canvas.width - 2 * margin, measure);
    // Setting a canvas's size resets its context.
    if (lines.length > 0)
        source.height = canvas.height + Math.ceil(lines.length * line + 1.2 * margin);
    context.fillStyle = "#0b0c0e";
    context.fillRect(0, 0, source.width, source.height);
    context.drawImage(canvas, 0, 0);
    context.font = font;
    context.textBaseline = "middle";
    context.fillStyle = "#e8eaec";
    lines.forEach((text, k) =>
        context.fillText(text, margin, canvas.height + 0.6 * margin + (k + 0.5) * line),
    );
    return source;
}

/** The server's picture of the present view in full quality (.hdr); throws Error when it has none. */
export const full_picture = (query) => server_file("picture.hdr", query);

/** A file that the server makes of the walk's state; throws Error when it does not. */
export async function server_file(name, query) {
    const answer = await fetch(`save/${name}${query}`, { cache: "no-store" });
    if (!answer.ok) throw new Error((await answer.text()).slice(0, 200) || `${answer.status}`);
    return answer.blob();
}
