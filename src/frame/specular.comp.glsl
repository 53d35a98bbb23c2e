// One frame's sample of `specular`: what mirrors, glass and water show.
//
// From each listed pixel two chains are followed, one that the first surface reflects and one that it lets through; at
// every further surface one way on is drawn in proportion to what it carries, so that the mean over frames is the sum of
// all. A chain ends on the first surface that it is drawn to see lit (class D), or where it leaves the scene.
//
// One loop follows both chains, one after the other: of threads that go in step, none waits for the others between them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#define NEPHROID_LIGHT_BINDINGS 7
#include "frame/lights.glsl"
#include "frame/passable.glsl"
#include "frame/specular_push.glsl"
#include "frame/path.glsl"
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

/// What a pixel's chains have come to.
struct Chains {
  Path path;      // that is followed
  Path other;     // to follow when that has ended: the other way on from the first surface
  vec3 radiance;  // of both so far, W/m²/sr
};

/// What a chain was drawn to see lit.
struct Receiver {
  bool found;
  uint instance;
  uint triangle;
  float u;
  float v;
  vec3 dir;  // of the ray that meets it
  float ior_from;
  vec3 weight;
};

const Receiver kNoReceiver = Receiver(false, 0u, 0u, 0.0, 0.0, vec3(0.0), 1.0, vec3(0.0));

/// Each pixel goes through all bands in as many frames, in an order that spreads them.
void drawWavelength(inout Path path, uvec2 pixel) {
  uint first = hashChain(pixel.x + (pixel.y << 16), 0x57u);
  vec4 band = texelFetch(band_table, texelOf((first + push.frame * 39u) % band_count), 0);
  path.wavelength_nm = band.x;
  path.throughput *= band.yzw;
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

/// Goes on by reflection or transmission; the first time both ways, one of which waits.
/// @param u  decides, in [0, 1 − chance to see the surface itself)
void branchOrChoose(inout Chains chains, Way reflected, Way transmitted, Ways ways, float u, Surface s,
                    Crossing crossing, bool is_smooth_pane) {
  bool first = !chains.path.branched;
  chains.path.branched = true;
  if (kSceneTransmits && first) {
    chains.other = chains.path;
    chains.other.seed = hashChain(chains.path.seed, 2u);
    take(chains.other, transmitted, s, crossing, is_smooth_pane);
  }
  Way way = reflected;
  if (!first && u >= ways.reflected) way = transmitted;
  float chance = first ? 1.0 : way.through ? ways.transmitted : ways.reflected;
  way.weight *= chance > 0.0 ? 1.0 / chance : 0.0;
  take(chains.path, way, s, crossing, is_smooth_pane);
}

/// What a chain meets at a surface. @return  the surface itself, if it is drawn
Receiver meet(inout Chains chains, Met met, uvec2 pixel) {
  Path path = chains.path;
  Receiver receiver = kNoReceiver;
  bool emission_seen;
  Encounter e = encounter(path, met, emission_seen);
  Surface s = e.surface;
  MaterialPoint m = e.material;
  Boundary boundary = e.boundary;
  Crossing crossing = e.crossing;
  bool is_solid = crossing.is_solid;
  if (kSceneEmits && path.events > 0u && emission_seen) chains.radiance += path.throughput * m.emission;

  bool hole = m.coverage < 1.0 && chanceOf(pixel, path.events == 0u ? push.frame : path.seed, s, 0u) >= m.coverage;
  bool hidden = is_solid && !boundary.is_event && !hole;
  if (hole || hidden) {
    crossing.is_solid = hidden;
    passOn(path, s, crossing);
    chains.path = path;
  } else {
    Medium from = fetchMedium(boundary.from), to = fetchMedium(boundary.to);
    bool disperses = kSceneDisperses && path.wavelength_nm == 0.0 && (from.dispersion > 0.0 || to.dispersion > 0.0);
    if (disperses) drawWavelength(path, pixel);
    m.optics.ior_from = iorOf(from, path.wavelength_nm);
    if (is_solid) m.optics.ior_to = iorOf(to, path.wavelength_nm);
    bool is_specular = m.optics.alpha < push.specular_alpha;
    vec2 u = kSceneHasRoughSpecular ? vec2(draw(path), draw(path)) : vec2(0.0);
    vec3 wo = -path.ray.dir;
    Scattered scattered = kSceneHasRoughSpecular && m.optics.alpha > 0.0
                              ? scatterRough(m.optics, -wo, s.shading, u)
                              : scatterSmooth(m.optics, -wo, s.shading);
    bool is_rough = kSceneHasRoughSpecular && is_specular && m.optics.alpha > 0.0;
    if (is_rough) chains.radiance += path.throughput * lobeLight(s, m.optics, wo);
    Ways ways = weigh(path, scattered, m, s, wo, is_specular);
    float choice = draw(path);
    bool sees_it = ways.lit > 0.0 && choice < ways.lit;
    chains.path = path;
    if (sees_it) {
      receiver = Receiver(path.events > 0u, met.instance, met.triangle, met.u, met.v, -wo, m.optics.ior_from,
                          path.throughput / ways.lit);
      chains.path.ended = true;
    } else {
      branchOrChoose(chains, reflection(scattered, s), transmission(scattered, s), ways, choice - ways.lit, s, crossing,
                     m.optics.is_pane != 0u && m.optics.alpha == 0.0);
    }
  }
  return receiver;
}

Chains startChains(Ray ray, uvec2 pixel) {
  uint seed = hashChain(hashChain(0u, pixel.x + (pixel.y << 16)), push.frame);
  Path path = Path(ray, vec3(1.0), false, false, 0u, seed, 0.0, kNowhere, 0u, kInTheOpen);
  Path none = path;
  none.ended = true;
  return Chains(path, none, vec3(0.0));
}

/// Light that a chain's last surface sends along it.
vec3 litRadiance(Receiver receiver) {
  Surface s = turnTowards(surfaceMet(receiver.instance, receiver.triangle, receiver.u, receiver.v), receiver.dir);
  MaterialPoint m = materialAt(s.instance, s.triangle, s.u, s.v);
  m.optics.ior_from = receiver.ior_from;
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < push.light_count; ++i) sum += lightFrom(i, s, m, -receiver.dir, push.specular_alpha);
  return sum * receiver.weight;
}

/// A step of a chain: to the next surface, or out of the scene. @return  what it was drawn to see lit
Receiver followStep(inout Chains chains, uvec2 pixel, bool is_first) {
  Met met;
  // What lies before the surface that is shown may reflect too, if it can be seen through.
  if (is_first && !kSceneHasPassable) {
    met = metSeen(chains.path.ray, texelFetch(seen_image, ivec2(pixel), 0).xy);
  } else {
    met = meetFirst(chains.path.ray, chains.path.instance, chains.path.triangle);
  }
  bool shows_lights = chains.path.events > 0u;
  if (kSceneHasLamps && shows_lights) chains.radiance += chains.path.throughput * lampsSeen(chains.path.ray, met.t);
  if (met.instance != kNowhere) return meet(chains, met, pixel);
  chains.path.throughput *= transmittanceOf(mediumOf(chains.path.interior, kNowhere), kFarAway);
  if (kSceneHasEnvironment && shows_lights)
    chains.radiance += chains.path.throughput * environmentFrom(chains.path.ray.dir);
  chains.path.ended = true;
  return kNoReceiver;
}

/// Radiance of both chains of a pixel, W/m²/sr.
vec3 followChains(Ray ray, uvec2 pixel) {
  Chains chains = startChains(ray, pixel);
  Receiver first = kNoReceiver, second = kNoReceiver;
  // Panes and holes are no events; the limit on steps keeps two facing panes from holding a path for ever.
  for (uint step = 0u; step < 8u * max_events && !chains.path.ended; ++step) {
    Receiver receiver = followStep(chains, pixel, step == 0u);
    if (receiver.found) {
      second = first;
      first = receiver;
    }
    if (chains.path.ended) {
      chains.path = chains.other;
      chains.other.ended = true;
    }
  }
  while (first.found) {
    chains.radiance += litRadiance(first);
    first = second;
    second.found = false;
  }
  return chains.radiance;
}

void showPixel(uint listed) {
  uvec2 pixel = uvec2(listed & 0xFFFFu, listed >> 16);
  vec2 size = vec2(imageSize(specular_image));
  Ray ray = rayThrough(views[0], (vec2(pixel) + push.film_offset) / size * 2.0 - 1.0);
  ivec2 place = ivec2(pixel);
  imageStore(specular_image, place, imageLoad(specular_image, place) + vec4(followChains(ray, pixel), 0.0));
}

/// Groups in the order of their reversed bits: a device that gives each of its cores a range of groups so gives it pixels
/// from all over the list, however short that is.
uint spreadGroup() {
  uint bits = uint(findMSB(gl_NumWorkGroups.x));
  return bits == 0u ? 0u : bitfieldReverse(gl_WorkGroupID.x) >> (32u - bits);
}

void main() {
  // Few threads that go through the list: a device that runs threads in step has them all at work.
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  uint thread = spreadGroup() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  for (uint i = thread; i < pixel_count; i += threads) showPixel(pixels[i]);
}
