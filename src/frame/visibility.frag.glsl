// Which triangle is seen: its instance counted from 1 (0: none), and its place in the mesh.
#version 460
layout(location = 0) flat in uint instance_index;
layout(location = 0) out uvec2 seen;

void main() { seen = uvec2(instance_index + 1u, gl_PrimitiveID); }
