// Has frames decoded beside the page, by a worker, so that no refresh of the screen waits for it.
import { decode_frame } from "./decoding.js";

export class Decoder {
    constructor() {
        this.started_ = null;
        this.worker_ = null; // until it has said that it works
        this.waiting_ = new Map(); // by number: {resolve, reject}
        this.number_ = 0;
        try {
            this.start_(
                new Worker(new URL("./frame_worker.js", import.meta.url), { type: "module" }),
            );
        } catch (error) {
            console.info("lightwalk: frames are decoded in the page:", error.message);
        }
    }

    /** Whether a worker decodes; else the page does. */
    get beside() {
        return this.worker_ !== null;
    }

    start_(worker) {
        this.started_ = worker;
        worker.onmessage = ({ data }) => {
            if (data.ready) this.worker_ = worker;
            else this.answer_(data);
        };
        worker.onerror = () => {
            this.worker_ = null;
            for (const number of [...this.waiting_.keys()])
                this.answer_({ number, error: "frame: who decodes it has failed" });
        };
    }

    /** Nothing more is decoded. */
    end() {
        this.started_?.terminate();
        this.worker_ = null;
    }

    answer_({ number, decoded, error }) {
        const { resolve, reject } = this.waiting_.get(number);
        this.waiting_.delete(number);
        if (decoded) resolve(decoded);
        else reject(new Error(error));
    }

    /**
     * Decode a frame; see decode_frame().
     * @param frame   of parse_frame()
     * @param buffer  its bytes, which are gone afterwards
     */
    decode(frame, buffer) {
        if (!this.worker_) return decode_frame(frame);
        const number = ++this.number_;
        return new Promise((resolve, reject) => {
            this.waiting_.set(number, { resolve, reject });
            this.worker_.postMessage({ number, buffer }, [buffer]);
        });
    }
}
