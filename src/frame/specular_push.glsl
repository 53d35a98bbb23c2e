// What the passes of `specular` are told of the frame.
layout(push_constant, scalar) uniform Push {
  vec2 film_offset;  // of the sample in the pixel, in [0, 1)
  uint frame;
  uint light_count;
  uint lamp_count;
  float specular_alpha;
  float environment_scale;
  float cos_rotation;
  float sin_rotation;
  uint max_events;
  uint tree_nodes;  // of the tree of triangles, in one order
  uint tree_orders;
  uint band_count;
};
