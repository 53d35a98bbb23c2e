// Triangles as one of several views sees them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

layout(push_constant, scalar) uniform Push { uint drawn_view; };
#include "frame/drawn_vertex.glsl"
