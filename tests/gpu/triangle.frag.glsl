#version 460
layout(push_constant) uniform Push { float red; };
layout(location = 0) out vec4 color;
void main() { color = vec4(red, 0.0, 0.0, 1.0); }
