#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) in vec3 place;  // in view space
layout(location = 0) flat out uint id;

void main() {
    id = frame.shapes + uint(gl_VertexIndex / 3) + 1u;
    float near = frame.projection.z, far = frame.projection.w;
    gl_Position = clip_of(place);
    gl_Position.z = far * (-place.z - near) / (far - near);
}
