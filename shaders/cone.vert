#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) out vec3 place;
layout(location = 1) flat out vec4 start;  // view space, radius
layout(location = 2) flat out vec4 end;
layout(location = 3) flat out uint id;

// The corners of a box in the order of one strip of 14 vertices, a bit each for x, y and z.
const int strip_x = 0x287a, strip_y = 0x02af, strip_z = 0x31e3;

void main() {
    Cone shape = cones[gl_InstanceIndex];
    start = vec4(to_view(shape.a_radius.xyz), shape.a_radius.w);
    end = vec4(to_view(shape.b_radius.xyz), shape.b_radius.w);
    id = uint(frame.background.w) + uint(gl_InstanceIndex) + 1u;
    vec3 axis = normalize(end.xyz - start.xyz);
    vec3 side = normalize(cross(axis, abs(axis.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
    vec3 other = cross(axis, side);
    float radius = max(start.w, end.w);
    int bit = 1 << gl_VertexIndex;
    vec2 across = vec2((strip_x & bit) != 0 ? 1.0 : -1.0, (strip_y & bit) != 0 ? 1.0 : -1.0);
    vec3 from = (strip_z & bit) != 0 ? end.xyz : start.xyz;
    place = from + radius * (across.x * side + across.y * other);
    gl_Position = clip_of(place);
    gl_Position.z = 0.5 * gl_Position.w;
}
