// Roles: one client drives the walk, the others watch.
import { by_id, element } from "./dom.js";

const kReturning = 30000; // how long a driver whose connection broke asks to drive again [ms]

export class Roles {
    /** @param on  {take(), hand(id), changed(driving)} */
    constructor(on) {
        this.on_ = on;
        this.you = null;
        this.driving = false;
        this.returning_until_ = 0;
        this.others_ = [];
        by_id("take").addEventListener("click", () => on.take());
        by_id("hand-to").addEventListener("change", (event) => {
            const other = this.others_[event.target.selectedIndex - 1];
            if (other !== undefined) on.hand(other);
            event.target.selectedIndex = 0;
        });
    }

    welcome({ you, driver }) {
        this.you = you;
        // The `role` message that follows says whether somebody else drives.
        this.set_(driver === true, undefined, [you]);
    }

    /** Take over a `role` message {driver, driver_id, clients}; driver_id is null when nobody drives. */
    update({ driver, driver_id, clients }) {
        const driving = driver_id === undefined ? driver === true : driver_id === this.you;
        this.set_(driving, driver_id, clients || [this.you]);
    }

    /** The connection broke: a page that drove will ask to drive again when it is back within kReturning. */
    lost() {
        if (this.driving) this.returning_until_ = performance.now() + kReturning;
    }

    set_(driving, driver_id, clients) {
        const before = this.driving;
        this.driving = driving;
        this.others_ = clients.filter((id) => id !== this.you);
        const vacant = !driving && driver_id === null;
        if (vacant && performance.now() < this.returning_until_) this.on_.take();
        this.show_(vacant);
        if (before !== driving) this.on_.changed(driving);
    }

    show_(vacant) {
        const count = this.others_.length;
        const hidden = this.driving && count === 0;
        by_id("role").hidden = hidden;
        document.body.classList.toggle("has-role", !hidden);
        by_id("role-text").textContent = this.driving
            ? `${count} watching`
            : vacant
              ? "Nobody drives"
              : "Watching";
        by_id("take").hidden = this.driving;
        by_id("take").disabled = !vacant;
        by_id("take").title = vacant ? "" : "Free when the driver leaves or hands over";
        by_id("hand-over").hidden = !this.driving || count === 0;
        by_id("hand-to").replaceChildren(
            element("option", { textContent: "Hand over…" }),
            ...this.others_.map((id) => element("option", { textContent: `Viewer ${id}` })),
        );
        by_id("picture").classList.toggle("watching", !this.driving);
        // Controls that work for the driver only; glare is for everybody.
        for (const control of document.querySelectorAll("#panel-light input, #walk, #level"))
            control.disabled = !this.driving;
    }
}
