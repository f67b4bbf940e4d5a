#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) flat in vec4 sphere;
layout(location = 1) flat in uint id;
layout(location = 0) out uvec2 seen;

// The nearer root of A t^2 - 2 b t + C = 0 along the ray.
void main() {
    vec3 ray = ray_at(gl_FragCoord.xy);
    float A = dot(ray, ray), b = dot(ray, sphere.xyz);
    float root = b * b - A * sphere.w;
    float t = (b - sqrt(max(root, 0.0))) / A;  // and t is the depth: the ray's is 1
    if (root < 0.0 || t < frame.projection.z) discard;
    gl_FragDepth = depth_on_top(depth_of(t), id > frame.last_sphere_below);
    seen = uvec2(id, floatBitsToUint(t));
}
