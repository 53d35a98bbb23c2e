// Quarters of cells beside which there is no photon that took the same way.
#ifndef NEPHROID_DEPOSIT_QUARTERS_GLSL
#define NEPHROID_DEPOSIT_QUARTERS_GLSL

#include "frame/deposit.glsl"

/// Half the way to where the next photon ends in a direction of the grid: of that photon or, mirrored, of the one on the
/// other side, if either took the same way. @return  false if neither did
bool halfStep(ivec2 at, Photon own, ivec2 towards, out vec3 half_step) {
  bool found = false;
  for (int sign = 1; sign >= -1; sign -= 2) {
    ivec2 next = at + sign * towards;
    if (found || !isPhoton(next)) continue;
    Photon other = fetchPhoton(indexOf(next));
    if ((other.light_band_flags & kPhotonValid) == 0u || other.chain != own.chain) continue;
    if (dot(other.direction, own.direction) < kLeastCosine) continue;
    half_step = 0.5 * float(sign) * (other.position - own.position);
    found = true;
  }
  return found;
}

/// What flux is added over: a cell, or the quarter of one.
struct Piece {
  vec3 places[4];
  Light light;
  bool is_cell;   // else
  bool is_splat;  // at the first place, or nothing
};

/// A quarter of a corner's flux, on the side of its cell where it has no neighbours all around: over what its cell would
/// cover there if the light went on as on the other side.
Piece quarterOf(ivec2 first, Cell cell, uint corner) {
  Piece piece;
  ivec2 at = first + kCorners[corner], side = kCorners[corner ^ 2u] - kCorners[corner];
  // Each photon is the third corner of one cell.
  bool is_valid = (cell.valid & (1u << corner)) != 0u && (kMakesQuads || corner == 2u);
  Photon own = fetchPhoton(is_valid ? indexOf(at) : 0u);
  piece.light = Light(kMakesQuads ? 0.25 * own.flux : own.flux, own.direction);
  vec3 across = vec3(0.0), down = vec3(0.0);
  bool goes_across = halfStep(at, own, ivec2(side.x, 0), across), goes_down = halfStep(at, own, ivec2(0, side.y), down);
  // With neighbours along one direction of the grid alone it is as long across them.
  if (goes_across && !goes_down) down = cross(own.direction, across);
  if (goes_down && !goes_across) across = cross(own.direction, down);
  piece.is_cell = is_valid && kMakesQuads && (goes_across || goes_down);
  piece.is_splat = is_valid && !piece.is_cell;
  piece.places = vec3[4](own.position, own.position + across, own.position + across + down, own.position + down);
  return piece;
}

#endif
