// One frame's sample of `specular`: what mirrors, glass and water show, surface by surface.
//
// From each listed pixel two chains are followed, one that the first surface reflects and one that it lets through. A
// chain ends on the first surface that it sees lit (class D), or where it leaves the scene. What becomes of it at every
// further surface is one of two tasks, each a pipeline of its own:
//
// - kShow: one way on is drawn in proportion to what it carries, so that the mean over frames is the sum of all. In
//   pixels where that is shown otherwise it first goes the way that carries most, up to a surface at which it is drawn to
//   take another.
// - kFollowMost: at points of the grid, the way that carries most; where that ends is noted (specular_ends.glsl), and
//   specular_lit.comp.glsl shows it in those pixels of a cell that kShow would have drawn it in.
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
#define NEPHROID_TREE_BINDINGS 17
#include "frame/triangle_tree.glsl"
#define NEPHROID_SKY_BINDINGS 14
#include "frame/sky.glsl"
#define NEPHROID_GRID_BINDINGS 19
#include "frame/specular_grid.glsl"
#include "frame/specular_ends.glsl"
#include "frame/specular_others.glsl"
#define NEPHROID_RECEIVER_BINDINGS 21
#include "frame/receiver_map.glsl"

layout(local_size_x = 64) in;
layout(scalar, set = 0, binding = 11) uniform Views { ViewRecord views[1]; };
layout(set = 0, binding = 12, rgba32ui) writeonly uniform uimageBuffer stored_ends;
layout(set = 0, binding = 13) uniform samplerBuffer band_table;  // wavelength in nm, and weight times their count
layout(set = 0, binding = 16, rgba32f) uniform image2D specular_image;  // sum over samples, W/m²/sr

const uint kShow = 0u;
const uint kFollowMost = 1u;
layout(constant_id = 17) const uint kTask = kShow;

/// What a pixel's chains have come to.
struct Chains {
  Path path;      // that is followed
  Path other;     // to follow when that has ended: the other way on from the first surface
  vec3 radiance;  // of both so far, W/m²/sr
  uint flags;     // with which the pixel is listed
  uint way;       // of the first surface that `path` took: kReflected, kTransmitted
  bool draws;     // kShow: its ways; else it goes the one that carries most
  float to_pass;  // kShow: takeOther's
  // kFollowMost:
  uint met;       // hash of the surfaces met by `path`, and the ways taken
  uint met_first;  // of the first of them
  bool unsure;     // pixels nearby may show something else than the hash tells
  bool unsure_first;
  bool escaped;   // `path` has left the scene
  float others;   // chance with which `path` would have been drawn to take another way somewhere
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
  vec4 band = texelFetch(band_table, int((first + push.frame * 39u) % band_count));
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

/// How much light the ways on from a surface carry, or the chances with which they are taken.
struct Ways {
  float reflected;
  float transmitted;
  float lit;  // to see the surface itself
};

/// By flux: then a chain through glass that loses nothing carries the same after each surface.
Ways weigh(Path path, Scattered scattered, MaterialPoint m, Surface s, vec3 wo, bool is_specular) {
  if (!is_specular) return Ways(0.0, 0.0, 1.0);
  float lit = 0.0;
  if (path.events > 0u && m.base_weight > 0.0)
    lit = m.base_weight * luminanceOf(m.optics.base * baseFactor(m.optics, interfaceFresnel(m.optics, dot(wo, s.shading))));
  return Ways(luminanceOf(scattered.reflected_weight),
              luminanceOf(scattered.transmitted_weight) / radianceScale(m.optics), lit);
}

Ways scaled(Ways ways, float factor) {
  return Ways(ways.reflected * factor, ways.transmitted * factor, ways.lit * factor);
}

/// What is done at a surface.
struct Choice {
  bool sees_it;
  bool through;  // else
  float chance;  // with which it was drawn
};

Choice drawWay(Ways ways, float u) {
  float sum = ways.reflected + ways.transmitted + ways.lit;
  ways = scaled(ways, sum > 0.0 ? 1.0 / sum : 0.0);
  bool sees_it = ways.lit > 0.0 && u < ways.lit;
  bool through = u - ways.lit >= ways.reflected;
  return Choice(sees_it, through, sees_it ? ways.lit : through ? ways.transmitted : ways.reflected);
}

/// The way that carries most, or, as drawn once for all surfaces, another.
Choice chooseWay(inout Chains chains, Ways ways, float u) {
  if (chains.draws) return drawWay(ways, u);
  vec3 chances = vec3(ways.reflected, ways.transmitted, ways.lit);
  float sum = chances.x + chances.y + chances.z;
  chances *= sum > 0.0 ? 1.0 / sum : 0.0;
  uint taken = mostOf(chances);
  float chance = chances[taken];
  vec3 others = chances * vec3(notEqual(uvec3(taken), uvec3(0u, 1u, 2u)));
  chains.others += (1.0 - chains.others) * (others.x + others.y + others.z);
  if (kTask == kShow) {
    uint drawn = takeOther(others, chains.to_pass);
    if (drawn < 3u) {
      chains.draws = true;
      taken = drawn;
      chance = others[drawn];
    }
  }
  return Choice(taken == 2u, taken == 1u, chance);
}

/// Goes on by reflection or transmission; the first time both ways, one of which waits.
void branchOrChoose(inout Chains chains, Way reflected, Way transmitted, Choice choice, Surface s, Crossing crossing,
                    bool is_smooth_pane) {
  bool first = !chains.path.branched;
  chains.path.branched = true;
  if (kSceneTransmits && first) {
    chains.other = chains.path;
    chains.other.seed = hashChain(chains.path.seed, 2u);
    take(chains.other, transmitted, s, crossing, is_smooth_pane);
    if ((chains.flags & kNoTransmitted) != 0u) chains.other.ended = true;
  }
  Way way = reflected;
  if (!first && choice.through) way = transmitted;
  float chance = first ? 1.0 : choice.chance;
  way.weight *= chance > 0.0 ? 1.0 / chance : 0.0;
  take(chains.path, way, s, crossing, is_smooth_pane);
  if (first && (chains.flags & kNoReflected) != 0u) chains.path.ended = true;
}

/// A surface tells its neighbours apart from others: flat ones face by face, because light makes a jump between them.
uint identify(Surface s, uint taken) {
  uint face = s.shading == s.geometric ? packUnitVector(s.geometric) : 0u;
  return hashChain(hashChain(s.instance_index, face), taken);
}

/// Is what the chains meet seen, or known already?
bool isShown(Chains chains) { return kTask == kShow && chains.draws; }

/// Of kFollowMost.
void noteSurface(inout Chains chains, uint surface, bool is_first, bool unsure) {
  chains.met = hashChain(chains.met, surface);
  chains.unsure = chains.unsure || unsure;
  if (!is_first) return;
  chains.met_first = chains.met;
  chains.unsure_first = chains.unsure;
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
  bool emits = kSceneEmits && path.events > 0u && emission_seen;
  if (emits && isShown(chains)) chains.radiance += path.throughput * m.emission;

  bool hole = m.coverage < 1.0 && chanceOf(pixel, path.events == 0u ? push.frame : path.seed, s, 0u) >= m.coverage;
  bool hidden = is_solid && !boundary.is_event && !hole;
  if (hole || hidden) {
    crossing.is_solid = hidden;
    if (kTask == kFollowMost) chains.met = hashChain(chains.met, identify(s, 4u));
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
    float u_way = draw(path);
    Choice choice;
    if (!path.branched) {
      choice = drawWay(ways, u_way);
    } else {
      choice = chooseWay(chains, ways, u_way);
    }
    chains.path = path;
    if (kTask == kFollowMost)
      noteSurface(chains, identify(s, !path.branched ? 3u : choice.sees_it ? 2u : choice.through ? 1u : 0u), !path.branched,
                  is_specular && (m.varies || (emits && !choice.sees_it && m.emission != vec3(0.0))));
    if (choice.sees_it) {
      bool shown = path.events > 0u && (kTask == kFollowMost || isShown(chains));
      receiver = Receiver(shown, met.instance, met.triangle, met.u, met.v, -wo, m.optics.ior_from,
                          path.throughput / choice.chance);
      chains.path.ended = true;
    } else {
      branchOrChoose(chains, reflection(scattered, s), transmission(scattered, s), choice, s, crossing,
                     m.optics.is_pane != 0u && m.optics.alpha == 0.0);
    }
  }
  return receiver;
}

Chains startChains(Ray ray, uvec2 pixel, uint flags) {
  uint seed = hashChain(hashChain(0u, pixel.x + (pixel.y << 16)), push.frame);
  Path path = Path(ray, vec3(1.0), false, false, 0u, seed, 0.0, kNowhere, 0u, kInTheOpen);
  Path none = path;
  none.ended = true;
  bool draws = kTask == kShow && (flags & kReflectedPassesBy) == 0u;
  float to_pass = kTask == kShow ? drawOther(pixel, push.frame, kReflected) : 0.0;
  return Chains(path, none, vec3(0.0), flags, kReflected, draws, to_pass, 0u, 0u, false, false, false, 0.0);
}

/// Light that a chain's last surface sends along it.
vec3 litRadiance(Receiver receiver, uvec2 pixel) {
  Surface s = turnTowards(surfaceMet(receiver.instance, receiver.triangle, receiver.u, receiver.v), receiver.dir);
  MaterialPoint m = materialAt(s.instance, s.triangle, s.u, s.v);
  m.optics.ior_from = receiver.ior_from;
  vec3 caustic = receiver.weight * causticFrom(s, m, -receiver.dir, push.specular_alpha);
  addToSpecularCaustic(ivec2(pixel), caustic);
  return receiver.weight * lightFromAll(push.light_count, s, m, -receiver.dir, push.specular_alpha) + caustic;
}

/// A step of a chain: to the next surface, or out of the scene. @return  what it was drawn to see lit
Receiver followStep(inout Chains chains, uvec2 pixel, bool is_first) {
  Met met;
  // What lies before the surface that is shown may reflect too, if it can be seen through.
  if (is_first && !kSceneHasPassable) {
    met = metSeen(chains.path.ray, imageLoad(seen_image, ivec2(pixel)).xy);
  } else {
    met = meetFirst(chains.path.ray, chains.path.instance, chains.path.triangle);
  }
  bool shows_lights = chains.path.events > 0u && isShown(chains);
  if (kSceneHasLamps && shows_lights) chains.radiance += chains.path.throughput * lampsSeen(chains.path.ray, met.t);
  if (met.instance != kNowhere) return meet(chains, met, pixel);
  chains.path.throughput *= transmittanceOf(mediumOf(chains.path.interior, kNowhere), kFarAway);
  if (kSceneHasEnvironment && shows_lights)
    chains.radiance += chains.path.throughput * environmentFrom(chains.path.ray.dir);
  chains.path.ended = true;
  chains.escaped = true;
  return kNoReceiver;
}

/// Tells the triangle that a chain ends on from others, but for those that go on in its plane: what lies between two
/// places on a plane lies on it too. With textures each has its own coordinates.
uint identifyFace(Surface s) {
  bool is_flat = !kSceneHasTextures && s.shading == s.geometric;
  float offset = dot(s.position, s.geometric);
  vec3 magnitude = abs(s.position);
  // Planes through the origin, but for rounding.
  if (abs(offset) <= 1e-5 * (magnitude.x + magnitude.y + magnitude.z)) offset = 0.0;
  // Rounded by 64 steps, so far that places on one plane mostly agree and those on the next stair never do; where they
  // do not agree, the cell is followed as any other.
  const uint kept = 0xFFFFFFC0u;
  return is_flat ? hashChain(packUnitVector(s.geometric), floatBitsToUint(offset) & kept) : s.triangle;
}

/// What kFollowMost is for.
void noteEnd(Chains chains, Receiver receiver, uvec2 point) {
  bool lit = receiver.found;
  vec3 weight = lit ? receiver.weight : kSceneHasEnvironment && chains.escaped ? chains.path.throughput : vec3(0.0);
  vec3 place = chains.path.ray.dir;
  uint face = 0u;
  if (lit) {
    Surface s = surfaceMet(receiver.instance, receiver.triangle, receiver.u, receiver.v);
    place = s.position;
    face = identifyFace(s);
  }
  uint chain = hashChain(hashChain(hashChain(chains.met, lit ? receiver.instance : kNowhere), face), stamp) | 1u;
  if (chains.unsure) chain = 0u;
  uint instance = lit ? receiver.instance : kNowhere;
  imageStore(stored_ends, texelOfEnd(point, chains.way, 0u), uvec4(floatBitsToUint(place), chain));
  imageStore(stored_ends, texelOfEnd(point, chains.way, 1u), floatBitsToUint(vec4(weight, chains.others)));
  imageStore(stored_ends, texelOfEnd(point, chains.way, 2u),
             uvec4(instance, receiver.triangle, packUnitVector(receiver.dir), floatBitsToUint(receiver.ior_from)));
}

void followOther(inout Chains chains, uvec2 pixel) {
  chains.path = chains.other;
  chains.other.ended = true;
  chains.way = kTransmitted;
  chains.met = chains.met_first;
  chains.unsure = chains.unsure_first;
  chains.escaped = false;
  chains.others = 0.0;
  chains.draws = kTask == kShow && (chains.flags & kTransmittedPassesBy) == 0u;
  if (kTask == kShow) chains.to_pass = drawOther(pixel, push.frame, kTransmitted);
}

/// Radiance of both chains of a pixel, W/m²/sr.
/// @param point  kFollowMost: of the grid
vec3 followChains(Ray ray, uvec2 pixel, uint flags, uvec2 point) {
  Chains chains = startChains(ray, pixel, flags);
  Receiver first = kNoReceiver, second = kNoReceiver;
  // Panes and holes are no events; the limit on steps keeps two facing panes from holding a path for ever.
  uint step = 0u;
  do {
    Receiver receiver = followStep(chains, pixel, step == 0u);
    ++step;
    if (kTask != kFollowMost && receiver.found) {
      second = first;
      first = receiver;
    }
    if (chains.path.ended) {
      if (kTask == kFollowMost) noteEnd(chains, receiver, point);
      bool both_ended = chains.way == kReflected && chains.other.ended;
      followOther(chains, pixel);
      if (kTask == kFollowMost && both_ended) noteEnd(chains, kNoReceiver, point);
    }
  } while (step < 8u * max_events && !chains.path.ended);
  if (kTask != kFollowMost && first.found) {
    do {
      chains.radiance += litRadiance(first, pixel);
      first = second;
      second.found = false;
    } while (first.found);
  }
  return chains.radiance;
}

Ray rayOf(uvec2 pixel) {
  return rayThrough(views[0], (vec2(pixel) + push.film_offset) / vec2(pictureSize()) * 2.0 - 1.0);
}

void followListed(uint packed_place) {
  uvec2 place = unpackPlace(packed_place);
  if (kTask == kFollowMost) {
    uvec2 pixel = pixelOfPoint(place);
    followChains(rayOf(pixel), pixel, 0u, place);
  } else {
    vec3 radiance = followChains(rayOf(place), place, packed_place, place);
    imageStore(specular_image, ivec2(place), imageLoad(specular_image, ivec2(place)) + vec4(radiance, 0.0));
  }
}

void main() {
  fetchFewLights();
  uint list = kTask == kShow ? kFollowedPixels : kPoints;
  uint first = firstOf(list), count = heads[list].count, i = firstListed();
  if (i >= count) return;
  // Whether there is more is asked at the end, here and below: a device that runs all branches runs a loop's body once
  // more to find that it is done.
  do {
    followListed(listed[first + i]);
    i += listedThreads();
  } while (i < count);
}
