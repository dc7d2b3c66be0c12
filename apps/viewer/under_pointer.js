// The luminance under the pointer, from what came with the newest frame: no question to the server.
import { share_text } from "./difference.js";
import { by_id } from "./dom.js";
import { rough } from "./words.js";

const kBeside = 16; // distance from the pointer [CSS pixels]

export class UnderPointer {
    /**
     * @param surface  the picture's element
     * @param ask  {wanted(): bool, luminance(x): Luminance or null of what the screen shows at x, 0..1 from the left, null while it
     *     shows anything else; before(): the same of what a difference is shown from, null where none is}
     */
    constructor(surface, ask) {
        this.mark_ = by_id("under");
        this.ask_ = ask;
        this.at_ = null; // [x, y] [CSS pixels]
        surface.addEventListener("pointermove", (event) => {
            const free = event.pointerType !== "touch" && event.buttons === 0;
            this.at_ = free ? [event.clientX, event.clientY] : null;
            this.show();
        });
        surface.addEventListener("pointerleave", () => {
            this.at_ = null;
            this.show();
        });
    }

    /** The pointer, or what is under it, may have changed. */
    show() {
        const seen =
            this.at_ && this.ask_.wanted() ? this.ask_.luminance(this.at_[0] / innerWidth) : null;
        this.mark_.hidden = seen === null;
        if (!seen) return;
        const [x, y] = this.at_;
        const place = [x / innerWidth, y / innerHeight];
        const now = seen.at(...place),
            before = this.ask_.before()?.at(...place);
        const change = before === undefined ? "" : ` (${share_text(now / before - 1)})`;
        this.mark_.textContent = `≈ ${rough(now)} cd/m²${change}`;
        const { offsetWidth: width, offsetHeight: height } = this.mark_;
        const left = x + kBeside + width > innerWidth ? x - kBeside - width : x + kBeside;
        const top = y + kBeside + height > innerHeight ? y - kBeside - height : y + kBeside;
        this.mark_.style.translate = `${Math.round(left)}px ${Math.round(top)}px`;
    }
}
