// The card that shows luminance and illuminance at the point that was clicked.
import { by_id, element, remove_button } from "./dom.js";
import { locate } from "./view.js";
import { known, place, quantity, within } from "./words.js";

const kApart = 18; // distance of the card from its point [CSS pixels]
const kDock = 72; // height of the dock [CSS pixels]
const kTooNarrow = 560; // in narrower windows the card has a fixed place [CSS pixels]

const line = (name, value) =>
    element("div", {}, element("dt", { textContent: name }), element("dd", { textContent: value }));

export class Reading {
    /** @param on  {pin(pick), closed()} */
    constructor(on) {
        this.card_ = by_id("reading");
        this.on_ = on;
        this.pick = null; ///< the server's `picked` message, with at: [x, y], the point that was asked for
    }

    /** Show the answer to a pick: {hit, luminance, illuminance, distance, position, normal, ...}. */
    show(pick) {
        this.pick = pick;
        const rows = pick.hit
            ? [
                  ["Illuminance", known(pick.illuminance, pick.illuminance_95, "lx")],
                  ["Distance", `${quantity(pick.distance)} m`],
                  ["Material", pick.material || "–"],
                  ["Surface", pick.surface || "–"],
                  ["At", place(pick.position)],
              ]
            : [["", "No surface there: sky or void"]];
        const value = element(
            "p",
            { className: "value", textContent: quantity(pick.luminance) },
            element("small", {
                textContent: [
                    "cd/m²",
                    within(pick.luminance, pick.luminance_95),
                    pick.side && `· ${pick.side}`,
                ]
                    .filter(Boolean)
                    .join(" "),
            }),
        );
        const head = element(
            "header",
            {},
            value,
            remove_button("reading", () => this.close()),
        );
        const card = [head, element("dl", {}, ...rows.map((row) => line(...row)))];
        if (pick.hit) {
            const pin = element("button", {
                type: "button",
                textContent: "Pin",
                id: "pin",
                title: "P",
            });
            pin.onclick = () => this.pin();
            card.push(element("div", { className: "row" }, pin));
        }
        this.card_.replaceChildren(...card);
        this.card_.hidden = false;
    }

    pin() {
        if (!this.pick?.hit) return;
        this.on_.pin(this.pick);
        this.close();
    }

    close() {
        if (!this.pick) return false;
        this.pick = null;
        this.card_.hidden = true;
        this.on_.closed();
        return true;
    }

    /** Put the card beside its point, within the window; hide it while the point is out of sight. */
    follow(view) {
        if (!this.pick) return;
        const at = this.pick.hit && view ? locate(view, this.pick.position) : null;
        this.card_.hidden = at !== null && !at.visible;
        if (this.card_.hidden) return;
        const [x, y] = at ? [at.x, at.y] : this.pick.at;
        const { offsetWidth: width, offsetHeight: height } = this.card_;
        const [left, top] = this.corner_(x * innerWidth, (1 - y) * innerHeight, width, height);
        this.card_.style.translate = `${Math.round(left)}px ${Math.round(top)}px`;
    }

    corner_(x, y, width, height) {
        const right = innerWidth - width - 8,
            bottom = innerHeight - height - kDock;
        // In a narrow window the card takes the upper or lower half, whichever does not have the point.
        if (innerWidth < kTooNarrow)
            return [(innerWidth - width) / 2, y > innerHeight / 2 ? 48 : bottom];
        const left = x + kApart > right ? x - kApart - width : x + kApart;
        return [Math.max(8, left), Math.max(8, Math.min(bottom, y - height / 2))];
    }
}
