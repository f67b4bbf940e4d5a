#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) flat out vec4 sphere;  // centre, its square less the radius'
layout(location = 1) flat out uint id;

void main() {
    int index = gl_VertexIndex / 6;
    vec4 start = shapes[index].start;
    sphere = vec4(start.xyz, dot(start.xyz, start.xyz) - start.w * start.w);
    id = uint(index) + 1u;
    gl_Position = corner_around(start.xyz, start.w, corner_of(gl_VertexIndex));
}
