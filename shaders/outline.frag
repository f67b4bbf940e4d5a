#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(set = 0, binding = 3) uniform usampler2D seen;
layout(location = 0) out vec4 colour;

ivec2 last = ivec2(frame.size.xy) - 1;

uint id_at(ivec2 pixel) { return texelFetch(seen, clamp(pixel, ivec2(0), last), 0).r; }

// Background beside a shape.
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 right = ivec2(frame.outline, 0), down = right.yx;
    uint beside =
        id_at(pixel + right) | id_at(pixel - right) | id_at(pixel + down) | id_at(pixel - down);
    if (beside == 0u) discard;
    colour = vec4(vec3(0.02), 1.0);
}
