#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "layers.glsl"

layout(location = 0) out uvec2 seen;

// Where nothing is opaque the nearest layer is seen.
void main() {
    uint head = layers[head_of(gl_FragCoord.xy)];
    if (head == 0u) discard;
    uvec2 layer = nearest_past(head, before_all);
    seen = uvec2(frame.shapes + layer.y + 1u, layer.x);
}
