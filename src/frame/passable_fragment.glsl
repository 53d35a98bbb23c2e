// A fragment of a surface that may be passed straight through, for passes that draw such surfaces.
#include "frame/passable.glsl"

layout(scalar, set = 0, binding = 7) readonly buffer Views { ViewRecord views[]; };
layout(location = 0) flat in uint instance_index;

layout(push_constant, scalar) uniform Push {
  vec2 film_offset;  // of the sample in the pixel, in [0, 1)
  vec2 size;         // of the picture, pixels
  uint frame;
  uint geometry_only;
};

struct Fragment {
  Ray ray;  // through the pixel
  Surface surface;
  MaterialPoint material;
};

Fragment makeFragment() {
  Fragment f;
  f.ray = rayThrough(views[0], (floor(gl_FragCoord.xy) + film_offset) / size * 2.0 - 1.0);
  f.surface = surfaceSeen(f.ray, instance_index, gl_PrimitiveID);
  f.material = materialAt(f.surface.instance, f.surface.triangle, f.surface.u, f.surface.v);
  f.surface.shading = perturbedNormal(f.surface);
  return f;
}

Passage passageOf(Fragment f) {
  return passageAt(f.surface, f.material, f.ray.dir, uvec2(gl_FragCoord.xy), frame);
}
