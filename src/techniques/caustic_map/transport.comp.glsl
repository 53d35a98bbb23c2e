// From the light to where its photons end: one thread a cell of the emission grid, one branch a dispatch.
//
// Emission, refraction at front and back faces, and the receiver, all in pictures that the light takes
// ([shah-caustics-mapping] §III-B to D). Photons stay in the order of the grid; those that end nowhere say why.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame.shared.h"
#include "techniques/caustic_map/transport.shared.h"

layout(push_constant, scalar) uniform Push { TransportPush push; };
#define max_events push.max_events

layout(scalar, set = 0, binding = 7) readonly buffer LayerViews { ViewRecord layer_views[]; };
#include "techniques/caustic_map/layered_view.glsl"
#include "frame/emission.shared.h"
#define NEPHROID_PHOTON_BINDING 14
#include "frame/photons.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 8) readonly buffer Lights { LightRecord lights[]; };
layout(set = 0, binding = 9) uniform usampler2DArray first_seen;  // of the emission's views: all that there is
layout(set = 0, binding = 10) uniform usampler2DArray generator_seen;
layout(set = 0, binding = 11) uniform sampler2DArray generator_surfaces;
layout(set = 0, binding = 12) uniform usampler2DArray receiver_seen;
layout(set = 0, binding = 13) uniform sampler2DArray receiver_surfaces;

/// A photon on its way.
struct Flight {
  Path path;
  uint chain;
  uint outcome;
  float last_distance;  // m, since the last event
};

/// Goes on along the branch: reflected or let through at the first surface; inside, reflected so many times before it
/// leaves. Where light is reflected totally there is no choice.
Way chooseBranch(Way reflected, Way transmitted, uint events, bool is_inside) {
  if (events == 0u) return push.branch == 0u ? reflected : transmitted;
  bool can_leave = largest(transmitted.weight) > 0.0;
  if (!is_inside) return largest(reflected.weight) >= largest(transmitted.weight) ? reflected : transmitted;
  return can_leave && events >= push.branch ? transmitted : reflected;
}

void meetGenerator(inout Flight flight, Met met) {
  bool emission_seen;
  uint events = flight.path.events;
  Encounter e = encounter(flight.path, met, emission_seen);
  SurfaceOptics optics = e.material.optics;
  if (e.crossing.is_solid && !e.boundary.is_event) {
    passOn(flight.path, e.surface, e.crossing);
    return;
  }
  Medium from = fetchMedium(e.boundary.from), to = fetchMedium(e.boundary.to);
  optics.ior_from = iorOf(from, flight.path.wavelength_nm);
  if (e.crossing.is_solid) optics.ior_to = iorOf(to, flight.path.wavelength_nm);
  Scattered scattered = scatterSmooth(optics, flight.path.ray.dir, e.surface.shading);
  Way reflected = reflection(scattered, e.surface), transmitted = transmission(scattered, e.surface);
  // Of flux, not of radiance: it does not know the index.
  transmitted.weight /= radianceScale(optics);
  Way way = chooseBranch(reflected, transmitted, events, e.crossing.is_solid && !e.crossing.entering);
  flight.chain = hashChain(flight.chain, 2u * met.instance + (way.through ? 1u : 0u));
  take(flight.path, way, e.surface, e.crossing, false);
  if (largest(flight.path.throughput) <= 0.0) flight.outcome = events == 0u ? kOutcomeNoWay : kOutcomeAbsorbed;
  else if (flight.path.ended) flight.outcome = flight.path.events >= max_events ? kOutcomeBounceLimit : kOutcomeInterior;
}

/// The next surface, or how the flight ends.
Met meetNext(inout Flight flight, Pictures generators, Pictures receivers) {
  bool hidden = false, hidden_receiver = false;
  Ray ray = flight.path.ray;
  float t_end = leaveBox(ray, push.generator_lower, push.generator_upper);
  Met met = meetLayers(ray, t_end, generators, generator_seen, generator_surfaces, push.iterations, hidden);
  t_end = leaveBox(ray, push.scene_lower, push.scene_upper);
  Met receiver = meetLayers(ray, t_end, receivers, receiver_seen, receiver_surfaces, push.iterations, hidden_receiver);
  if (receiver.t < met.t) met = receiver;
  if (met.instance == kNowhere) {
    flight.outcome = hidden || hidden_receiver ? kOutcomeHidden : kOutcomeEscaped;
    flight.path.ended = true;
  }
  return met;
}

Photon describe(Flight flight, vec3 place, uint index) {
  Photon photon;
  bool valid = flight.outcome == kOutcomeDeposited;
  uint flags = (valid ? kPhotonValid : 0u) | (flight.outcome == kOutcomeEscaped ? kPhotonLeftScene : 0u) |
               (flight.outcome << kOutcomeShift);
  photon.position = place;
  photon.path_length = flight.last_distance;
  photon.direction = flight.path.ray.dir;
  photon.light_band_flags = packLightBandFlags(push.light, 0u, flags);
  photon.flux = flight.path.throughput;
  photon.index = index;
  photon.chain = flight.chain;
  photon.footprint_major = photon.footprint_minor = 0.0;
  photon.footprint_orientation = 0u;
  return photon;
}

void main() {
  uvec2 cell = gl_GlobalInvocationID.xy;
  if (cell.x >= push.grid || cell.y >= push.grid) return;
  ViewRecord view = layer_views[push.view];
  vec2 film = (vec2(cell) + push.offset) / float(push.grid) * 2.0 - 1.0;
  EmissionRay emitted = emissionRay(view, film.x, film.y);
  vec3 flux = cellFlux(lights[push.light], view, film.x, film.y, 1.0 / float(push.grid * push.grid));
  Ray ray = Ray(emitted.origin, emitted.dir);
  Flight flight = Flight(Path(ray, flux, false, false, 0u, 0u, 0.0, kNowhere, 0u, kInTheOpen), 0u, kOutcomeDeposited, 0.0);

  Pictures generators = Pictures(0u, push.generator_views, push.generator_layers, push.generator_size);
  Pictures receivers = Pictures(push.generator_views, push.receiver_views, 1u, push.receiver_size);
  ivec3 texel = ivec3(ivec2((film * 0.5 + 0.5) * push.generator_size), push.view);
  uvec2 seen = texelFetch(first_seen, texel, 0).xy;
  Met met = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  if (seen.x != 0u) met = meetPlaneOf(ray, seen);
  if (met.instance == kNowhere) flight.outcome = kOutcomeMissed;
  else if ((fetchInstance(met.instance).flags & kInstanceGenerates) == 0u) flight.outcome = kOutcomeBlocked;
  flight.path.ended = flight.outcome != kOutcomeDeposited;

  vec3 place = ray.origin;
  // Surfaces of solids that others rule are no events.
  for (uint i = 0u; i < 2u * max_events && !flight.path.ended; ++i) {
    if (i > 0u) met = meetNext(flight, generators, receivers);
    if (flight.path.ended) continue;
    flight.last_distance = met.t;
    if ((fetchInstance(met.instance).flags & kInstanceGenerates) != 0u) {
      meetGenerator(flight, met);
    } else {
      bool emission_seen;
      place = flight.path.ray.origin + met.t * flight.path.ray.dir;
      encounter(flight.path, met, emission_seen);
      flight.chain = hashChain(flight.chain, 2u * met.instance);
      flight.path.ended = true;
    }
  }
  if (!flight.path.ended) flight.outcome = kOutcomeBounceLimit;
  photons[cell.y * push.grid + cell.x] = describe(flight, place, cell.y * push.grid + cell.x);
}
