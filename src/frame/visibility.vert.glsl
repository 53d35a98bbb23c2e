// Triangles as the camera sees them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

const uint drawn_view = 0u;
#include "frame/drawn_vertex.glsl"
