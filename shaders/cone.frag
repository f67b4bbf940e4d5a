#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) flat in vec4 axis;
layout(location = 1) flat in vec4 form;
layout(location = 2) flat in vec2 ends;
layout(location = 3) flat in uint id;
layout(location = 0) out uvec2 seen;

// The distance of a place t along the ray from the side, squared and signed, is A t^2 - 2 b t + C.
// The nearer root is on the side if it is between the ends; the flat end is hit where its plane is
// inside of the side.
void main() {
    vec3 ray = ray_at(gl_FragCoord.xy);
    float m = dot(ray, axis.xyz);
    float A = dot(ray, ray) - axis.w * m * m, b = dot(ray, form.xyz);
    float root = b * b - A * form.w;
    float t = (b - sqrt(max(root, 0.0))) / A;
    float along = m * t + ends.x;
    if (root < 0.0 || A <= 0.0 || along < 0.0 || along > ends.y) {
        t = -ends.x / m;
        if (m <= 0.0 || (A * t - 2.0 * b) * t + form.w > 0.0) discard;
    }
    if (t < frame.projection.z) discard;
    gl_FragDepth = depth_on_top(depth_of(t), id > frame.last_cone_below);
    seen = uvec2(id, floatBitsToUint(t));
}
