// Translucent layers: for each pixel a list of the triangles that cover it, in no order.

// How many nodes were asked for; of every pixel the newest node, 0 where there is none; then the
// nodes from 1, three numbers each: triangle, distance, the next node of this pixel.
layout(std430, set = 0, binding = 2) buffer Layers { uint layers[]; };

uint head_of(vec2 pixel) { return 1u + uint(pixel.y) * uint(frame.size.x) + uint(pixel.x); }

uint node_at(uint node) {
    return 1u + uint(frame.size.x) * uint(frame.size.y) + 3u * (node - 1u);
}

// Distance and triangle of the nearest layer past another one; the distance's bits, which order as
// it does. Two at one distance come by number, so that a picture repeats to the bit.
const uvec2 before_all = uvec2(0u), past_all = uvec2(0xffffffffu);
bool is_nearer(uvec2 a, uvec2 b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

uvec2 nearest_past(uint head, uvec2 past) {
    uvec2 nearest = past_all;
    for (uint node = head; node != 0u; node = layers[node_at(node) + 2u]) {
        uvec2 layer = uvec2(layers[node_at(node) + 1u], layers[node_at(node)]);
        if (is_nearer(past, layer) && is_nearer(layer, nearest)) nearest = layer;
    }
    return nearest;
}
