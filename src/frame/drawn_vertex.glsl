// A vertex of the scene in the picture of a view. The including shader declares before: uint drawn_view.
#ifndef NEPHROID_DRAWN_VERTEX_GLSL
#define NEPHROID_DRAWN_VERTEX_GLSL

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
  ViewRecord view = views[drawn_view];
  gl_Position = vec4(dot(view.clip_row_x, world), dot(view.clip_row_y, world), dot(view.clip_row_z, world),
                     dot(view.clip_row_w, world));
  instance_index = gl_InstanceIndex;
}

#endif
