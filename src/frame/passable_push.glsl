// What fragments of passable surfaces are told of the frame.
layout(push_constant, scalar) uniform Push {
  vec2 film_offset;  // of the sample in the pixel, in [0, 1)
  vec2 size;         // of the picture, pixels
  uint frame;
  uint geometry_only;
};

Ray rayThroughPixel(ViewRecord view) {
  return rayThrough(view, (floor(gl_FragCoord.xy) + film_offset) / size * 2.0 - 1.0);
}
