// The programs that draw a frame from another view, and refine it by what came before, in GLSL ES 3.00.
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
uniform float inset; // half a pixel of the frame's picture, which may have been refined [pixels of the frame]
out vec2 pixel;
flat out vec4 bounds; // of the pixels whose colours belong to the surface
flat out float known; // 0 where what is shown is guessed
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
    bounds = mix(vec4(-1e9, -1e9, 1e9, 1e9), vec4(first + inset, first + side - inset), torn);
    float inverse = max(step * (float(patch_place.w) + off), 0.0);
    bool guessed = (patch_place.z & 8) != 0;
    known = guessed ? 0.0 : 1.0;
    gl_Position = warped(pixel, inverse, guessed ? guesses : layer);
}`,
    fragment: `${kHead}
uniform sampler2D frame;
uniform vec2 size; // of the frame [pixels]
in vec2 pixel;
flat in vec4 bounds;
out vec4 colour;
void main() {
    colour = texture(frame, clamp(pixel, bounds.xy, bounds.zw) / size);
}`,
};

export const kSheet = {
    vertex: `${kHead}${kWarp}
uniform float step;
uniform vec2 layer;
uniform vec2 size; // of the frame [pixels]
uniform sampler2D frame;
layout(location = 0) in vec3 place; // x, y, inverse depth
layout(location = 1) in vec2 source;
out vec3 shade;
void main() {
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

// What an earlier frame's picture shows in a new one's view; alpha: whether it is known. Pictures are taken over from frame to frame, and
// would become blurred by bilinear interpolation: this is Catmull and Rom's cubic, of nine bilinear samples
// (Keys, "Cubic convolution interpolation for digital image processing", 1981, with a = -1/2).
export const kEarlier = {
    vertex: kPatches.vertex,
    fragment: `${kHead}
uniform sampler2D frame;
uniform vec2 size; // of the frame [pixels]
in vec2 pixel;
flat in vec4 bounds;
flat in float known;
out vec4 colour;
vec3 row(vec3 xs, float y, vec3 weights) {
    return weights.x * texture(frame, vec2(xs.x, y)).rgb + weights.y * texture(frame, vec2(xs.y, y)).rgb
        + weights.z * texture(frame, vec2(xs.z, y)).rgb;
}
void main() {
    vec2 texels = vec2(textureSize(frame, 0));
    vec2 at = clamp(pixel, bounds.xy, bounds.zw) / size * texels;
    vec2 centre = floor(at - 0.5) + 0.5;
    vec2 f = at - centre;
    vec2 first = f * (-0.5 + f * (1.0 - 0.5 * f));
    vec2 third = f * (0.5 + f * (2.0 - 1.5 * f));
    vec2 last = f * f * (-0.5 + 0.5 * f);
    vec2 middle = 1.0 - first - last;
    vec2 between = centre + third / middle;
    vec3 xs = vec3(centre.x - 1.0, between.x, centre.x + 2.0) / texels.x;
    vec3 ys = vec3(centre.y - 1.0, between.y, centre.y + 2.0) / texels.y;
    vec3 weights = vec3(first.x, middle.x, last.x);
    vec3 sum = first.y * row(xs, ys.x, weights) + middle.y * row(xs, ys.y, weights)
        + last.y * row(xs, ys.z, weights);
    colour = vec4(clamp(sum, 0.0, 1.0), known);
}`,
};

// A frame of few pixels, refined: where one of its pixels lies close, its colour counts for much; elsewhere what earlier frames
// have shown there, as far as the pixels around bear it out (Karis, "High quality temporal supersampling", SIGGRAPH 2014).
export const kRefine = {
    vertex: `${kHead}
void main() {
    gl_Position = vec4(4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0, 0.0, 1.0);
}`,
    fragment: `${kHead}
const float kNarrow = 0.7; // of the Gaussian of a pixel's weight by its distance [1 / pixel of the refined picture ^2]
const float kNewest = 0.5; // share of a pixel that lies in the middle
const float kLeast = 0.02; // of one that is far away
const float kSpreads = 1.25; // standard deviations that an earlier colour may be off
uniform sampler2D frame; // as it came
uniform sampler2D earlier;
uniform vec2 refined; // size of the picture that is made [pixels]
out vec4 colour;
void main() {
    ivec2 size = textureSize(frame, 0);
    vec2 scale = refined / vec2(size);
    vec2 at = gl_FragCoord.xy / scale;
    ivec2 own = ivec2(at);
    vec3 sum = vec3(0.0), mean = vec3(0.0), squares = vec3(0.0), low = vec3(1.0), high = vec3(0.0);
    float weights = 0.0, most = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            ivec2 place = clamp(own + ivec2(x, y), ivec2(0), size - 1);
            vec3 here = texelFetch(frame, place, 0).rgb;
            vec2 apart = (vec2(place) + 0.5 - at) * scale;
            float weight = exp(-kNarrow * dot(apart, apart));
            sum += weight * here;
            weights += weight;
            most = max(most, weight);
            mean += here / 9.0;
            squares += here * here / 9.0;
            low = min(low, here);
            high = max(high, here);
        }
    vec3 now = texture(frame, at / vec2(size)).rgb;
    if (weights > 1e-4) now = mix(now, sum / weights, most);
    vec4 before = texelFetch(earlier, ivec2(gl_FragCoord.xy), 0);
    vec3 spread = kSpreads * sqrt(max(squares - mean * mean, 0.0));
    vec3 kept = clamp(before.rgb, max(low, mean - spread), min(high, mean + spread));
    float share = before.a > 0.5 ? max(kNewest * most, kLeast) : 1.0;
    colour = vec4(mix(kept, now, share), 1.0);
}`,
};
