// What the browser stores: for this tab its session id, and for each scene views, keys of a path and pins.
// In a browser that stores nothing (private windows, full disks) the walk works, but nothing is restored.

function read(storage, key) {
    try {
        return JSON.parse(storage().getItem(key));
    } catch {
        return null;
    }
}

function write(storage, key, value) {
    try {
        storage().setItem(key, JSON.stringify(value));
        return true;
    } catch {
        return false;
    }
}

const tab = () => sessionStorage;
const kept = () => localStorage;

/** The session id, 32 hex digits that last as long as the tab: the server recognises a client that returns. */
export function session_id() {
    const known = read(tab, "lightwalk.session");
    if (typeof known === "string" && /^[0-9a-f]{16,64}$/.test(known)) return known;
    const bytes = crypto.getRandomValues(new Uint8Array(16));
    const id = Array.from(bytes, (b) => b.toString(16).padStart(2, "0")).join("");
    write(tab, "lightwalk.session", id);
    return id;
}

/** The value stored for a scene under a name; `fallback` where there is none, or one of another type. */
export function scene_item(scene, name, fallback) {
    const value = read(kept, `lightwalk.${name}.${scene}`);
    return Array.isArray(value) === Array.isArray(fallback) && value !== null ? value : fallback;
}

export const keep_scene_item = (scene, name, value) =>
    write(kept, `lightwalk.${name}.${scene}`, value);
