// Asks the server for the frames of what the eye sees: which views, and how often.
import { margin_for, turn_between } from "./warp.js";

const kFastest = 12; // least time between two views, also on fast screens: the server limits the rate [ms]

export class ViewSender {
    /** @param parts  {session, navigator, camera, size(): of the picture for this window {width, height}} */
    constructor({ session, navigator, camera, size }) {
        Object.assign(this, { session, navigator, camera, size });
        this.asked_ = 0; // when it was last time for a view [ms]
    }

    /** Whether it is time for another view; if so, the next one is due a while later. */
    is_due(now) {
        if (now - this.asked_ < kFastest) return false;
        this.asked_ = now;
        return true;
    }

    /**
     * Send a view. While the eye moves, and the page draws the camera by itself, it is where the eye will be when its frame is
     * there, and wider than the window.
     * @param step  {view, moving, walk}: of Navigator.tick()
     * @param now   [ms]
     * @returns whether it was sent: the server may have it already
     */
    send(step, now) {
        const { session, navigator, camera } = this;
        if (!step.moving || !camera.ready || step.view.type !== "v")
            return session.send_view(step, this.size(), navigator.epoch);
        const { ahead, apart } = session.times;
        const view = navigator.ahead(now, ahead);
        const turn =
            turn_between(view, step.view) * Math.min(1, (apart + 0.3 * ahead) / ahead || 0);
        const factor = margin_for(step.view, turn);
        const own = { ...step, view, seen: step.view };
        return session.send_view(own, this.size(), navigator.epoch, factor);
    }
}
