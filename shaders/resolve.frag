#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "light.glsl"
#include "mesh.glsl"

// Without, no triangle may be seen: on software nobody pays for the meshes that there are not.
layout(constant_id = 0) const bool shades_meshes = false;
layout(constant_id = 1) const bool has_shadows = false;

layout(set = 0, binding = 3) uniform usampler2D seen;  // id, distance in front of the camera
layout(set = 0, binding = 4) uniform usampler2D sun_seen;  // the same of the sun's camera
layout(location = 0) out vec4 colour;

ivec2 last = ivec2(frame.size.xy) - 1;

float distance_at(ivec2 pixel) {
    return uintBitsToFloat(texelFetch(seen, clamp(pixel, ivec2(0), last), 0).g);
}

// Another one for each pixel, from 0 to 1, that neighbours differ much in (Jimenez 2014, "Next
// generation post processing in Call of Duty: Advanced Warfare").
float turn_of(ivec2 pixel) {
    vec2 place = vec2(pixel + frame.origin);
    return fract(52.9829189 * fract(dot(place, vec2(0.06711056, 0.00583715))));
}

// How open the surroundings are, 1 is open: from eight taps, two turns of a spiral, that each pixel
// turns by another angle; or from several such spirals between each other.
const vec2 spiral[8] = vec2[](vec2(0.25, 0.0), vec2(0.354, 0.354), vec2(0.0, 0.75),
                              vec2(-0.707, 0.707), vec2(-0.25, 0.0), vec2(-0.354, -0.354),
                              vec2(0.0, -0.75), vec2(0.707, -0.707));
float openness(ivec2 pixel, vec3 place, vec3 normal) {
    const float reach = 2.5;  // Å
    float pixels = clamp(reach * frame.projection.y * 0.5 * frame.size.y / -place.z, 2.0, 64.0);
    float turn = turn_of(pixel), shut = 0.0;
    for (int round = 0; round < frame.spirals; ++round) {
        float share = (turn + float(round)) / float(frame.spirals), angle = 0.785398 * share;
        float size = pixels * (1.0 - 0.25 * float(round) / float(frame.spirals));
        vec2 x = size * vec2(cos(angle), sin(angle)), y = vec2(-x.y, x.x);
        for (int tap = 0; tap < 8; ++tap) {
            vec2 aside = spiral[tap].x * x + spiral[tap].y * y;
            ivec2 there = clamp(pixel + ivec2(aside), ivec2(0), last);
            vec3 to = ray_at(vec2(there) + 0.5) * distance_at(there) - place;
            float d2 = max(dot(to, to), 1e-8), inverse = inversesqrt(d2);
            float above = max(dot(to, normal) * inverse - 0.1, 0.0);
            shut += above * clamp(1.0 - d2 * inverse / (2.0 * reach), 0.0, 1.0);
        }
    }
    return clamp(1.0 - shut / (4.0 * float(max(frame.spirals, 1))), 0.0, 1.0);
}

// How much of the light's way is free, 1 is all: what of 16 places around, in the surface's own
// plane, the sun's camera sees nothing in front of.
float sunlight(ivec2 pixel, vec3 place, vec3 normal) {
    const float softness = 0.25, bias = 0.06;  // Å
    const vec3 right = normalize(cross(vec3(0, 1, 0), light)), up = cross(light, right);
    vec3 off = place - frame.sun.xyz;
    vec3 at = vec3(dot(off, right), dot(off, up), frame.sun.w - dot(off, light));
    float pixels = 0.5 * frame.sun_scale * float(frame.sun_size) / at.z;  // of an angstrom
    vec2 middle = vec2(at.x, -at.y) * pixels + 0.5 * float(frame.sun_size);
    // How the plane falls away from the sun; where it hardly faces it there is little light to lose.
    vec2 fall = vec2(dot(normal, right), dot(normal, up)) / max(dot(normal, light), 0.2);
    float turn = 6.2831853 * turn_of(pixel), open = 0.0;
    for (int tap = 0; tap < 16; ++tap) {
        float angle = turn + 2.3999632 * float(tap);  // a golden spiral
        vec2 aside = softness * sqrt((float(tap) + 0.5) / 16.0) * vec2(cos(angle), sin(angle));
        ivec2 there = clamp(ivec2(middle + pixels * aside), ivec2(0), ivec2(frame.sun_size - 1));
        vec2 across = (vec2(there) + 0.5 - middle) / pixels * vec2(1.0, -1.0);
        float nearest = uintBitsToFloat(texelFetch(sun_seen, there, 0).g);
        open += nearest < at.z + dot(fall, across) - bias ? 0.0 : 1.0 / 16.0;
    }
    return open;
}

bool is_on_top(uint id) {
    return id <= frame.spheres ? id > frame.last_sphere_below
                               : id > frame.last_cone_below && id <= frame.shapes;
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
    float open = openness(pixel, place, surface.normal);
    float sun = has_shadows && !is_on_top(here.r) ? sunlight(pixel, place, surface.normal) : 1.0;
    vec3 shaded = light_up(surface.paint.rgb, surface.normal, ray, open, sun);
    colour = vec4(fade(mix(shaded, vec3(0.02), outline), distance), 1.0);
}
