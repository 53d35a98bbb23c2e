// Caustics on what is seen at any place: the irradiance that frame/receiver_map.h has there, as the surface shows it.
//
// Of every view that a place may have flux in, what the four texels about it have of its surface is interpolated; the
// views are added up, since a photon's flux is in one alone. Nothing is read where there is no map.
//
// Needs three bindings from NEPHROID_RECEIVER_BINDINGS on (ReceiverMap::appendBound), and behind them the sum over
// samples of the layer `specular_caustic`.
#ifndef NEPHROID_RECEIVER_MAP_GLSL
#define NEPHROID_RECEIVER_MAP_GLSL

#include "frame/deposit.shared.h"
#include "frame/receiver_map.shared.h"
#include "frame/response.glsl"

layout(scalar, set = 0, binding = NEPHROID_RECEIVER_BINDINGS) uniform ReceiverMap {
  ReceiverMapHead receiver_head;
  ReceiverView receiver_views[kMostViews];
};
// Along each view, all layers in a texel.
layout(set = 0, binding = NEPHROID_RECEIVER_BINDINGS + 1, rgba32f) readonly uniform image2DArray receiver_depths;
layout(set = 0, binding = NEPHROID_RECEIVER_BINDINGS + 2, r32i) readonly uniform iimage2DArray receiver_flux;
// W/m²/sr.
layout(set = 0, binding = NEPHROID_RECEIVER_BINDINGS + 3, rgba32f) uniform image2D specular_caustic_image;

layout(constant_id = 22) const uint kReceiverViews = 0u;  // 0: there is no map
layout(constant_id = 23) const uint kReceiverLayers = 1u;
layout(constant_id = 24) const bool kReceiverDirections = false;

/// What falls on a place.
struct Incident {
  vec3 irradiance;  // W/m²
  vec3 direction;   // of travel, each times the luminance of its irradiance
};

vec3 fetchSteps(ivec2 texel, int layer) {
  return vec3(imageLoad(receiver_flux, ivec3(texel, layer)).x,
              imageLoad(receiver_flux, ivec3(texel, layer + 1)).x,
              imageLoad(receiver_flux, ivec3(texel, layer + 2)).x);
}

/// How far along a view a surface's plane lies, in m, about a place on it.
struct Depths {
  float at;          // the place
  vec2 per_texel;    // along both sides of the picture
  float tolerance;   // of what shows the same surface: those that bend differ from the plane by a part of a texel
};

Depths depthsOf(ReceiverView view, Surface s, float facing) {
  float texel = receiver_head.texel, steepness = 1.0 / facing;
  vec2 across = vec2(dot(view.row_x.xyz, s.geometric), dot(view.row_y.xyz, s.geometric));
  return Depths(dot(view.forward, s.position), across * (texel * texel * steepness),
                (texel + s.position_error) * steepness);
}

/// Between the four texels about a place, those that show other surfaces left out.
/// @param facing  cosine between the surface's normal and the way to the view
Incident incidentIn(uint v, ReceiverView view, Surface s, float facing) {
  const uint channels = kReceiverDirections ? 2u * kFluxChannels : kFluxChannels;
  Depths depths = depthsOf(view, s, facing);
  vec4 place = vec4(s.position, 1.0);
  vec2 texels = vec2(dot(view.row_x, place), dot(view.row_y, place));
  vec2 last = vec2(imageSize(receiver_flux).xy - 1), corner = floor(texels - 0.5), share = texels - 0.5 - corner;
  Incident sum = Incident(vec3(0.0), vec3(0.0));
  float weights = 0.0;
  [[unroll]] for (uint k = 0u; k < 4u; ++k) {
    vec2 step_k = vec2(k & 1u, k >> 1);
    vec2 at = clamp(corner + step_k, vec2(0.0), last), shares = mix(1.0 - share, share, step_k);
    float expected = depths.at + dot(depths.per_texel, at + 0.5 - texels);
    vec4 off = abs(imageLoad(receiver_depths, ivec3(at, v)) - expected);
    uint layer = 0u;
    bool is_same = off.x <= depths.tolerance;
    [[unroll]] for (uint i = 1u; i < kReceiverLayers; ++i)
      if (!is_same && off[i] <= depths.tolerance) {
        layer = i;
        is_same = true;
      }
    float weight = is_same ? shares.x * shares.y : 0.0;
    int channel = int((v * kReceiverLayers + layer) * channels);
    sum.irradiance += weight * fetchSteps(ivec2(at), channel);
    if (kReceiverDirections) sum.direction += weight * fetchSteps(ivec2(at), channel + 3);
    weights += weight;
  }
  float scale = weights > 0.0 ? receiver_head.irradiance * facing / weights : 0.0;
  return Incident(scale * sum.irradiance, scale * sum.direction);
}

/// Views that a surface faces, a bit each. @param normal  unit
uint viewsFaced(vec3 normal) {
  uint faced = 0u;
  [[unroll]] for (uint v = 0u; v < kReceiverViews; ++v)
    if (-dot(receiver_views[v].forward, normal) >= kLeastFacing) faced |= 1u << v;
  return faced;
}

/// Chosen among all, each at a constant place: see makeUniforms.
ReceiverView receiverView(uint v) {
  ReceiverView view = receiver_views[0];
  [[unroll]] for (uint i = 1u; i < kReceiverViews; ++i)
    if (i == v) view = receiver_views[i];
  return view;
}

/// Radiance towards the eye of the caustics on a surface, W/m²/sr: diffuse lobes by the irradiance, glossy ones along
/// its mean direction, as frame/caustic.comp.glsl.
/// @param s   both normals on the side of the eye
/// @param wo  unit, to the eye
vec3 causticFrom(Surface s, MaterialPoint m, vec3 wo, float specular_alpha) {
  if (kReceiverViews == 0u) return vec3(0.0);
  Incident sum = Incident(vec3(0.0), vec3(0.0));
  // Most surfaces face one view alone: a device that runs what only some threads do for all would pay for each view.
  for (uint left = viewsFaced(s.geometric); left != 0u; left &= left - 1u) {
    uint v = uint(findLSB(left));
    ReceiverView view = receiverView(v);
    Incident found = incidentIn(v, view, s, -dot(view.forward, s.geometric));
    sum.irradiance += found.irradiance;
    sum.direction += found.direction;
  }
  float squared = dot(sum.direction, sum.direction);
  vec3 wi = squared > 0.0 && dot(-sum.direction, s.shading) > 0.0 ? -sum.direction * inversesqrt(squared) : s.shading;
  return respond(s, m, wo, wi, specular_alpha) * sum.irradiance;
}

/// Adds to the layer `specular_caustic`.
void addToSpecularCaustic(ivec2 pixel, vec3 radiance) {
  if (kReceiverViews == 0u || radiance == vec3(0.0)) return;
  imageStore(specular_caustic_image, pixel, imageLoad(specular_caustic_image, pixel) + vec4(radiance, 0.0));
}

#endif
