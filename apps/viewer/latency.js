// From input to picture: how long it takes until a frame shows what a key or a drag asked for.

const kKept = 240;

export class Latency {
    constructor() {
        this.samples = []; ///< [ms], the newest last
        this.waiting_ = []; ///< views sent and not yet shown, ids rising: {id, input}
    }

    /** A view was sent; `input`: when the event came that made it [ms]. */
    sent(id, input) {
        this.waiting_.push({ id, input });
        if (this.waiting_.length > kKept) this.waiting_.shift();
    }

    /** A frame that shows view `id`, and with it all before, is on the screen. */
    shown(id, now) {
        while (this.waiting_.length > 0 && this.waiting_[0].id <= id)
            this.samples.push(now - this.waiting_.shift().input);
        if (this.samples.length > kKept) this.samples.splice(0, this.samples.length - kKept);
    }

    /** Whoever reconnects waits for nothing that was asked before. */
    forget() {
        this.waiting_.length = 0;
    }

    /** The sample below which `share` of the newest samples lie [ms], or nothing. */
    quantile(share) {
        if (this.samples.length === 0) return null;
        const sorted = [...this.samples].sort((a, b) => a - b);
        return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
    }
}
