#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) flat out vec4 axis;  // and 1 + slope^2
layout(location = 1) flat out vec4 form;  // g and C of the equation in cone.frag
layout(location = 2) flat out vec2 ends;  // of the axis, from the foot of the camera's perpendicular
layout(location = 3) flat out uint id;

void main() {
    uint index = frame.spheres + uint(gl_VertexIndex / 6);
    Shape shape = shapes[index];
    vec3 a = shape.start.xyz;
    float height = shape.axis.w, slope = shape.paint_a.w;
    float n = -dot(a, shape.axis.xyz);
    float radius_at_foot = shape.start.w + slope * n;
    axis = vec4(shape.axis.xyz, 1.0 + slope * slope);
    form = vec4(a + (n + slope * radius_at_foot) * shape.axis.xyz,
                dot(a, a) - n * n - radius_at_foot * radius_at_foot);
    ends = vec2(n, height);
    id = index + 1u;

    vec2 corner = corner_of(gl_VertexIndex);
    float radius = max(shape.start.w, shape.start.w + slope * height);
    vec3 foot = a + n * shape.axis.xyz;  // of the perpendicular from the camera to the axis
    float away = length(foot);
    if (away <= 2.0 * radius) {  // seen from its end
        gl_Position = corner_around(a + 0.5 * height * shape.axis.xyz,
                                    length(vec2(0.5 * height, radius)), corner);
        return;
    }
    // A rectangle through the axis, across the line of sight: as wide as the camera's tangents to
    // the sides, as long as it takes to hide both ends.
    vec3 side = normalize(cross(shape.axis.xyz, foot));
    float width = radius * away * inversesqrt(away * away - radius * radius);
    float from = corner.x < 0.0 ? -n : height - n;
    float towards = from * corner.x > 0.0 ? -radius : radius;
    from *= away / (away + towards);
    gl_Position = clip_of(foot + from * shape.axis.xyz + corner.y * width * side);
}
