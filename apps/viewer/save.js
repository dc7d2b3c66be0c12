// Files for the user: pictures, views, tables.
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

/** Save the picture as the screen shows it; with false colours their legend is painted into it. */
export function picture_blob(canvas, display) {
    let source = canvas;
    if (display.mode === "false") {
        source = element("canvas", { width: canvas.width, height: canvas.height });
        const context = source.getContext("2d");
        context.drawImage(canvas, 0, 0);
        paint_legend(context, display.scale, canvas.height, canvas.width / canvas.clientWidth);
    }
    return new Promise((resolve, reject) =>
        source.toBlob(
            (blob) => (blob ? resolve(blob) : reject(new Error("no memory for the picture"))),
            "image/png",
        ),
    );
}

/** Save the server's picture of the present view in full quality (.hdr); throws Error when it has none. */
export async function full_picture(query) {
    const answer = await fetch(`save/picture.hdr${query}`, { cache: "no-store" });
    if (!answer.ok) throw new Error((await answer.text()).slice(0, 200) || `${answer.status}`);
    return answer.blob();
}
