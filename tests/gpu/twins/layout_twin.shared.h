// Every struct that buffers share, each word written through its own name. The words count up from `first`, so a field
// that is elsewhere on the device, or padding, shows. (RayDifferential and Refraction hold bools, which GLSL keeps out
// of buffers.)
#include "core/optics/photon.shared.h"
#include "core/optics/ray_differential.shared.h"
#include "core/optics/surface.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct LayoutInput {
  float first;
};

struct LayoutOutput {
  Photon photon;
  PhotonBatch batch;
  Footprint footprint;
  NormalDifferential normal;
  SurfaceOptics surface;
};

NEPHROID_FN LayoutOutput writeLayout(LayoutInput given) {
  float f = given.first;
  uint u = uint(given.first);
  LayoutOutput result;
  result.photon.position = vec3(f, f + 1.0f, f + 2.0f);
  result.photon.path_length = f + 3.0f;
  result.photon.direction = vec3(f + 4.0f, f + 5.0f, f + 6.0f);
  result.photon.light_band_flags = u + 7u;
  result.photon.flux = vec3(f + 8.0f, f + 9.0f, f + 10.0f);
  result.photon.index = u + 11u;
  result.photon.chain = u + 12u;
  result.photon.footprint_major = f + 13.0f;
  result.photon.footprint_minor = f + 14.0f;
  result.photon.footprint_orientation = u + 15u;
  result.batch.light = u + 16u;
  result.batch.emitted_count = u + 17u;
  result.batch.batch = u + 18u;
  result.batch.grid_width = u + 19u;
  result.batch.grid_height = u + 20u;
  result.batch.band_count = u + 21u;
  result.footprint.axis_a = vec3(f + 22.0f, f + 23.0f, f + 24.0f);
  result.footprint.axis_b = vec3(f + 25.0f, f + 26.0f, f + 27.0f);
  result.normal.dn_dx = vec3(f + 28.0f, f + 29.0f, f + 30.0f);
  result.normal.dn_dy = vec3(f + 31.0f, f + 32.0f, f + 33.0f);
  result.surface.base = vec3(f + 34.0f, f + 35.0f, f + 36.0f);
  result.surface.metallic = f + 37.0f;
  result.surface.alpha = f + 38.0f;
  result.surface.transmission = f + 39.0f;
  result.surface.gloss = f + 40.0f;
  result.surface.specular_tint = vec3(f + 41.0f, f + 42.0f, f + 43.0f);
  result.surface.ior_from = f + 44.0f;
  result.surface.ior_to = f + 45.0f;
  result.surface.average_fresnel = f + 46.0f;
  result.surface.conductor_ior = vec3(f + 47.0f, f + 48.0f, f + 49.0f);
  result.surface.conductor_k = vec3(f + 50.0f, f + 51.0f, f + 52.0f);
  result.surface.has_conductor = u + 53u;
  result.surface.is_pane = u + 54u;
  result.surface.is_solid = u + 55u;
  return result;
}

NEPHROID_NAMESPACE_END
