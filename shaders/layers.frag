#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "layers.glsl"

layout(early_fragment_tests) in;  // what is hidden is no layer
layout(location = 0) flat in uint id;

void main() {
    uint node = atomicAdd(layers[0], 1u) + 1u;
    if (node > frame.layer_room) return;
    uint place = node_at(node);
    layers[place] = id - frame.shapes - 1u;
    layers[place + 1u] = floatBitsToUint(1.0 / gl_FragCoord.w);
    layers[place + 2u] = atomicExchange(layers[head_of(gl_FragCoord.xy)], node);
}
