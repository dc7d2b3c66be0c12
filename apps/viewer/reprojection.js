// Draws frames from views that are not theirs, in WebGL2: the newest frame, earlier ones in its gaps, a sheet behind them.
import { background_of, grid_triangles } from "./background.js";
import { kNumbers, kPatchRow } from "./depth.js";
import { compiled, made_texture } from "./graphics.js";
import { draws_in_software, Refinement } from "./refinement.js";
import { kPatches, kSheet } from "./shaders.js";
import { warp_of } from "./warp.js";

const kFrames = 2; // that are kept
const kOverlap = 0.3; // see the shader [pixels]

/** Corners of two triangles for each patch, four vertices each. */
function patch_triangles(count) {
    const corners = new Uint32Array(6 * count);
    for (let k = 0; k < count; ++k) {
        const first = 4 * k;
        corners.set([first, first + 1, first + 2, first + 2, first + 1, first + 3], 6 * k);
    }
    return corners;
}

/** A frame in the graphics memory. */
class KeptFrame {
    constructor(gl) {
        this.gl_ = gl;
        this.raw = made_texture(gl, gl.LINEAR); // as it came
        this.refined = made_texture(gl, gl.LINEAR);
        this.refined_size = [0, 0];
        this.is_refined = false;
        this.patches = made_texture(gl, gl.NEAREST);
        this.size_ = "";
        this.places_ = gl.createBuffer();
        this.corners_ = gl.createBuffer();
        this.sheet_array = gl.createVertexArray();
        gl.bindVertexArray(this.sheet_array);
        gl.bindBuffer(gl.ARRAY_BUFFER, this.places_);
        gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 20, 0);
        gl.vertexAttribPointer(1, 2, gl.FLOAT, false, 20, 12);
        gl.enableVertexAttribArray(0);
        gl.enableVertexAttribArray(1);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.corners_);
        gl.bindVertexArray(null);
    }

    /** What it shows. */
    get texture() {
        return this.is_refined ? this.refined : this.raw;
    }

    /** Half a pixel of that [pixels of the frame]. */
    get inset() {
        return this.is_refined ? (0.5 * this.width) / this.refined_size[0] : 0.5;
    }

    /** Take over a frame; see Reprojection.keep(). */
    take({ picture, depth, view }) {
        const gl = this.gl_;
        const { width, height } = picture;
        Object.assign(this, { view, width, height, step: depth.step, count: depth.count });
        this.is_refined = false;
        gl.bindTexture(gl.TEXTURE_2D, this.raw);
        const resized = this.size_ !== `${width} ${height}`;
        if (resized) gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, picture);
        else gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, gl.RGBA, gl.UNSIGNED_BYTE, picture);
        gl.bindTexture(gl.TEXTURE_2D, this.patches);
        const row = (kPatchRow * kNumbers) / 4;
        const rows = depth.patches.length / (kPatchRow * kNumbers);
        gl.texImage2D(
            gl.TEXTURE_2D,
            0,
            gl.RGBA16UI,
            row,
            rows,
            0,
            gl.RGBA_INTEGER,
            gl.UNSIGNED_SHORT,
            depth.patches,
        );
        depth.background ??= background_of(depth, width, height);
        const { columns, rows: sheet_rows, places } = depth.background;
        gl.bindBuffer(gl.ARRAY_BUFFER, this.places_);
        gl.bufferData(gl.ARRAY_BUFFER, places, gl.STREAM_DRAW);
        if (resized) {
            gl.bindVertexArray(this.sheet_array);
            const corners = grid_triangles(columns, sheet_rows);
            gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
            gl.bindVertexArray(null);
            this.corner_count = corners.length;
        }
        this.size_ = `${width} ${height}`;
    }
}

export class Reprojection {
    /** @param canvas  its own, of any size. Throws Error where there is no WebGL2. */
    constructor(canvas) {
        this.canvas = canvas;
        this.gl_ = canvas.getContext("webgl2", { alpha: false, antialias: false });
        if (!this.gl_) throw new Error("WebGL2 is not there");
        this.in_software = draws_in_software(this.gl_); ///< the processor draws
        this.frames_ = []; // the newest first
        this.lost = false; ///< the graphics memory is gone, for now
        canvas.addEventListener("webglcontextlost", (event) => {
            event.preventDefault();
            this.lost = true;
            this.frames_ = [];
        });
        canvas.addEventListener("webglcontextrestored", () => this.start_());
        this.start_();
    }

    start_() {
        const gl = this.gl_;
        this.patches_ = compiled(gl, kPatches);
        this.sheet_ = compiled(gl, kSheet);
        this.refinement_ = new Refinement(gl);
        this.patch_array_ = gl.createVertexArray();
        gl.bindVertexArray(this.patch_array_);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
        gl.bindVertexArray(null);
        this.corners_there_ = 0;
        this.lost = false;
    }

    /** Whether there is a frame to draw. */
    get has_frame() {
        return !this.lost && this.frames_.length > 0;
    }

    /**
     * Keep a frame, as the newest.
     * @param frame  {picture, depth, view}: picture: a canvas; depth: as decode_depth() or decode_frame() returns it; view: that it shows
     * @param again  whether it replaces the newest one, which shows the same view
     * @param size   of the screen's picture [width, height]: a smaller frame is refined by those before it; nothing: it is not
     */
    keep(frame, again, size) {
        if (this.lost) return;
        let kept = again ? this.frames_.shift() : undefined;
        const [before] = this.frames_;
        if (!kept && this.frames_.length >= kFrames) kept = this.frames_.pop();
        kept ??= new KeptFrame(this.gl_);
        kept.take(frame);
        if (size && this.refinement_.is_worth(kept, size[0])) this.refine_(kept, before, size);
        this.frames_.unshift(kept);
    }

    refine_(kept, before, size) {
        const draw = (program) => {
            this.test_depth_();
            this.draw_patches_(program, before, kept.view, {
                own: [0, 0.49],
                guesses: [0.5, 0.49],
                down: true,
            });
        };
        this.refinement_.refine(kept, before && draw, size);
        kept.is_refined = true;
    }

    test_depth_() {
        const gl = this.gl_;
        gl.enable(gl.DEPTH_TEST);
        gl.depthFunc(gl.LESS);
    }

    forget() {
        this.frames_ = [];
    }

    /** Give the graphics memory back. */
    end() {
        this.forget();
        this.gl_.getExtension("WEBGL_lose_context")?.loseContext();
    }

    /** Draw what `view` shows, width x height pixels; of these the part between two shares of the width. */
    draw(view, width, height, [from, to] = [0, 1]) {
        const { gl_: gl, canvas } = this;
        if (canvas.width !== width || canvas.height !== height) {
            canvas.width = width;
            canvas.height = height;
        }
        gl.viewport(0, 0, width, height);
        const left = Math.floor(from * width);
        gl.enable(gl.SCISSOR_TEST);
        gl.scissor(left, 0, Math.ceil(to * width) - left, height);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        this.test_depth_();
        // What frames know, the newest first; what the newest guesses; the sheet.
        const layers = this.frames_.length + 2;
        const layer = (k) => [k / layers, 0.99 / layers];
        this.frames_.forEach((frame, k) => {
            const own = layer(k),
                guesses = layer(layers - 2);
            this.draw_patches_(this.patches_, frame, view, { own, guesses, down: false });
        });
        const [newest] = this.frames_;
        this.use_(this.sheet_, newest, view, layer(layers - 1));
        gl.bindVertexArray(newest.sheet_array);
        gl.drawElements(gl.TRIANGLES, newest.corner_count, gl.UNSIGNED_INT, 0);
        gl.bindVertexArray(null);
        gl.disable(gl.SCISSOR_TEST);
    }

    /** @param layers  {own, guesses, down}: of what the frame knows and of what it guesses; whether the picture has its first row below */
    draw_patches_(program, frame, view, { own, guesses, down }) {
        const gl = this.gl_;
        this.use_(program, frame, view, own, down);
        gl.uniform2fv(program.at.guesses, guesses);
        gl.uniform1f(program.at.overlap, kOverlap);
        gl.uniform1f(program.at.inset, frame.inset);
        gl.activeTexture(gl.TEXTURE1);
        gl.bindTexture(gl.TEXTURE_2D, frame.patches);
        gl.activeTexture(gl.TEXTURE0);
        gl.uniform1i(program.at.patches, 1);
        this.bind_corners_(frame.count);
        gl.drawElements(gl.TRIANGLES, 6 * frame.count, gl.UNSIGNED_INT, 0);
    }

    /** Corners of the triangles of so many patches; the vertices are made by the shader. */
    bind_corners_(count) {
        const gl = this.gl_;
        gl.bindVertexArray(this.patch_array_);
        if (count <= this.corners_there_) return;
        this.corners_there_ = 2 * count;
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, patch_triangles(2 * count), gl.STATIC_DRAW);
    }

    use_({ program, at }, frame, view, layer, down = false) {
        const gl = this.gl_;
        const { turn, shift } = warp_of(frame.view, frame.width, frame.height, view);
        if (down)
            for (const row of [turn, shift]) for (let k = 1; k < row.length; k += 3) row[k] *= -1;
        gl.useProgram(program);
        gl.uniformMatrix3fv(at.turn, false, turn);
        gl.uniform3fv(at.shift, shift);
        gl.uniform2fv(at.layer, layer);
        gl.uniform1f(at.step, frame.step);
        gl.uniform2f(at.size, frame.width, frame.height);
        gl.uniform1f(at.nearest, 0.5 / (65535 * frame.step));
        gl.bindTexture(gl.TEXTURE_2D, frame.texture);
        gl.uniform1i(at.frame, 0);
    }
}
