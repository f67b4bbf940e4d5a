// How surfaces are lit, and fade in the distance.

// From the camera's upper left.
const vec3 light = normalize(vec3(-0.4, 0.6, 0.7));

// `open`: how much of the surroundings' light comes there, `sun`: of the light's own, up to 1.
vec3 light_up(vec3 paint, vec3 normal, vec3 ray, float open, float sun) {
    float lit = sun * max(dot(normal, light), 0.0);
    float shine = pow(max(dot(reflect(-light, normal), normalize(-ray)), 0.0), 32.0);
    return paint * (0.35 + 0.65 * lit) * open + 0.15 * shine * lit;
}

vec3 fade(vec3 colour, float distance) {
    const float thickest_fog = 0.8;
    float into_fog = max(distance - frame.fog_from, 0.0) * frame.fog.w;
    float fog = min(1.0 - exp(-into_fog * into_fog), thickest_fog);
    return mix(colour, frame.fog.rgb, fog);
}
