// A client of a walk that needs no browser, and how its eye moves.
import { parse_frame } from "../apps/viewer/frame.js";

const kDegrees = 40; // a second
const kSession = "0123456789abcdef";
const kPace = 0.8; // eye heights a second

export const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Of a way there and back, two seconds each, how far one is after `t` seconds [s]. */
const there_and_back = (t) => 2 - Math.abs((t % 4) - 2);

/**
 * The view after `t` seconds of a move: `turn` about the z axis, `look` the same there and back, `walk` forward and back, `both` a walk and a
 * turn.
 */
export function moved(view, move, t, eye_height) {
    const turns = { turn: t, both: t, look: there_and_back(t), walk: 0 }[move];
    const angle = (kDegrees * turns * Math.PI) / 180;
    const [x, y, z] = view.direction;
    const direction = [
        x * Math.cos(angle) + y * Math.sin(angle),
        y * Math.cos(angle) - x * Math.sin(angle),
        z,
    ];
    const goes = move === "walk" || move === "both";
    const way = goes ? (kPace * eye_height * there_and_back(t)) / Math.hypot(x, y) : 0;
    const position = view.position.map((p, k) => p + (k < 2 ? way * view.direction[k] : 0));
    return { ...view, direction, position };
}

/** One client: sends views, acknowledges frames and keeps them. */
export class Client {
    /**
     * @param WebSocket  the class
     * @param address    URL of the server
     * @param size       of the pictures that it asks for [width, height]
     * @param delay      of messages, each way [ms]
     * @param parse      of a frame's bytes
     */
    constructor(WebSocket, address, size, delay = 0, parse = parse_frame) {
        this.socket = new WebSocket(`ws://127.0.0.1:${address.port}/walk`);
        this.size_ = size;
        this.delay_ = delay;
        this.parse_ = parse;
        this.socket.binaryType = "arraybuffer";
        this.frames = [];
        this.states = [];
        this.views = new Map();
        this.bytes = this.id = 0;
        this.socket.on("open", () =>
            this.say({ type: "hello", session: kSession, depth: true, luminance: true }),
        );
        this.loaded = new Promise((resolve) => (this.on_loaded = resolve));
        this.socket.on("message", (data, binary) => this.later_(() => this.take(data, binary)));
    }

    later_(act) {
        if (this.delay_ > 0) setTimeout(act, this.delay_);
        else act();
    }

    say(message) {
        this.later_(() => this.socket.send(JSON.stringify(message)));
    }

    take(data, binary) {
        if (!binary) {
            const message = JSON.parse(Buffer.from(data).toString());
            if (message.type === "loaded") this.on_loaded(message);
            if (message.type === "state") this.states.push(message);
            return;
        }
        const frame = this.parse_(data);
        this.say({ type: "ack", frame: frame.frame });
        this.bytes += data.byteLength;
        this.frames.push({ ...frame, at: performance.now() });
        this.on_frame?.(frame);
    }

    look(view, moving) {
        const [width, height] = this.size_;
        this.views.set(++this.id, view);
        this.say({ type: "view", id: this.id, view, width, height, moving, walk: false });
    }
}

/** Stand still until the picture is good, with the exposure that it has got. */
export async function stand(client, first) {
    client.look(first, false);
    await wait(5000);
    client.say({
        type: "display",
        mode: "tone",
        exposure: { auto: false, ev: Math.log2(client.frames.at(-1).exposure) },
        human: false,
        scale: { low: 1, high: 1000, log: true },
    });
    await wait(500);
}
