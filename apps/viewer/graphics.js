// What all drawing in WebGL2 begins with.

/** A program of two shaders: {program, at}: at: places of its uniforms, by name. Throws Error where it cannot be built. */
export function compiled(gl, { vertex, fragment }) {
    const program = gl.createProgram();
    for (const [type, text] of [
        [gl.VERTEX_SHADER, vertex],
        [gl.FRAGMENT_SHADER, fragment],
    ]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
        gl.deleteShader(shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost())
        throw new Error(`WebGL: ${gl.getProgramInfoLog(program)}`);
    const at = {};
    const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
    for (let k = 0; k < (count ?? 0); ++k) {
        const { name } = gl.getActiveUniform(program, k);
        at[name] = gl.getUniformLocation(program, name);
    }
    return { program, at };
}

/** A texture without a picture yet, that is bound. */
export function made_texture(gl, filter) {
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
        gl.texParameteri(gl.TEXTURE_2D, name, filter);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T])
        gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    return texture;
}
