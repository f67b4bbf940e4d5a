// What all shaders of a frame share: the camera, the shapes, and how depth is written.
// View space: x right, y up, z towards the viewer, the camera at the origin.

layout(push_constant) uniform Frame {
    mat4 view;         // world to view space
    vec4 projection;   // x scale, y scale, near, far
    vec4 background;   // rgb, and in w the number of spheres
    vec4 size;         // of the picture: width, height, their inverses
} frame;

struct Sphere {
    vec4 centre_radius;
    vec4 colour;
};

struct Cone {
    vec4 a_radius;
    vec4 b_radius;
    vec4 colour_a;
    vec4 colour_b;
};

layout(std430, set = 0, binding = 0) readonly buffer Spheres { Sphere spheres[]; };
layout(std430, set = 0, binding = 1) readonly buffer Cones { Cone cones[]; };

vec3 to_view(vec3 world) { return (frame.view * vec4(world, 1.0)).xyz; }

// Depth between 0 at the near and 1 at the far plane for a view-space z, and back.
float depth_of(float z) {
    float near = frame.projection.z, far = frame.projection.w;
    return far * (z + near) / (z * (far - near));
}
float z_of(float depth) {
    float near = frame.projection.z, far = frame.projection.w;
    return far * near / (depth * (far - near) - far);
}

vec4 clip_of(vec3 view) {
    float near = frame.projection.z, far = frame.projection.w;
    return vec4(frame.projection.x * view.x, -frame.projection.y * view.y,
                -far * (view.z + near) / (far - near), -view.z);
}

// Distance along the ray (a multiple of its direction) to the sphere, or -1.
float hit_sphere(vec3 ray, vec3 centre, float radius) {
    float a = dot(ray, ray), b = dot(ray, centre);
    float root = b * b - a * (dot(centre, centre) - radius * radius);
    return root < 0.0 ? -1.0 : (b - sqrt(root)) / a;
}

// The same for a cone from a (radius ra) to b (radius rb), flat at a; gives the normal as well.
float hit_cone(vec3 ray, vec3 a, vec3 b, float ra, float rb, out vec3 normal) {
    vec3 axis = b - a;
    float height = length(axis);
    axis /= height;
    float k = (rb - ra) / height;
    float m = dot(ray, axis), n = -dot(a, axis), r = ra + k * n;
    float A = dot(ray, ray) - m * m - k * k * m * m;
    float B = -dot(a, ray) - m * n - k * m * r;
    float C = dot(a, a) - n * n - r * r;
    float root = B * B - A * C;
    if (root >= 0.0 && A > 0.0) {
        float t = (-B - sqrt(root)) / A;
        float along = m * t + n;
        if (t > 0.0 && along >= 0.0 && along <= height) {
            vec3 off = t * ray - a - along * axis;
            normal = normalize(normalize(off) - k * axis);
            return t;
        }
    }
    // The flat end, seen from outside.
    if (m > 0.0) {
        float t = dot(a, axis) / m;
        if (t > 0.0 && distance(t * ray, a) <= ra) {
            normal = -axis;
            return t;
        }
    }
    return -1.0;
}
