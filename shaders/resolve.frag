#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(set = 0, binding = 2) uniform usampler2D ids;
layout(set = 0, binding = 3) uniform sampler2D depths;
layout(location = 0) out vec4 colour;

ivec2 last = ivec2(frame.size.xy) - 1;

float z_at(ivec2 pixel) { return z_of(texelFetch(depths, clamp(pixel, ivec2(0), last), 0).r); }

// The view-space ray through a pixel's centre, of depth 1.
vec3 ray_at(ivec2 pixel) {
    vec2 plane = (vec2(pixel) + 0.5) * frame.size.zw * 2.0 - 1.0;
    return vec3(plane.x / frame.projection.x, -plane.y / frame.projection.y, -1.0);
}

// How open the surroundings are, from eight taps on a ring; 1 is open.
float openness(ivec2 pixel, vec3 place, vec3 normal) {
    const float reach = 2.5;  // Å
    float pixels = clamp(reach * frame.projection.y * 0.5 * frame.size.y / -place.z, 2.0, 64.0);
    float turn = fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))));
    float shut = 0.0;
    for (int tap = 0; tap < 8; ++tap) {
        float angle = 6.2831853 * (float(tap) + turn) / 8.0;
        float far = pixels * (float(tap % 4) + 1.0) / 4.0;
        ivec2 there = clamp(pixel + ivec2(far * vec2(cos(angle), sin(angle))), ivec2(0), last);
        vec3 to = ray_at(there) * -z_at(there) - place;
        float distance = length(to);
        float above = max(dot(to, normal) / max(distance, 1e-4) - 0.1, 0.0);
        shut += above * clamp(1.0 - distance / (2.0 * reach), 0.0, 1.0);
    }
    return clamp(1.0 - shut / 4.0, 0.0, 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint id = texelFetch(ids, pixel, 0).r;
    float z = z_at(pixel);
    // An outline where something much nearer is beside this pixel.
    float nearest = max(max(z_at(pixel + ivec2(1, 0)), z_at(pixel - ivec2(1, 0))),
                        max(z_at(pixel + ivec2(0, 1)), z_at(pixel - ivec2(0, 1))));
    float outline = clamp((nearest - z - 0.8) / 0.8, 0.0, 1.0);
    vec3 base = frame.background.rgb;
    if (id != 0u) {
        vec3 ray = ray_at(pixel), place = ray * -z, normal, paint;
        uint count = uint(frame.background.w);
        if (id <= count) {
            Sphere shape = spheres[id - 1u];
            normal = normalize(place - to_view(shape.centre_radius.xyz));
            paint = shape.colour.rgb;
        } else {
            Cone shape = cones[id - count - 1u];
            vec3 a = to_view(shape.a_radius.xyz), b = to_view(shape.b_radius.xyz);
            hit_cone(ray, a, b, shape.a_radius.w, shape.b_radius.w, normal);
            bool second = dot(place - a, b - a) > 0.5 * dot(b - a, b - a);
            paint = second ? shape.colour_b.rgb : shape.colour_a.rgb;
        }
        vec3 light = normalize(vec3(-0.4, 0.6, 0.7));
        float lit = max(dot(normal, light), 0.0);
        float shine = pow(max(dot(reflect(-light, normal), normalize(-ray)), 0.0), 32.0);
        base = paint * (0.35 + 0.65 * lit) * openness(pixel, place, normal) + 0.15 * shine * lit;
    }
    colour = vec4(mix(base, vec3(0.02), outline), 1.0);
}
