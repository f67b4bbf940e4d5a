#version 450
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "light.glsl"
#include "mesh.glsl"
#include "layers.glsl"

layout(location = 0) out vec4 colour;  // times coverage, to be laid over what is opaque

const int most_layers = 32;  // the nearest

// From front to back, until hardly anything shines through.
void main() {
    uint head = layers[head_of(gl_FragCoord.xy)];
    if (head == 0u) discard;
    vec3 ray = ray_at(gl_FragCoord.xy), sum = vec3(0.0);
    float through = 1.0;
    uvec2 layer = before_all;
    for (int i = 0; i < most_layers && through > 1e-3; ++i) {
        layer = nearest_past(head, layer);
        if (layer == past_all) break;
        float distance = uintBitsToFloat(layer.x);
        Surface surface = surface_at(layer.y, ray * distance);
        // Glass of one thickness: a ray that meets it aslant has a longer way, up to four times.
        float cosine = max(abs(dot(surface.normal, normalize(ray))), 0.25);
        float kept = pow(1.0 - surface.paint.a, 1.0 / cosine);
        vec3 lit = fade(light_up(surface.paint.rgb, surface.normal, ray, 1.0, 1.0), distance);
        sum += through * (1.0 - kept) * lit;
        through *= kept;
    }
    colour = vec4(sum, 1.0 - through);
}
