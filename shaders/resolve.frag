#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(set = 0, binding = 1) uniform usampler2D seen;  // id, distance in front of the camera
layout(location = 0) out vec4 colour;

ivec2 last = ivec2(frame.size.xy) - 1;

float distance_at(ivec2 pixel) {
    return uintBitsToFloat(texelFetch(seen, clamp(pixel, ivec2(0), last), 0).g);
}

// How open the surroundings are, 1 is open: from eight taps, two rounds of a spiral, that each pixel
// turns by another angle.
const vec2 spiral[8] = vec2[](vec2(0.25, 0.0), vec2(0.354, 0.354), vec2(0.0, 0.75),
                              vec2(-0.707, 0.707), vec2(-0.25, 0.0), vec2(-0.354, -0.354),
                              vec2(0.0, -0.75), vec2(0.707, -0.707));
float openness(ivec2 pixel, vec3 place, vec3 normal) {
    const float reach = 2.5;  // Å
    float pixels = clamp(reach * frame.projection.y * 0.5 * frame.size.y / -place.z, 2.0, 64.0);
    float turn = fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))));
    vec2 x = pixels * vec2(cos(0.785398 * turn), sin(0.785398 * turn)), y = vec2(-x.y, x.x);
    float shut = 0.0;
    for (int tap = 0; tap < frame.taps; ++tap) {
        ivec2 there = clamp(pixel + ivec2(spiral[tap].x * x + spiral[tap].y * y), ivec2(0), last);
        vec3 to = ray_at(vec2(there) + 0.5) * distance_at(there) - place;
        float d2 = max(dot(to, to), 1e-8), inverse = inversesqrt(d2);
        float above = max(dot(to, normal) * inverse - 0.1, 0.0);
        shut += above * clamp(1.0 - d2 * inverse / (2.0 * reach), 0.0, 1.0);
    }
    return clamp(1.0 - shut / 4.0, 0.0, 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 here = texelFetch(seen, pixel, 0).rg;
    float distance = uintBitsToFloat(here.g);
    // An outline where something much nearer is beside this pixel.
    ivec2 right = ivec2(frame.outline, 0), down = right.yx;
    float nearest = min(min(distance_at(pixel + right), distance_at(pixel - right)),
                        min(distance_at(pixel + down), distance_at(pixel - down)));
    float outline = clamp((distance - nearest - 0.8) / 0.8, 0.0, 1.0);

    uint index = here.r - 1u;
    vec3 ray = ray_at(gl_FragCoord.xy), place = ray * distance;
    vec4 axis = shapes[index].axis;
    float slope = shapes[index].paint_a.w;
    vec3 off = place - shapes[index].start.xyz;
    float along = dot(off, axis.xyz);
    vec3 out_of_axis = off - along * axis.xyz;
    vec3 normal = normalize(out_of_axis - slope * length(out_of_axis) * axis.xyz);
    if (axis.w > 0.0 && along < 1e-3) normal = -axis.xyz;  // the flat end
    vec3 paint = along > 0.5 * axis.w ? shapes[index].paint_b.rgb : shapes[index].paint_a.rgb;

    vec3 light = normalize(vec3(-0.4, 0.6, 0.7));
    float lit = max(dot(normal, light), 0.0);
    float shine = pow(max(dot(reflect(-light, normal), normalize(-ray)), 0.0), 32.0);
    vec3 shaded = paint * (0.35 + 0.65 * lit) * openness(pixel, place, normal) + 0.15 * shine * lit;
    const float thickest_fog = 0.8;
    float into_fog = max(distance - frame.fog_from, 0.0) * frame.fog.w;
    float fog = min(1.0 - exp(-into_fog * into_fog), thickest_fog);
    colour = vec4(mix(mix(shaded, vec3(0.02), outline), frame.fog.rgb, fog), 1.0);
}
