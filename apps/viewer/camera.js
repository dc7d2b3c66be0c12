// The camera of now: draws what the eye sees at each refresh of the screen from the frames that have come.
import { Reprojection } from "./reprojection.js";
import { Sight } from "./sight.js";
import { can_warp, is_picture_of } from "./warp.js";

export class Camera {
    /**
     * @param canvas   over the picture; hidden while the picture itself is what is to be seen
     * @param picture  the canvas that frames are drawn on
     * @param wanted   false: never draw
     * @param refine   whether frames of few pixels are refined also where the processor draws
     */
    constructor(canvas, picture, wanted, refine = false) {
        this.canvas_ = canvas;
        this.picture_ = picture;
        this.view_ = null; // of the newest frame; null: it cannot be drawn from elsewhere
        this.depth_ = null;
        this.sight_ = null; // of the newest frame, once somebody asks
        this.kept_ = true; // whether the newest frame is in the graphics memory
        this.reprojection_ = wanted ? started(canvas) : null;
        this.refines = this.available && (refine || !this.reprojection_.in_software); ///< see Reprojection.keep()
        this.size_ = null; // of the screen's picture
        this.draws = false; ///< whether the screen shows what this draws, instead of the picture
        this.refreshes = 0; ///< that were drawn
    }

    /** Whether frames with depth are of use. */
    get available() {
        return this.reprojection_ !== null;
    }

    /** Whether views may run ahead of the eye, and be wider than the window. */
    get ready() {
        return this.view_ !== null && !this.reprojection_.lost;
    }

    /** What the newest frame hides; null where its depth is not known. */
    get sight() {
        if (this.view_ === null) return null;
        const { width, height } = this.picture_;
        return (this.sight_ ??= new Sight(this.depth_, this.view_, width, height));
    }

    /**
     * A frame is on the picture.
     * @param view   that it shows; null: not known
     * @param depth  undefined: as before
     */
    take(view, depth) {
        if (!this.available) return;
        if (depth !== undefined) this.depth_ = depth;
        this.sight_ = null;
        const before = this.view_;
        this.view_ = this.depth_ && can_warp(view) ? view : null;
        if (this.view_ === null) return;
        this.again_ = this.again_ && before !== null && is_picture_of(before, view);
        this.kept_ = false;
        // While the eye rests the picture is what is seen, and is kept only when the eye moves.
        if (this.draws) this.keep_();
    }

    /** The picture has other colours than when its frame came. */
    recoloured() {
        if (!this.available || this.view_ === null) return;
        this.again_ = true;
        this.kept_ = false;
        if (this.draws) this.keep_();
    }

    keep_() {
        this.kept_ = true;
        const frame = { picture: this.picture_, depth: this.depth_, view: this.view_ };
        const size = this.refines && this.size_ ? this.size_ : undefined;
        this.reprojection_.keep(frame, this.again_ ?? false, size);
        this.again_ = true; // until a frame of another view comes
    }

    /** The frames so far show something else than those to come: these do not fill their gaps. */
    forget() {
        this.reprojection_?.forget();
        this.kept_ = this.again_ = false;
    }

    /** Nothing is drawn any more: the graphics memory is free. */
    end() {
        this.reprojection_?.end();
        this.reprojection_ = null;
    }

    /**
     * Draw `view`, of a picture of that size [pixels], unless the picture shows just that. Returns whether it was drawn.
     * @param part  of the picture that is to be seen: from and to, 0..1 from the left
     */
    draw(view, { width, height }, part = [0, 1]) {
        this.draws = this.draw_(view, width, height, part);
        if (this.canvas_.hidden === this.draws) this.canvas_.hidden = !this.draws;
        return this.draws;
    }

    draw_(view, width, height, part) {
        if (!this.ready || !view || !can_warp(view) || is_picture_of(this.view_, view))
            return false;
        this.size_ = [width, height];
        if (!this.kept_) this.keep_();
        if (!this.reprojection_.has_frame) return false;
        this.reprojection_.draw(view, width, height, part);
        ++this.refreshes;
        return true;
    }
}

function started(canvas) {
    try {
        return new Reprojection(canvas);
    } catch (error) {
        console.info("lightwalk: frames are shown as they come:", error.message);
        return null;
    }
}
