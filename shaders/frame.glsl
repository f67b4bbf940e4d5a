// What all shaders of a frame share: the camera, the shapes, and how depth is written.
// View space: x right, y up, z towards the viewer, the camera at the origin.

layout(push_constant) uniform Frame {
    vec4 projection;  // x scale, y scale, near, far
    vec4 size;        // of the picture: width, height, their inverses
    vec4 fog;         // the background's colour, and the inverse of the fog's length
    uint spheres;     // how many of the shapes are spheres; the cones stand behind them
    int outline;      // its width in pixels
    int spirals;      // of eight taps each of ambient occlusion, or none
    float fog_from;   // distance from the camera
    vec2 centre;      // where the camera's axis is seen, to the right and up, in halves of the picture
    uint last_sphere_below;  // numbers, from 1: what comes after them, of its kind, is on top
    uint last_cone_below;
    uint shapes;      // how many; the triangles' numbers come after theirs
    uint layer_room;  // for how many nodes of layers.glsl
    ivec2 origin;     // of this tile in a larger picture, in pixels
    vec4 sun;         // where the sun's camera looks, and from how far away
    float sun_scale;  // of its projection
    int sun_size;     // of its picture
} frame;

// In view space. A sphere is a cone without axis and height.
struct Shape {
    vec4 start;    // a, radius there
    vec4 axis;     // unit vector from a to b, height
    vec4 paint_a;  // colour, slope: how much the radius grows along the axis
    vec4 paint_b;  // colour of the half near b
};

layout(std430, set = 0, binding = 0) readonly buffer Shapes { Shape shapes[]; };

// What the depth test compares, 0 at the near and 1 at the far plane, for a distance in front of the
// camera.
float depth_of(float distance) {
    float near = frame.projection.z, far = frame.projection.w;
    return far * (distance - near) / (distance * (far - near));
}

// The same for what is on top: in front of everything else, among itself in order.
float depth_on_top(float depth, bool is_on_top) { return is_on_top ? 1e-3 * depth : depth; }

// The view-space ray of depth 1 through a place in the picture, in pixels from the upper left.
vec3 ray_at(vec2 pixel) {
    vec2 plane = pixel * frame.size.zw * 2.0 - 1.0;
    return vec3((plane.x - frame.centre.x) / frame.projection.x,
                -(plane.y + frame.centre.y) / frame.projection.y, -1.0);
}

// Where a corner of an impostor is drawn. Its own depth is of no use: the fragment finds the real
// one.
vec4 clip_of(vec3 view) {
    return vec4(frame.projection.x * view.x - frame.centre.x * view.z,
                -frame.projection.y * view.y + frame.centre.y * view.z, 0.0, -view.z);
}

// All corners here: an impostor of no area, and inside of the view. One vertex outside of it makes
// lavapipe send thousands of others through its clipper, also where that vertex is padding.
const vec4 nowhere = vec4(0.0, 0.0, 0.0, 1.0);

// Two triangles of six vertices make a rectangle; its corners, from -1 to 1. A list of triangles
// instead of an instance per shape: software draws each instance by itself, at ten times the cost.
vec2 corner_of(int vertex) {
    int bit = 1 << (vertex % 6);
    return vec2((0x32 & bit) != 0 ? 1.0 : -1.0, (0x2c & bit) != 0 ? 1.0 : -1.0);
}

// A corner of the square through a sphere's outline as the camera sees it, just large enough.
// Nowhere if the camera is inside of the sphere or past it.
vec4 corner_around(vec3 centre, float radius, vec2 corner) {
    float d2 = dot(centre, centre), r2 = radius * radius;
    if (d2 <= r2 || centre.z - radius > -frame.projection.z) return nowhere;
    vec3 outward = centre * inversesqrt(d2);
    vec3 right = normalize(cross(outward, abs(outward.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
    vec3 up = cross(right, outward);
    float outline = radius * sqrt((d2 - r2) / d2);
    return clip_of(centre * (1.0 - r2 / d2) + outline * (corner.x * right + corner.y * up));
}
