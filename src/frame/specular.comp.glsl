// One frame's sample of `specular`: what mirrors, glass and water show.
//
// From each listed pixel two chains are followed, one that the first surface reflects and one that it lets through; at
// every further surface one way on is drawn in proportion to what it carries, so that the mean over frames is the sum of
// all. A chain ends on the first surface that it is drawn to see lit (class D), or where it leaves the scene.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#define NEPHROID_LIGHT_BINDINGS 7
#include "frame/lights.glsl"
#include "frame/passable.glsl"
#include "frame/interior.glsl"
#include "core/optics/absorption.shared.h"
#include "core/optics/dispersion.shared.h"
#include "frame/specular_push.glsl"
#include "frame/specular_lobe.glsl"
#define NEPHROID_TREE_BINDINGS 18
#include "frame/triangle_tree.glsl"
#define NEPHROID_SKY_BINDINGS 14
#include "frame/sky.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 11) readonly buffer Views { ViewRecord views[]; };
layout(set = 0, binding = 12) uniform usampler2D seen_image;
layout(set = 0, binding = 13) uniform sampler2D band_table;  // wavelength in nm, and weight times their count
layout(scalar, set = 0, binding = 16) readonly buffer Pixels { uint pixel_count; uint pixels[]; };
layout(set = 0, binding = 17, rgba32f) uniform image2D specular_image;  // sum over samples, W/m²/sr

layout(constant_id = 9) const bool kSceneTransmits = true;
layout(constant_id = 10) const bool kSceneHasMedia = true;  // that absorb
layout(constant_id = 11) const bool kSceneDisperses = true;

/// Which way a chain goes at the first surface that has both.
const uint kReflects = 0u;
const uint kTransmits = 1u;

struct Path {
  Ray ray;
  vec3 throughput;
  vec3 radiance;  // of the sum so far, W/m²/sr
  uint branch;
  bool branched;  // past the first surface that could be seen both ways
  bool ended;
  uint events;
  uint seed;            // of the next chance
  float wavelength_nm;  // 0 until something dispersive was met
  uint instance;        // on which the ray starts
  uint triangle;
  Interior interior;
};

/// What the chain was drawn to see lit.
struct Receiver {
  bool found;
  uint instance;
  uint triangle;
  float u;
  float v;
  vec3 dir;  // of the ray that meets it
  float ior_from;
  float weight;
};

float draw(inout Path path) {
  path.seed = hashChain(path.seed, 1u);
  return float(path.seed >> 8) / 16777216.0;
}

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }
float luminanceOf(vec3 rgb) { return dot(rgb, vec3(0.2126, 0.7152, 0.0722)); }

vec3 transmittanceOf(uint material, float distance) {
  return kSceneHasMedia ? transmittance(fetchMedium(material).sigma_a, distance) : vec3(1.0);
}

float iorOf(Medium medium, float wavelength_nm) {
  if (!kSceneDisperses || medium.dispersion == 0.0 || wavelength_nm == 0.0) return medium.ior;
  return dispersiveIor(medium.ior, medium.dispersion, wavelength_nm);
}

/// Each pixel goes through all bands in as many frames, in an order that spreads them.
void drawWavelength(inout Path path, uvec2 pixel) {
  uint first = hashChain(pixel.x + (pixel.y << 16), 0x57u);
  vec4 band = texelFetch(band_table, texelOf((first + push.frame * 39u) % band_count), 0);
  path.wavelength_nm = band.x;
  path.throughput *= band.yzw;
}

Surface surfaceMet(uint instance_index, uint triangle, float u, float v) {
  InstanceRecord instance = fetchInstance(instance_index);
  TriangleRecord record = fetchTriangle(instance.first_triangle + triangle);
  Surface s = surfaceAt(instance_index, triangle, instance, record, toWorld(instance, record), u, v);
  return s;
}

/// Turns both normals to where the ray comes from.
Surface turnTowards(Surface s, vec3 dir) {
  if (kSceneHasTextures) s.shading = perturbedNormal(s);
  if (dot(dir, s.geometric) >= 0.0) {
    s.geometric = -s.geometric;
    s.shading = -s.shading;
  }
  // Near a silhouette the interpolated normal may look away from the path: the true one cannot.
  if (dot(s.shading, -dir) <= 1e-4) s.shading = s.geometric;
  return s;
}

void goOn(inout Path path, Surface s, vec3 dir) {
  float side = dot(s.geometric, dir) >= 0.0 ? s.position_error : -s.position_error;
  path.ray = Ray(s.position + side * s.geometric, dir);
  path.instance = s.instance_index;
  path.triangle = s.triangle;
}

/// Light that a rough interface passes on straight from the lights without a size, which no ray meets.
vec3 lobeLight(Surface s, SurfaceOptics optics, vec3 wo) {
  Axes axes = axesAbout(s.shading);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < push.light_count; ++i) {
    LightRecord light = fetchLight(i);
    if (light.view_count == 0u || light.has_size != 0u) continue;
    Arriving arriving = arriveFrom(light, s.position);
    vec3 wi = toLocal(axes, arriving.dir);
    bool same_side = dot(arriving.dir, s.geometric) > 0.0;
    if (same_side != (wi.z > 0.0) || largest(arriving.irradiance) <= 0.0) continue;
    float side = same_side ? s.position_error : -s.position_error;
    Place place = Place(s.position + side * s.geometric, s.instance_index, s.triangle);
    sum += evaluateRough(optics, toLocal(axes, wo), wi) * arriving.irradiance * abs(wi.z) *
           visibilityOf(i, light, place, arriving, s.position);
  }
  return sum;
}

/// Chances of the ways on from a surface.
struct Ways {
  float reflected;
  float transmitted;
  float lit;  // to see the surface itself
};

Ways weigh(Path path, Scattered scattered, MaterialPoint m, Surface s, vec3 wo, bool is_specular) {
  if (!is_specular) return Ways(0.0, 0.0, 1.0);
  float lit = 0.0;
  if (path.events > 0u && m.base_weight > 0.0)
    lit = m.base_weight * luminanceOf(m.optics.base * baseFactor(m.optics, interfaceFresnel(m.optics, dot(wo, s.shading))));
  // By flux: then a chain through glass that loses nothing has the same throughput after each surface.
  Ways ways = Ways(luminanceOf(scattered.reflected_weight),
                   luminanceOf(scattered.transmitted_weight) / radianceScale(m.optics), lit);
  float sum = ways.reflected + ways.transmitted + ways.lit;
  float inverse = sum > 0.0 ? 1.0 / sum : 0.0;
  return Ways(ways.reflected * inverse, ways.transmitted * inverse, ways.lit * inverse);
}

/// Goes on by reflection or transmission; the first time both ways, a chain each.
/// @return  whether the chain goes through the surface
bool chooseWay(inout Path path, Scattered scattered, Ways ways, float u) {
  bool through;
  if (!path.branched) {
    through = path.branch == kTransmits;
    path.branched = true;
    path.throughput *= through ? scattered.transmitted_weight : scattered.reflected_weight;
  } else {
    through = u >= ways.reflected;
    float chance = through ? ways.transmitted : ways.reflected;
    vec3 weight = through ? scattered.transmitted_weight : scattered.reflected_weight;
    path.throughput *= chance > 0.0 ? weight / chance : vec3(0.0);
  }
  return through;
}

/// What a chain meets at a surface. @return  the surface itself, if it is drawn
Receiver meet(inout Path path, Met met, uvec2 pixel) {
  Receiver receiver = Receiver(false, met.instance, met.triangle, met.u, met.v, path.ray.dir, 1.0, 1.0);
  Surface s = surfaceMet(met.instance, met.triangle, met.u, met.v);
  MaterialPoint m = materialAt(s.instance, s.triangle, s.u, s.v);
  bool is_solid = kSceneTransmits && m.optics.is_solid != 0u;
  bool entering = dot(path.ray.dir, s.geometric) < 0.0;
  uint inside = mediumOf(path.interior, kNowhere);
  Boundary boundary = Boundary(inside, inside, true);
  Medium filling = Medium(m.optics.ior_to, 0.0, vec3(0.0), 0);
  if (is_solid) {
    filling = fetchMedium(s.instance.material);
    boundary = boundaryAt(path.interior, s.instance.solid, s.instance.material, filling.priority, entering);
    // Met from the inside without having entered: the way here was inside.
    if (!entering && !contains(path.interior, s.instance.solid)) inside = s.instance.material;
  }
  path.throughput *= transmittanceOf(inside, met.t);
  if (kSceneEmits && path.events > 0u && (entering || m.double_sided)) path.radiance += path.throughput * m.emission;

  s = turnTowards(s, path.ray.dir);
  bool hole = m.coverage < 1.0 && chanceOf(pixel, path.events == 0u ? push.frame : path.seed, s, 0u) >= m.coverage;
  bool hidden = is_solid && !boundary.is_event && !hole;
  bool crosses = is_solid && hidden;
  vec3 dir = path.ray.dir;
  bool mirrored = false;
  if (!hole && !hidden) {
    Medium from = fetchMedium(boundary.from), to = fetchMedium(boundary.to);
    bool disperses = kSceneDisperses && path.wavelength_nm == 0.0 && (from.dispersion > 0.0 || to.dispersion > 0.0);
    if (disperses) drawWavelength(path, pixel);
    m.optics.ior_from = iorOf(from, path.wavelength_nm);
    if (is_solid) m.optics.ior_to = iorOf(to, path.wavelength_nm);
    bool is_specular = m.optics.alpha < push.specular_alpha;
    vec2 u = kSceneHasRoughSpecular ? vec2(draw(path), draw(path)) : vec2(0.0);
    Scattered scattered = kSceneHasRoughSpecular && m.optics.alpha > 0.0
                              ? scatterRough(m.optics, dir, s.shading, u)
                              : scatterSmooth(m.optics, dir, s.shading);
    bool is_rough = kSceneHasRoughSpecular && is_specular && m.optics.alpha > 0.0;
    if (is_rough && (path.branched || path.branch == kReflects))
      path.radiance += path.throughput * lobeLight(s, m.optics, -dir);
    Ways ways = weigh(path, scattered, m, s, -dir, is_specular);
    float choice = draw(path);
    bool sees_it = ways.lit > 0.0 && choice < ways.lit;
    if (sees_it) {
      receiver.found = path.events > 0u;
      receiver.ior_from = m.optics.ior_from;
      receiver.weight = 1.0 / ways.lit;
      path.ended = true;
    } else {
      bool through = chooseWay(path, scattered, ways, choice - ways.lit);
      dir = through ? scattered.transmitted : scattered.reflected;
      // Light must be on the same side of the true and the shaded surface, else it leaks through.
      if ((dot(dir, s.geometric) > 0.0) == through) path.throughput = vec3(0.0);
      bool passes = through && m.optics.is_pane != 0u && m.optics.alpha == 0.0;
      path.events += passes ? 0u : 1u;
      crosses = is_solid && through;
      mirrored = is_solid && !through;
      path.ended = largest(abs(path.throughput)) == 0.0 || path.events >= max_events;
    }
  }
  // From the inside of a solid that was not listed: it is now known to be inside.
  bool enters = crosses ? entering : mirrored && !entering && !contains(path.interior, s.instance.solid);
  if (kSceneTransmits && enters) {
    if (isFull(path.interior)) path.ended = true;
    path.interior = enter(path.interior, s.instance.solid, s.instance.material, filling.priority);
  } else if (kSceneTransmits && crosses) {
    path.interior = leave(path.interior, s.instance.solid);
  }
  goOn(path, s, dir);
  return receiver;
}

Path startPath(Ray ray, uvec2 pixel, uint branch) {
  uint seed = hashChain(hashChain(hashChain(0u, pixel.x + (pixel.y << 16)), push.frame), branch);
  return Path(ray, vec3(1.0), vec3(0.0), branch, false, false, 0u, seed, 0.0, kNowhere, 0u, kInTheOpen);
}

/// What is shown of a pixel's first surface.
Met metSeen(Ray ray, uvec2 seen) {
  InstanceRecord instance = fetchInstance(seen.x - 1u);
  Triangle corners = toWorld(instance, fetchTriangle(instance.first_triangle + seen.y));
  vec3 weights = weightsOn(corners, ray);
  vec3 place = corners.a + weights.y * (corners.b - corners.a) + weights.z * (corners.c - corners.a);
  return Met(dot(place - ray.origin, ray.dir), weights.y, weights.z, seen.x - 1u, seen.y);
}

/// Light that the chain's last surface sends along it.
vec3 litRadiance(Receiver receiver) {
  Surface s = turnTowards(surfaceMet(receiver.instance, receiver.triangle, receiver.u, receiver.v), receiver.dir);
  MaterialPoint m = materialAt(s.instance, s.triangle, s.u, s.v);
  m.optics.ior_from = receiver.ior_from;
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < push.light_count; ++i) sum += lightFrom(i, s, m, -receiver.dir, push.specular_alpha);
  return sum * receiver.weight;
}

/// Radiance of one chain, W/m²/sr.
vec3 followChain(Ray ray, uvec2 pixel, uint branch) {
  Path path = startPath(ray, pixel, branch);
  Receiver receiver = Receiver(false, 0u, 0u, 0.0, 0.0, ray.dir, 1.0, 0.0);
  // Panes and holes are no events; the limit on steps keeps two facing panes from holding a path for ever.
  for (uint step = 0u; step < 4u * max_events && !path.ended; ++step) {
    Met met;
    // What lies before the surface that is shown may reflect too, if it can be seen through.
    if (step == 0u && !kSceneHasPassable) {
      met = metSeen(ray, texelFetch(seen_image, ivec2(pixel), 0).xy);
    } else {
      met = meetFirst(path.ray, path.instance, path.triangle);
    }
    if (kSceneHasLamps && path.events > 0u) path.radiance += path.throughput * lampsSeen(path.ray, met.t);
    if (met.instance == kNowhere) {
      path.throughput *= transmittanceOf(mediumOf(path.interior, kNowhere), kFarAway);
      if (kSceneHasEnvironment && path.events > 0u) path.radiance += path.throughput * environmentFrom(path.ray.dir);
      path.ended = true;
    } else {
      receiver = meet(path, met, pixel);
    }
  }
  if (receiver.found) path.radiance += path.throughput * litRadiance(receiver);
  return path.radiance;
}

void showPixel(uint listed) {
  uvec2 pixel = uvec2(listed & 0xFFFFu, listed >> 16);
  vec2 size = vec2(imageSize(specular_image));
  Ray ray = rayThrough(views[0], (vec2(pixel) + push.film_offset) / size * 2.0 - 1.0);
  vec3 sum = vec3(0.0);
  for (uint branch = 0u; branch < (kSceneTransmits ? 2u : 1u); ++branch) sum += followChain(ray, pixel, branch);
  ivec2 place = ivec2(pixel);
  imageStore(specular_image, place, imageLoad(specular_image, place) + vec4(sum, 0.0));
}

void main() {
  // Few threads that go through the list: a device that runs threads in step has them all at work.
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint i = gl_GlobalInvocationID.x; i < pixel_count; i += threads) showPixel(pixels[i]);
}
