// What the passes of `specular` are told of the frame.
#include "frame/sample_push.shared.h"

layout(push_constant, scalar) uniform Push {
  SamplePush push;
  uint max_events;
  uint tree_nodes;  // TriangleTree::Walk
  vec3 tree_grid_lower;
  float tree_grid_scale;
  uint band_count;
  uvec2 shift;  // of the grid of cells against the picture, in pixels
  uint stamp;   // of the sample: ends that were noted in others agree with none of its own
  uint chain;   // that a pass over cells is about: kReflected, kTransmitted
};
