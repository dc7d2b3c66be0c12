// The programs that draw a frame from another view, in GLSL ES 3.00.
import { kPatchRow } from "./depth.js";

const kHead = `#version 300 es
precision highp float;
precision highp int;
`;

// Clip coordinates are homogeneous: scaled by the inverse depth they serve points at infinity as well, and pixels interpolated
// with them are those of the plane that a patch lies on. The nearer, the larger the inverse depth, and so the smaller z.
const kWarp = `
uniform mat3 turn;
uniform vec3 shift;
uniform float nearest; // [m]
// Each layer has a range of depths of its own, so that it shows only where those before it have gaps: from x to x + y, 0 to 1.
vec4 warped(vec2 pixel, float inverse, vec2 layer) {
    vec3 clip = turn * vec3(pixel, 1.0) + inverse * shift;
    float far = 0.999999 * clip.z - nearest * inverse; // 0 to w
    return vec4(clip.xy, (2.0 * layer.x - 1.0) * clip.z + 2.0 * layer.y * far, clip.z);
}
`;

export const kPatches = {
    vertex: `${kHead}${kWarp}
uniform float step;
uniform vec2 layer;
uniform vec2 guesses; // layer of patches that show what is guessed
uniform highp usampler2D patches; // two texels each
uniform float overlap; // of patches of one surface, so that no cracks open between them [pixels]
out vec2 pixel;
flat out vec4 bounds; // of the pixels whose colours belong to the surface
void main() {
    int place = gl_VertexID >> 2;
    ivec2 at = ivec2(2 * (place % ${kPatchRow}), place / ${kPatchRow});
    ivec4 patch_place = ivec4(texelFetch(patches, at, 0)); // x, y, level + 8 guessed + 16 edges, inverse depth
    ivec2 slope = (ivec2(texelFetch(patches, at + ivec2(1, 0), 0).xy) << 16) >> 16;
    float side = float(1 << (patch_place.z & 7));
    int edges = patch_place.z >> 4;
    bvec4 torn = bvec4((edges & 1) != 0, (edges & 4) != 0, (edges & 2) != 0, (edges & 8) != 0);
    vec2 corner = vec2(gl_VertexID & 1, (gl_VertexID >> 1) & 1);
    vec2 first = vec2(patch_place.xy);
    // Chosen by truth values: a number in between, of numbers that are so far apart, would be rounded.
    vec4 beyond = mix(vec4(overlap), vec4(0.0), torn);
    pixel = first + corner * side + mix(-beyond.xy, beyond.zw, corner);
    float off = dot(vec2(slope), pixel - first - 0.5 * side) / 64.0;
    bounds = mix(vec4(-1e9, -1e9, 1e9, 1e9), vec4(first + 0.5, first + side - 0.5), torn);
    float inverse = max(step * (float(patch_place.w) + off), 0.0);
    gl_Position = warped(pixel, inverse, (patch_place.z & 8) != 0 ? guesses : layer);
}`,
    fragment: `${kHead}
uniform sampler2D frame;
in vec2 pixel;
flat in vec4 bounds;
out vec4 colour;
void main() {
    colour = texture(frame, clamp(pixel, bounds.xy, bounds.zw) / vec2(textureSize(frame, 0)));
}`,
};

export const kSheet = {
    vertex: `${kHead}${kWarp}
uniform float step;
uniform vec2 layer;
uniform sampler2D frame;
layout(location = 0) in vec3 place; // x, y, inverse depth
layout(location = 1) in vec2 source;
out vec3 shade;
void main() {
    vec2 size = vec2(textureSize(frame, 0));
    shade = textureLod(frame, source / size, 0.0).rgb;
    gl_Position = warped(place.xy, step * place.z, layer);
}`,
    fragment: `${kHead}
in vec3 shade;
out vec4 colour;
void main() {
    colour = vec4(shade, 1.0);
}`,
};
