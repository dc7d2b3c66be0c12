// Which of two sides the panels show, where two states of a scene are compared. Does not use the document.

export class Sides {
    /** @param on  {TYPE(message)}: what the panels do with messages of the side that they show */
    constructor(on) {
        this.on_ = on;
        this.shown = "A";
        this.waiting_ = { A: new Map(), B: new Map() }; // the newest message of each type, for panels that show the other side
        this.about = { A: {}, B: {} }; ///< {hour, materials, lamps}: what is known of a side
    }

    /** Handlers of a side's session, for messages of these types. */
    handlers(side, types) {
        return Object.fromEntries(
            types.map((type) => [type, (message) => this.take(side, message)]),
        );
    }

    take(side, message) {
        this.note(side, message);
        if (side === this.shown) return this.on_[message.type](message);
        const waiting = this.waiting_[side];
        waiting.delete(message.type); // it comes after what has come before it
        waiting.set(message.type, message);
    }

    /** A message from or to the server may tell of a side. */
    note(side, message) {
        const about = this.about[side];
        if (message.type === "loaded") {
            about.file_hour = message.time?.time?.hour;
            about.hour = about.file_hour;
        } else if (message.type === "time") about.hour = message.time?.hour ?? about.file_hour;
        else if (message.type === "edited") about.materials = message.materials.length;
        else if (message.type === "lights") about.lamps = message.levels.length;
        else if (message.type === "state") about.settled = message.phase === "done";
    }

    /** The panels show a side from now on, and hear what was waiting for it. */
    show(side) {
        this.shown = side;
        const waiting = [...this.waiting_[side].values()];
        this.waiting_[side].clear();
        for (const message of waiting) this.on_[message.type](message);
    }

    forget(side) {
        this.waiting_[side].clear();
        this.about[side] = {};
    }
}
