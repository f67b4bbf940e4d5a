#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) in vec3 place;
layout(location = 1) flat in vec4 start;
layout(location = 2) flat in vec4 end;
layout(location = 3) flat in uint id;
layout(location = 0) out uint seen;

void main() {
    vec3 normal;
    float t = hit_cone(place, start.xyz, end.xyz, start.w, end.w, normal);
    if (t <= 0.0 || t * place.z > -frame.projection.z) discard;
    gl_FragDepth = depth_of(t * place.z);
    seen = id;
}
