#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "light.glsl"
#include "mesh.glsl"

// Without, no triangle may be seen: on software nobody pays for the meshes that there are not.
layout(constant_id = 0) const bool shades_meshes = false;

layout(set = 0, binding = 3) uniform usampler2D seen;  // id, distance in front of the camera
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
    float turn = fract(52.9829189 * fract(dot(vec2(pixel + frame.origin), vec2(0.06711056, 0.00583715))));
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

Surface shape_surface(uint index, vec3 place) {
    vec4 axis = shapes[index].axis;
    float slope = shapes[index].paint_a.w;
    vec3 off = place - shapes[index].start.xyz;
    float along = dot(off, axis.xyz);
    vec3 out_of_axis = off - along * axis.xyz;
    vec3 normal = normalize(out_of_axis - slope * length(out_of_axis) * axis.xyz);
    if (axis.w > 0.0 && along < 1e-3) normal = -axis.xyz;  // the flat end
    vec3 paint = along > 0.5 * axis.w ? shapes[index].paint_b.rgb : shapes[index].paint_a.rgb;
    return Surface(normal, vec4(paint, 1.0));
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

    vec3 ray = ray_at(gl_FragCoord.xy), place = ray * distance;
    Surface surface;
    if (shades_meshes && here.r > frame.shapes) {
        surface = surface_at(here.r - frame.shapes - 1u, place);
    } else {
        surface = shape_surface(here.r - 1u, place);
    }
    vec3 shaded =
        light_up(surface.paint.rgb, surface.normal, ray, openness(pixel, place, surface.normal));
    colour = vec4(fade(mix(shaded, vec3(0.02), outline), distance), 1.0);
}
