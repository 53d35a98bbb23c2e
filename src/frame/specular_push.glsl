// What the passes of `specular` are told of the frame.
#include "frame/sample_push.shared.h"

layout(push_constant, scalar) uniform Push {
  SamplePush push;
  uint max_events;
  uint tree_nodes;  // of the tree of triangles, in one order
  uint tree_orders;
  uint band_count;
};
