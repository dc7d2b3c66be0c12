// The luminance under the pointer, from what came with the newest frame: no question to the server.
import { by_id } from "./dom.js";
import { rough } from "./words.js";

const kBeside = 16; // distance from the pointer [CSS pixels]

export class UnderPointer {
    /**
     * @param surface  the picture's element
     * @param ask  {wanted(): bool, luminance(): Luminance or null of what the screen shows, null while it shows anything else}
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
        const seen = this.at_ && this.ask_.wanted() ? this.ask_.luminance() : null;
        this.mark_.hidden = seen === null;
        if (!seen) return;
        const [x, y] = this.at_;
        this.mark_.textContent = `≈ ${rough(seen.at(x / innerWidth, y / innerHeight))} cd/m²`;
        const { offsetWidth: width, offsetHeight: height } = this.mark_;
        const left = x + kBeside + width > innerWidth ? x - kBeside - width : x + kBeside;
        const top = y + kBeside + height > innerHeight ? y - kBeside - height : y + kBeside;
        this.mark_.style.translate = `${Math.round(left)}px ${Math.round(top)}px`;
    }
}
