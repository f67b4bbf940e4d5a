#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) in vec3 place;
layout(location = 1) flat in vec4 sphere;
layout(location = 2) flat in uint id;
layout(location = 0) out uint seen;

void main() {
    float t = hit_sphere(place, sphere.xyz, sphere.w);
    if (t <= 0.0 || t * place.z > -frame.projection.z) discard;
    gl_FragDepth = depth_of(t * place.z);
    seen = id;
}
