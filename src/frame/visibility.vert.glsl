// Triangles as one view sees them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

#include "frame/tables.glsl"

layout(location = 0) in vec3 position;
layout(scalar, set = 0, binding = 7) readonly buffer Views { ViewRecord views[]; };
layout(location = 0) flat out uint instance_index;

// Nothing may be computed otherwise in two passes that compare their depths.
invariant gl_Position;

void main() {
  InstanceRecord instance = fetchInstance(gl_InstanceIndex);
  vec4 p = vec4(position, 1.0);
  vec4 world = vec4(dot(instance.row_x, p), dot(instance.row_y, p), dot(instance.row_z, p), 1.0);
  ViewRecord view = views[0];
  gl_Position = vec4(dot(view.clip_row_x, world), dot(view.clip_row_y, world), dot(view.clip_row_z, world),
                     dot(view.clip_row_w, world));
  instance_index = gl_InstanceIndex;
}
