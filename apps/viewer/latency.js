// Latency from input to picture: the time until a frame shows what a key or a drag asked for.

const kKept = 240;

export class Latency {
    constructor() {
        this.samples = []; ///< latencies [ms], the newest last
        this.waiting_ = []; ///< views sent and not yet shown, ids rising: {id, input}
    }

    /** Note that view `id` was sent; `input`: time of the event that caused it [ms]. */
    sent(id, input) {
        this.waiting_.push({ id, input });
        if (this.waiting_.length > kKept) this.waiting_.shift();
    }

    /** Note that a frame of view `id` is on the screen, which answers all earlier views as well. */
    shown(id, now) {
        while (this.waiting_.length > 0 && this.waiting_[0].id <= id)
            this.samples.push(now - this.waiting_.shift().input);
        if (this.samples.length > kKept) this.samples.splice(0, this.samples.length - kKept);
    }

    /** Forget the views that wait for an answer: after a new connection none will come. */
    forget() {
        this.waiting_.length = 0;
    }

    /** The quantile `share` (0..1) of the newest samples [ms], or nothing without samples. */
    quantile(share) {
        if (this.samples.length === 0) return null;
        const sorted = [...this.samples].sort((a, b) => a - b);
        return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
    }
}
