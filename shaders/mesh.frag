#version 450
#extension GL_GOOGLE_include_directive : require

layout(location = 0) flat in uint id;
layout(location = 0) out uvec2 seen;

void main() { seen = uvec2(id, floatBitsToUint(1.0 / gl_FragCoord.w)); }
