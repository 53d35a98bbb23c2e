// From the light to where its photons end: one thread a cell of the emission grid, one branch a dispatch. Either all
// cells, or those of a list; then it is also noted which cells wait for the next branch.
//
// Emission, refraction at front and back faces, and the receiver ([shah-caustics-mapping] §III-B to D), by the tree of
// all triangles or in pictures that the light takes. Photons stay in the order of the grid; those that end nowhere
// say why.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/frame.shared.h"
#include "techniques/caustic_map/transport.shared.h"

layout(push_constant, scalar) uniform Push { TransportPush push; };
#define max_events push.max_events
#define tree_nodes push.tree_nodes
#define tree_orders push.tree_orders
#define tree_grid_lower push.tree_grid_lower
#define tree_grid_scale push.tree_grid_scale

layout(scalar, set = 0, binding = 7) uniform Views {
  Surroundings surroundings;
  ViewRecord emission_views[kMostViews];
  PictureView picture_views[2u * kMostViews];  // the same, then those of receivers
};
layout(set = 0, binding = 16) uniform usamplerBuffer neighbour_table;
layout(constant_id = 31) const uint kSearch = kSearchTree;
layout(constant_id = 32) const uint kExit = kExitExact;
#include "techniques/caustic_map/receiver_search.glsl"
#define NEPHROID_TREE_BINDINGS 24
#include "frame/triangle_tree.glsl"
#include "frame/emission.shared.h"
#define NEPHROID_PHOTON_BINDING 14
#include "frame/photons.glsl"
#define NEPHROID_CELL_LISTS_BINDING 19
#include "techniques/caustic_map/cell_lists.glsl"

layout(constant_id = 30) const bool kAccounts = false;  // keeps the ledger's accounts: costs time
layout(constant_id = 33) const uint kGeneratorViews = 1u;
layout(constant_id = 34) const uint kGeneratorLayers = 1u;
layout(constant_id = 35) const uint kReceiverViews = 1u;
layout(constant_id = 36) const uint kReceiverLayers = 1u;
layout(constant_id = 37) const bool kListed = false;
layout(constant_id = 38) const bool kFluxEq6 = false;
layout(constant_id = 39) const bool kLands = false;  // some generators have diffuse lobes too
layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, set = 0, binding = 8) readonly buffer Lights { LightRecord lights[]; };
layout(set = 0, binding = 9) uniform usampler2DArray first_seen;  // of the emission's views: all that there is
layout(set = 0, binding = 10) uniform usampler2DArray generator_seen;
layout(set = 0, binding = 11) uniform sampler2DArray generator_surfaces;
layout(set = 0, binding = 12) uniform usampler2DArray receiver_seen;
layout(set = 0, binding = 13) uniform sampler2DArray receiver_surfaces;
layout(set = 0, binding = 17) uniform sampler2DArray generator_depths;
layout(set = 0, binding = 18) uniform sampler2DArray receiver_depths;

#include "techniques/caustic_map/first_met.glsl"

layout(scalar, set = 0, binding = 15) writeonly buffer Accounts { PhotonAccount accounts[]; };

layout(scalar, set = 0, binding = 20) buffer Forks { Fork forks[]; };
layout(scalar, set = 0, binding = 21) buffer ForkInteriors { Interior fork_interiors[]; };
layout(scalar, set = 0, binding = 22) writeonly buffer FirstLandings { Photon first_landings[]; };
layout(scalar, set = 0, binding = 23) writeonly buffer SecondLandings { Photon second_landings[]; };
#define NEPHROID_STANDINGS_BINDING 26
#include "techniques/caustic_map/standings.glsl"

/// A photon on its way.
struct Flight {
  Path path;
  uint cell;
  uint turn;  // of the loop that it goes on in
  uint chain;
  uint outcome;
  uint chances;         // to leave what it is inside of, that it passed
  bool decided;         // the branch has nothing more to say
  bool forks;           // the next branch goes another way than this one
  bool varies;          // by textures, from place to place of what it met
  bool passed;          // a pane that mirrors too, before any event
  bool left_weaker;     // went past, or along, the first weaker way that no branch takes
  int closed;           // closed solids that it is inside of
  uint landings;        // photons that were left on the way
  float last_distance;  // m, since the last event
  vec3 place;           // on what was met last
  vec3 facing;          // its normal, of what it ended on
  vec3 normal;          // of what was bent at last, and the direction before
  vec3 from;
  PhotonAccount account;
};

/// Which way a branch goes on.
struct Choice {
  Way way;
  vec3 not_followed;  // weight of the other way if no branch takes it
  bool is_chance;     // to leave
  bool is_weaker;     // the pass follows it from here on
};

bool isLast() { return (push.role & kRoleIsLast) != 0u; }
bool followsWeaker() { return (push.role & kRoleIsWeaker) != 0u; }

/// Whether what becomes of the flight from here on is this pass's: branches b > k share the way past the first k
/// chances, and what ends there is the one of branch k + 1. What goes before the weaker way is the branch's.
bool isOwn(Flight flight) {
  return followsWeaker() ? flight.left_weaker : flight.decided || push.branch == flight.chances + 1u;
}

/// Whether what is to be said before the first event is this pass's. What goes through a pane goes the way of those
/// that are let in, and the first of them speaks for it.
bool ownsStart(Flight flight) { return push.branch == (flight.passed ? 1u : 0u); }

/// Goes on along the branch, so that no two branches take the same path: at the first event one is reflected and the
/// others are let in; of those, branch b leaves at its b-th chance, that is where something is let through from the
/// inside, and is reflected at those before. Total reflection is no chance and is followed by all. Elsewhere (at what
/// is met after leaving, or inside) the way that carries more is followed. The other is lost, but for the first one of
/// branch 1, which a pass of its own may follow (TransportSettings::follows_weaker). Straight through a pane is no
/// event: behind it branches b >= 1 are let in as well, and what is reflected there is lost.
Choice chooseWay(Way reflected, Way transmitted, uint events, bool is_inside, inout Flight flight) {
  if (events == 0u) {
    flight.decided = push.branch == 0u;
    flight.forks = flight.decided && largest(transmitted.weight) > 0.0;
    vec3 rest = flight.decided && isLast() ? transmitted.weight : vec3(0.0);
    if (flight.passed) rest = reflected.weight;
    return Choice(flight.decided ? reflected : transmitted, rest, false, false);
  }
  bool can_leave = largest(transmitted.weight) > 0.0;
  if (is_inside && can_leave && !flight.decided) {
    ++flight.chances;
    flight.decided = flight.chances == push.branch;
    flight.forks = flight.decided && largest(reflected.weight) > 0.0;
    vec3 rest = flight.decided && isLast() ? reflected.weight : vec3(0.0);
    return Choice(flight.decided ? transmitted : reflected, rest, true, false);
  }
  bool reflects = largest(reflected.weight) >= largest(transmitted.weight);
  Way stronger = transmitted, weaker = reflected;
  if (reflects) {
    stronger = reflected;
    weaker = transmitted;
  }
  bool is_fork = push.branch == 1u && !flight.left_weaker && largest(weaker.weight) > 0.0;
  flight.left_weaker = flight.left_weaker || is_fork;
  if (!is_fork || !followsWeaker()) return Choice(stronger, weaker.weight, false, false);
  flight.decided = true;
  return Choice(weaker, vec3(0.0), false, true);
}

Photon describe(Flight flight, uint index) {
  Photon photon;
  bool valid = flight.outcome == kOutcomeDeposited;
  uint flags = (valid ? kPhotonValid : 0u) | (flight.outcome == kOutcomeEscaped ? kPhotonLeftScene : 0u) |
               (flight.outcome << kOutcomeShift) | (kListed && flight.varies ? kPhotonVaries : 0u);
  photon.position = valid ? flight.place : flight.path.ray.origin;
  photon.path_length = flight.last_distance;
  photon.direction = flight.path.ray.dir;
  photon.light_band_flags = packLightBandFlags(push.light, push.band, flags);
  photon.flux = flight.path.throughput;
  photon.index = index;
  photon.chain = flight.chain;
  photon.footprint_major = photon.footprint_minor = 0.0;
  photon.footprint_orientation = valid ? packUnitVector(flight.facing) : 0u;
  return photon;
}

/// Follows the flight to a surface, through what absorbs.
Encounter arrive(inout Flight flight, Met met) {
  bool emission_seen;
  vec3 before = flight.path.throughput;
  Encounter e = encounter(flight.path, met, emission_seen);
  bool own = flight.path.events == 0u ? ownsStart(flight) : isOwn(flight);
  if (kAccounts && own) flight.account.absorbed += before - flight.path.throughput;
  return e;
}

/// Is what a surface takes and sends nowhere this branch's?
bool ownsRest(Flight flight, Choice choice) {
  if (followsWeaker()) return flight.left_weaker && !choice.is_weaker;
  if (flight.path.events == 0u) return ownsStart(flight);
  return choice.is_chance ? flight.decided : isOwn(flight);
}

bool isSpecular(SurfaceOptics optics) { return optics.alpha < push.specular_alpha; }

/// Does some of the light that a generator gets come back from it by a lobe of class D?
bool isReceiver(MaterialPoint m) {
  return !isSpecular(m.optics) || (m.base_weight > 0.0 && largest(m.optics.base) > 0.0);
}

/// Does the flight leave a photon on the diffuse lobe of a generator that it meets? Of the light straight from the
/// lamp none is left: that is no caustic.
bool lands(Flight flight, MaterialPoint m, Choice choice) {
  return kLands && flight.path.events > 0u && isReceiver(m) && ownsRest(flight, choice) && flight.landings < kLandings;
}

/// Leaves it there, with all the flux that arrives: the lobe takes of it what the interface lets through.
void land(inout Flight flight, Encounter e) {
  if (!kAccounts) {
    Photon photon = describe(flight, flight.cell);
    photon.position = e.surface.position;
    photon.chain = hashChain(flight.chain, 2u * flight.path.instance);
    if (flight.landings == 0u) first_landings[flight.cell] = photon;
    else second_landings[flight.cell] = photon;
  }
  ++flight.landings;
}

/// Enters into the account where the rest stays of what a surface does not send along a way that is followed.
void accountFor(inout Flight flight, Encounter e, SurfaceOptics optics, Scattered scattered, Way reflected,
                Way transmitted, Choice choice) {
  // The branch has it among what is not followed.
  if (choice.is_weaker) flight.account.other_way -= flight.path.throughput * choice.way.weight;
  if (!ownsRest(flight, choice)) return;
  vec3 flux = flight.path.throughput, interface_share = vec3(0.0);
  if (isSpecular(optics)) {
    float cos_o = max(-dot(flight.path.ray.dir, e.surface.shading), 0.0);
    float fresnel = interfaceFresnel(optics, cos_o);
    interface_share = interfaceReflectance(optics, cos_o, fresnel) + interfaceTransmittance(optics, fresnel);
  }
  vec3 scattered_share = scattered.reflected_weight + scattered.transmitted_weight / radianceScale(optics);
  vec3 rest = flux * (1.0 - interface_share);
  if (!isReceiver(e.material)) flight.account.absorbed += rest;
  else if (flight.path.events == 0u) flight.account.blocked += rest;
  else if (lands(flight, e.material, choice)) flight.account.landed += rest;
  else flight.account.diffuse += rest;
  flight.account.microfacet += flux * (interface_share - scattered_share);
  flight.account.normal += flux * (scattered_share - reflected.weight - transmitted.weight);
  if (choice.is_chance) flight.account.internal += flux * choice.not_followed;
  else flight.account.other_way += flux * choice.not_followed;
}

int countSolids(Interior interior) {
  uvec4 listed = min(interior.solids, uvec4(1u));
  return int(listed.x + listed.y + listed.z + listed.w);
}

/// Of a surface: 1 if it bounds a solid that what enters must leave.
int closedBy(uint instance) { return (fetchInstance(instance).flags & kInstanceClosed) != 0u ? 1 : 0; }

/// Keeps the flight for the next branch, as it goes on if it does not leave here.
void keepFork(inout Flight flight, Encounter e, Way reflected) {
  Path other = flight.path;
  take(other, reflected, e.surface, e.crossing, false);
  // Nothing comes of it.
  if (other.ended) flight.forks = false;
  if (!flight.forks) return;
  int solids = countSolids(other.interior) - countSolids(flight.path.interior);
  forks[flight.cell] = Fork(other.ray.origin, other.instance, other.ray.dir, other.triangle, other.throughput,
                            hashChain(flight.chain, 2u * other.instance), other.events, flight.turn, other.seed,
                            flight.closed + closedBy(other.instance) * solids);
  fork_interiors[flight.cell] = other.interior;
}

/// Takes up what the branch before has kept.
void resume(inout Flight flight) {
  Fork fork = forks[flight.cell];
  flight.path.ray = Ray(fork.origin, fork.dir);
  flight.path.throughput = fork.flux;
  flight.path.events = fork.events;
  flight.path.seed = fork.seed;
  flight.path.instance = fork.instance;
  flight.path.triangle = fork.triangle;
  flight.path.interior = fork_interiors[flight.cell];
  flight.chain = fork.chain;
  flight.turn = fork.turn + 1u;
  flight.chances = push.branch - 1u;
  flight.closed = fork.closed;
}

/// The flux of eq. 6, (N·L)/V times what the V cells that see a generator get together: V drops out where these carry
/// the same, as those of a sun do, and the cosine is one too many. What went before is made less too, so that the
/// account still closes.
void takeFluxEq6(inout Flight flight, float cos_theta) {
  flight.path.throughput *= cos_theta;
  flight.account.emitted *= cos_theta;
  flight.account.blocked *= cos_theta;
  flight.account.absorbed *= cos_theta;
}

/// Refracts or reflects the flight at a surface.
void bend(inout Flight flight, Met met) {
  uint events = flight.path.events;
  Encounter e = arrive(flight, met);
  SurfaceOptics optics = e.material.optics;
  if (e.crossing.is_solid && !e.boundary.is_event) {
    passOn(flight.path, e.surface, e.crossing);
    if (flight.path.ended) flight.outcome = kOutcomeInterior;
    return;
  }
  if (kFluxEq6 && events == 0u && !flight.passed) takeFluxEq6(flight, abs(dot(flight.path.ray.dir, e.surface.shading)));
  Medium from = fetchMedium(e.boundary.from), to = fetchMedium(e.boundary.to);
  optics.ior_from = iorOf(from, flight.path.wavelength_nm);
  if (e.crossing.is_solid) optics.ior_to = iorOf(to, flight.path.wavelength_nm);
  // Branches draw the same facets where they share their way.
  vec2 u = kSceneHasRoughSpecular ? vec2(draw(flight.path), draw(flight.path)) : vec2(0.0);
  Scattered scattered = kSceneHasRoughSpecular && optics.alpha > 0.0
                            ? scatterRough(optics, flight.path.ray.dir, e.surface.shading, u)
                            : scatterSmooth(optics, flight.path.ray.dir, e.surface.shading);
  // Textures may make a part of it as rough as a receiver.
  if (!isSpecular(optics)) scattered.reflected_weight = scattered.transmitted_weight = vec3(0.0);
  Way reflected = reflection(scattered, e.surface), transmitted = transmission(scattered, e.surface);
  // Of flux, not of radiance: it does not know the index.
  transmitted.weight /= radianceScale(optics);
  flight.varies = flight.varies || e.material.varies;
  flight.normal = e.surface.geometric;
  flight.from = flight.path.ray.dir;
  Choice choice = chooseWay(reflected, transmitted, events, e.crossing.is_solid && !e.crossing.entering, flight);
  if (kAccounts) accountFor(flight, e, optics, scattered, reflected, transmitted, choice);
  if (lands(flight, e.material, choice)) land(flight, e);
  bool is_fork = choice.is_chance && flight.forks;
  if (kListed && push.branch > 0u && !isLast() && is_fork) keepFork(flight, e, reflected);
  flight.chain = hashChain(flight.chain, 2u * met.instance + (choice.way.through ? 1u : 0u));
  bool is_smooth_pane = optics.is_pane != 0u && optics.alpha == 0.0;
  take(flight.path, choice.way, e.surface, e.crossing, is_smooth_pane);
  flight.passed = flight.passed || (events == 0u && is_smooth_pane && choice.way.through);
  if (largest(abs(flight.path.throughput)) <= 0.0) flight.outcome = events == 0u ? kOutcomeNoWay : kOutcomeAbsorbed;
  else if (flight.path.ended) flight.outcome = flight.path.events >= max_events ? kOutcomeBounceLimit : kOutcomeInterior;
}

void meetGenerator(inout Flight flight, Met met) {
  int solids = countSolids(flight.path.interior);
  bend(flight, met);
  flight.closed += closedBy(met.instance) * (countSolids(flight.path.interior) - solids);
}

/// Ends the flight on a surface that no light passes; arriveAtEnd is to follow.
void endOn(inout Flight flight, Met met) {
  flight.chain = hashChain(flight.chain, 2u * met.instance);
  flight.path.ended = true;
  flight.outcome = flight.path.events == 0u ? kOutcomeBlocked : kOutcomeDeposited;
}

/// Follows what ended so through what absorbs: once, not in each turn of the loop, which all threads take together.
void arriveAtEnd(inout Flight flight, Met met) {
  if (!flight.path.ended || flight.outcome != kOutcomeDeposited) return;
  if (kSceneHasMedia) arrive(flight, met);
  InstanceRecord instance = fetchInstance(met.instance);
  Triangle corners = toWorld(instance, fetchTriangle(instance.first_triangle + met.triangle));
  flight.facing = normalize(cross(corners.b - corners.a, corners.c - corners.a));
}

/// Ends the flight on a surface, or leads it straight through, as shadows are: panes tint it, of what is partly there a
/// share lets it pass.
void meetReceiver(inout Flight flight, Met met) {
  Encounter e = arrive(flight, met);
  flight.chain = hashChain(flight.chain, 2u * met.instance);
  bool is_first = flight.path.events == 0u;
  vec3 pass = vec3(0.0);
  if (!isBlocker(met.instance)) {
    bool is_hole = draw(flight.path) >= e.material.coverage;
    MaterialPoint whole = e.material;
    whole.coverage = 1.0;
    pass = is_hole ? vec3(1.0) : passTransmittance(whole, abs(dot(flight.path.ray.dir, e.surface.shading)));
  }
  if (largest(pass) <= 0.0) {
    flight.path.ended = true;
    flight.facing = e.surface.geometric;
    flight.outcome = is_first ? kOutcomeBlocked : kOutcomeDeposited;
    return;
  }
  vec3 rest = flight.path.throughput * (1.0 - pass);
  bool own = is_first ? ownsStart(flight) : isOwn(flight);
  if (kAccounts && own && is_first) flight.account.blocked += rest;
  if (kAccounts && own && !is_first) flight.account.other_way += rest;
  flight.path.throughput *= pass;
  flight.path.ray = startFrom(e.surface, flight.path.ray.dir);
}

/// Follows the flight to infinity.
void depart(inout Flight flight) {
  vec3 before = flight.path.throughput;
  flight.path.throughput *= transmittanceOf(mediumOf(flight.path.interior, kNowhere), kFarAway);
  if (kAccounts && isOwn(flight)) flight.account.absorbed += before - flight.path.throughput;
}

/// Light that has entered a solid is sought where its back face is seen, if Wyman's approximation is asked for.
bool leavesByWyman(Flight flight, Pictures generators) {
  return kExit == kExitWyman && flight.path.events == 1u && dot(flight.path.ray.dir, flight.normal) < 0.0 &&
         generators.layer_count > 1u;
}

/// What is met next.
struct Next {
  Met met;
  bool is_hidden;  // something that no picture shows
};

/// By the tree of all triangles.
Next nextInTree(inout Flight flight, Pictures generators) {
  Ray ray = flight.path.ray;
  Met met;
  if (leavesByWyman(flight, generators)) {
    met = meetBackFace(ray, flight.normal, flight.from, generators, generator_seen, generator_surfaces);
  } else {
    met = meetFirst(ray, flight.path.instance, flight.path.triangle);
  }
  flight.place = ray.origin + met.t * ray.dir;
  return Next(met, false);
}

/// In the pictures that the light has taken.
Next nextInPictures(inout Flight flight, Pictures generators, Pictures receivers) {
  bool hidden = false, hidden_receiver = false;
  Ray ray = flight.path.ray;
  Start start = Start(flight.path.instance, flight.path.triangle);
  float t_end = leaveBox(ray, surroundings.generator_lower, surroundings.generator_upper);
  Met met;
  if (leavesByWyman(flight, generators)) {
    met = meetBackFace(ray, flight.normal, flight.from, generators, generator_seen, generator_surfaces);
  } else {  // What is near is the surface that it starts from, as a rule: the first step is to tell.
    met = meetLayers(ray, t_end, kFarAway, start, generators, generator_seen, generator_surfaces, generator_depths,
                     push.iterations, false, hidden);
  }
  // From inside a closed solid there is no way but through its surface.
  if (kExit == kExitExact && flight.closed > 0 && met.instance == kNowhere) met = walkToExit(ray, start);
  // The pictures hold all generators, so what leaves them meets none; what starts beside them may.
  if (hidden) hidden = !placeInPictures(generators, ray.origin).inside;
  t_end = leaveBox(ray, surroundings.scene_lower, surroundings.scene_upper);
  Met receiver;
  if (kSearch == kSearchPlanes) {
    receiver = meetLayers(ray, t_end, met.t, start, receivers, receiver_seen, receiver_surfaces, receiver_depths,
                          push.receiver_iterations, true, hidden_receiver);
    flight.place = ray.origin + receiver.t * ray.dir;
  } else {
    receiver = searchReceiver(ray, t_end, push.first_guess, receivers, receiver_seen, receiver_surfaces, 0u,
                              push.receiver_iterations, flight.place);
  }
  // A receiver beyond a surface that is not found is not met.
  bool is_enclosed = flight.closed > 0 && met.instance == kNowhere;
  if (receiver.t < met.t) met = receiver;
  if (is_enclosed) met.instance = kNowhere;
  // Nor does light go on for ever in water that a basin bounds: the pictures do not have the place.
  bool is_inside = flight.path.interior.solids.x != 0u;
  return Next(met, is_enclosed || is_inside || hidden || hidden_receiver);
}

/// The next surface, or how the flight ends.
Met meetNext(inout Flight flight, Pictures generators, Pictures receivers) {
  Next next;
  if (kSearch == kSearchTree) {
    next = nextInTree(flight, generators);
  } else {
    next = nextInPictures(flight, generators, receivers);
  }
  if (next.met.instance == kNowhere) {
    flight.outcome = next.is_hidden ? kOutcomeHidden : kOutcomeEscaped;
    flight.path.ended = true;
    if (flight.outcome == kOutcomeEscaped) depart(flight);
    if (flight.outcome == kOutcomeEscaped && flight.path.events == 0u) flight.outcome = kOutcomeMissed;
  }
  return next.met;
}

/// Ends that another branch has to say: before the first event the first branch, else see isOwn.
void leaveToOthers(inout Flight flight) {
  bool met_generator = flight.path.events > 0u;
  if (met_generator ? !isOwn(flight) : !ownsStart(flight)) {
    flight.path.throughput = vec3(0.0);
    if (met_generator) flight.outcome = kOutcomeNoWay;
  }
  if (any(isnan(flight.path.throughput)) || any(isinf(flight.path.throughput))) {
    flight.path.throughput = vec3(0.0);
    flight.outcome = kOutcomeNumerical;
  }
}

/// @return  false: this thread has none
bool chooseCell(out uvec2 cell) {
  cell = gl_GlobalInvocationID.xy;
  if (!kListed) return cell.x < push.grid && cell.y < push.grid;
  uint i = (gl_WorkGroupID.y * kMostGroups + gl_WorkGroupID.x) * kListGroup + gl_LocalInvocationIndex;
  if (i >= heads[push.list].count) return false;
  uint index = listed[firstOfList(push.list, push.grid * push.grid) + i];
  cell = uvec2(index % push.grid, index / push.grid);
  return true;
}

void main() {
  uvec2 cell;
  if (!chooseCell(cell)) return;
  ViewRecord view = emission_views[push.view];
  vec2 film = filmOf(cell);
  EmissionRay emitted = emissionRay(view, film.x, film.y);
  vec3 flux = cellFlux(lights[push.light], view, film.x, film.y, 1.0 / float(push.grid * push.grid)) * push.band_weight;
  Ray ray = Ray(emitted.origin, emitted.dir);
  uint index = cell.y * push.grid + cell.x;
  uint seed = hashChain(push.seed, index);
  Path path = Path(ray, flux, false, false, 0u, seed, push.wavelength_nm, kNowhere, 0u, kInTheOpen);
  vec3 none = vec3(0.0);
  PhotonAccount account =
      PhotonAccount(push.branch == 0u ? flux : none, none, none, none, none, none, none, none, none);
  Flight flight =
      Flight(path, index, 0u, 0u, kOutcomeDeposited, 0u, false, false, false, false, false, 0, 0u, 0.0, ray.origin,
             none, none, none, account);

  Pictures generators = Pictures(0u, kGeneratorViews, kGeneratorLayers, push.generator_size);
  Pictures receivers = Pictures(kGeneratorViews, kReceiverViews, kReceiverLayers, push.receiver_size);
  uvec2 seen = firstSeen(film);
  Met met = Met(kFarAway, 0.0, 0.0, kNowhere, 0u);
  if (seen.x != 0u) met = walkToRay(ray, seen, vec3(0.0), 0.0);
  if (met.instance == kNowhere) flight.outcome = kOutcomeMissed;
  else if (isBlocker(met.instance)) flight.outcome = kOutcomeBlocked;
  flight.path.ended = flight.outcome != kOutcomeDeposited;

  bool resumes = kListed && !followsWeaker() && hasFork(standings[index]);
  // Before the loop, which looks for the next surface even where no thread needs it: all that is met first bends light.
  if (!kSceneHasPassable && !flight.path.ended && !resumes) {
    flight.last_distance = met.t;
    meetGenerator(flight, met);
  }
  flight.turn = kSceneHasPassable ? 0u : 1u;
  if (resumes) resume(flight);
  // Surfaces of solids that others rule are no events.
  for (; flight.turn < 2u * max_events && !flight.path.ended; ++flight.turn) {
    if (flight.turn > 0u) met = meetNext(flight, generators, receivers);
    if (flight.path.ended) continue;
    flight.last_distance = met.t;
    if ((fetchInstance(met.instance).flags & kInstanceGenerates) != 0u) {
      meetGenerator(flight, met);
    } else if (kSceneHasPassable) {
      meetReceiver(flight, met);
    } else {
      endOn(flight, met);
    }
  }
  if (!kSceneHasPassable) arriveAtEnd(flight, met);
  if (!flight.path.ended) flight.outcome = kOutcomeBounceLimit;
  leaveToOthers(flight);
  photons[index] = describe(flight, index);
  if (kAccounts) accounts[index] = flight.account;
  if (!kListed || followsWeaker()) return;
  // Where no way forks here, branches beyond have nothing to say.
  standings[index] = !isLast() && flight.forks ? waitsFor(push.branch + 1u, push.branch > 0u) : kIsDone;
  if (flight.left_weaker) addToList(kWeakerList, push.grid * push.grid, index);
}
