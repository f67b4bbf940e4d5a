// The triangles of meshes, for shaders that find what one of them looks like at a place.

// In view space.
struct Vertex {
    float x, y, z;
    uint normal;  // on an octahedron
    uint paint;   // square roots of the colour, and the opacity
};

// Three for each triangle.
layout(std430, set = 0, binding = 1) readonly buffer Vertices { Vertex vertices[]; };

struct Surface {
    vec3 normal;  // unit vector, towards the viewer
    vec4 paint;   // colour, opacity
};

vec3 unpack_normal(uint packed) {
    vec2 xy = unpackSnorm2x16(packed);
    vec3 n = vec3(xy, 1.0 - abs(xy.x) - abs(xy.y));
    float fold = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -fold : fold;
    n.y += n.y >= 0.0 ? -fold : fold;
    return normalize(n);
}

vec4 unpack_paint(uint packed) {
    vec4 roots = unpackUnorm4x8(packed);
    return vec4(roots.rgb * roots.rgb, roots.a);
}

// A triangle, from 0, at a place in its plane: by barycentric coordinates, kept inside of it. Which
// side is seen is the flat triangle's to say, whichever way around its corners are named: near a
// silhouette the normal between the corners may look away though the triangle does not.
Surface surface_at(uint triangle, vec3 place) {
    Vertex A = vertices[3u * triangle], B = vertices[3u * triangle + 1u],
           C = vertices[3u * triangle + 2u];
    vec3 a = vec3(A.x, A.y, A.z), ab = vec3(B.x, B.y, B.z) - a, ac = vec3(C.x, C.y, C.z) - a,
         ap = place - a;
    vec3 across = cross(ab, ac);
    float scale = 1.0 / max(dot(across, across), 1e-30);
    float b = clamp(dot(cross(ap, ac), across) * scale, 0.0, 1.0);
    float c = clamp(dot(cross(ab, ap), across) * scale, 0.0, 1.0 - b);
    vec3 normal = (1.0 - b - c) * unpack_normal(A.normal) + b * unpack_normal(B.normal) +
                  c * unpack_normal(C.normal);
    vec4 paint = (1.0 - b - c) * unpack_paint(A.paint) + b * unpack_paint(B.paint) +
                 c * unpack_paint(C.paint);
    bool is_back = (dot(across, place) > 0.0) == (dot(across, normal) > 0.0);
    return Surface(normalize(is_back ? -normal : normal), paint);
}
