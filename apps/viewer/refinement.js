// Gives frames of fewer pixels than the screen back what earlier ones have shown between their pixels.
import { compiled, made_texture } from "./graphics.js";
import { kEarlier, kRefine } from "./shaders.js";

const kFine = 0.9; // frames of this share of the screen's width or more are shown as they are

/** Whether a context's drawing is done by the processor, which has other things to do. */
export function draws_in_software(gl) {
    const named = gl.getExtension("WEBGL_debug_renderer_info");
    const name = String(gl.getParameter(named ? named.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

/** What refining frames needs: programs, and a picture with depths in which what was shown before is drawn. */
export class Refinement {
    constructor(gl) {
        this.gl_ = gl;
        this.earlier_ = compiled(gl, kEarlier);
        this.refine_ = compiled(gl, kRefine);
        this.before_ = made_texture(gl, gl.NEAREST);
        this.target_ = gl.createFramebuffer();
        this.depth_ = gl.createRenderbuffer();
        this.size_ = [0, 0];
    }

    resize_(width, height) {
        if (this.size_[0] === width && this.size_[1] === height) return;
        const gl = this.gl_;
        this.size_ = [width, height];
        allocate(gl, this.before_, width, height);
        gl.bindRenderbuffer(gl.RENDERBUFFER, this.depth_);
        gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.target_);
        const depth = gl.DEPTH_ATTACHMENT;
        gl.framebufferRenderbuffer(gl.FRAMEBUFFER, depth, gl.RENDERBUFFER, this.depth_);
    }

    /** Whether a frame would gain by it on a screen of that width. */
    is_worth(frame, width) {
        return frame.width < kFine * width;
    }

    /**
     * Refine a frame: its own texture has the refined picture afterwards.
     * @param frame    {raw, refined: textures: as it came, and what is to be written, ...}
     * @param draw_earlier  draws what was shown before in the frame's view with a program {program, at}, upside down; nothing: there is nothing
     * @param size     of the picture that is made [width, height]
     */
    refine(frame, draw_earlier, [width, height]) {
        const gl = this.gl_;
        this.resize_(width, height);
        if (frame.refined_size[0] !== width || frame.refined_size[1] !== height)
            allocate(gl, frame.refined, width, height);
        frame.refined_size = [width, height];
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.target_);
        gl.viewport(0, 0, width, height);
        this.draw_into_(this.before_);
        gl.clearColor(0, 0, 0, 0);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        draw_earlier?.(this.earlier_);
        this.draw_into_(frame.refined);
        gl.disable(gl.DEPTH_TEST);
        const { program, at } = this.refine_;
        gl.useProgram(program);
        gl.uniform1i(at.frame, 0);
        gl.uniform1i(at.earlier, 1);
        gl.uniform2f(at.refined, width, height);
        gl.activeTexture(gl.TEXTURE1);
        gl.bindTexture(gl.TEXTURE_2D, this.before_);
        gl.activeTexture(gl.TEXTURE0);
        gl.bindTexture(gl.TEXTURE_2D, frame.raw);
        gl.bindVertexArray(null);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }

    draw_into_(texture) {
        const gl = this.gl_;
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    }
}

function allocate(gl, texture, width, height) {
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
}
