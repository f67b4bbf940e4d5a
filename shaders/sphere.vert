#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) out vec3 place;   // view space, on the square
layout(location = 1) flat out vec4 sphere;
layout(location = 2) flat out uint id;

// A square through the sphere's outline as the camera sees it, just large enough.
void main() {
    Sphere shape = spheres[gl_InstanceIndex];
    vec3 centre = to_view(shape.centre_radius.xyz);
    float radius = shape.centre_radius.w;
    float d2 = dot(centre, centre), r2 = radius * radius;
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0;
    id = uint(gl_InstanceIndex) + 1u;
    sphere = vec4(centre, radius);
    place = vec3(0.0);
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);  // nowhere: the camera is inside or past it
    if (d2 <= r2 || centre.z - radius > -frame.projection.z) return;
    vec3 outward = centre * inversesqrt(d2);
    vec3 right = normalize(cross(outward, abs(outward.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
    vec3 up = cross(right, outward);
    float outline = radius * sqrt((d2 - r2) / d2);
    place = centre * (1.0 - r2 / d2) + outline * (corner.x * right + corner.y * up);
    gl_Position = clip_of(place);
    gl_Position.z = 0.5 * gl_Position.w;  // the fragment knows the depth
}
