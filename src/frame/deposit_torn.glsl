// Photons beside which there is none that took the same way: what of their flux no whole cell has.
#ifndef NEPHROID_DEPOSIT_TORN_GLSL
#define NEPHROID_DEPOSIT_TORN_GLSL

#include "frame/deposit.glsl"

/// Part `q < 4` of a photon lies on the side of larger x where bit 0 of q is set, of larger y where bit 1 is.
const uint kAllQuarters = 15u;

/// A photon, and half the way to the next ones that took the same way. Where there is none on one side it is mirrored
/// from the other: as if the light went on there as on the other side.
struct TornPhoton {
  Photon photon;
  vec3 across[2];  // to smaller and to larger x
  vec3 down[2];
  bool is_lone;  // none took the same way
};

/// Half the way to the next photon, if it took the same way.
bool halfStep(ivec2 next, Photon own, out vec3 half_step) {
  bool is_photon = isPhoton(next);
  Photon other = fetchPhoton(is_photon ? indexOf(next) : 0u);
  half_step = 0.5 * (other.position - own.position);
  return is_photon && (other.light_band_flags & kPhotonValid) != 0u && other.chain == own.chain &&
         dot(other.direction, own.direction) >= kLeastCosine;
}

/// To both sides along an axis of the grid. @return  false if none took the same way
bool halfSteps(ivec2 at, ivec2 axis, Photon own, out vec3 steps[2]) {
  vec3 back, forth;
  bool goes_back = halfStep(at - axis, own, back), goes_forth = halfStep(at + axis, own, forth);
  steps[0] = goes_back ? back : -forth;
  steps[1] = goes_forth ? forth : -back;
  return goes_back || goes_forth;
}

TornPhoton fetchTorn(ivec2 at) {
  TornPhoton torn;
  torn.photon = fetchPhoton(indexOf(at));
  bool goes_across = halfSteps(at, ivec2(1, 0), torn.photon, torn.across);
  bool goes_down = halfSteps(at, ivec2(0, 1), torn.photon, torn.down);
  torn.is_lone = !kMakesQuads || !(goes_across || goes_down);
  // With neighbours along one direction of the grid alone it is as long across them.
  vec3 turned_across = cross(torn.photon.direction, 0.5 * (torn.across[1] - torn.across[0]));
  vec3 turned_down = cross(torn.photon.direction, 0.5 * (torn.down[1] - torn.down[0]));
  if (!goes_across) torn.across = vec3[2](-turned_down, turned_down);
  if (!goes_down) torn.down = vec3[2](-turned_across, turned_across);
  return torn;
}

/// What flux is added over.
struct Piece {
  vec3 places[4];
  vec3 place;  // where some of it ended: corners of what is torn may lie beside the surface
  Light light;
};

/// Its corners, with a place that is on the surface for the first.
vec3[4] anchorsOf(Piece piece) {
  vec3 anchors[4] = piece.places;
  anchors[0] = piece.place;
  return anchors;
}

/// @param part  a quarter of a photon, or kPhotonPart
Piece pieceOf(TornPhoton torn, uint part) {
  Piece piece;
  bool is_all = part == kPhotonPart;
  vec3 at = torn.photon.position;
  piece.place = at;
  piece.light = Light(is_all ? torn.photon.flux : 0.25 * torn.photon.flux, torn.photon.direction);
  vec3 across[2] = torn.across, down[2] = torn.down;
  bool is_right = (part & 1u) != 0u, is_below = (part & 2u) != 0u;
  // A quarter begins at the photon.
  if (!is_all && is_right) across[0] = vec3(0.0);
  if (!is_all && !is_right) across[1] = vec3(0.0);
  if (!is_all && is_below) down[0] = vec3(0.0);
  if (!is_all && !is_below) down[1] = vec3(0.0);
  piece.places = vec3[4](at + across[0] + down[0], at + across[1] + down[0], at + across[1] + down[1],
                         at + across[0] + down[1]);
  return piece;
}

#endif
