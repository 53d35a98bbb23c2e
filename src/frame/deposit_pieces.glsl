// Pieces that are left by the passes before: large cells and what is torn, and those on several pictures. What the two
// passes over them share, each of which says what it adds of a piece at one level.
//
// If there is much of it, each piece is deposited where it spans few texels (frame/flux_levels.h), so that its cost
// does not grow with its area.
#ifndef NEPHROID_DEPOSIT_PIECES_GLSL
#define NEPHROID_DEPOSIT_PIECES_GLSL

#include "frame/deposit_torn.glsl"
#include "frame/flux_levels.glsl"

layout(set = 0, binding = 8, rgba32f) readonly uniform image2DArray level_surfaces;
layout(set = 0, binding = 9, r32ui) readonly uniform uimage2DArray level_kinds;
layout(set = 0, binding = 10, r32i) uniform iimage2DArray level_flux;
layout(constant_id = 4) const bool kAtLevels = false;  // else on the picture itself

/// Texels that the box about a piece has before it goes to coarser levels. Cells are parts of smooth pictures, and
/// those that are just large must fit to those that are not; what is torn is the light of one photon, somewhere about
/// where it ended. The fewer, the softer are outlines: a tent over a texel of the level.
const float kMostOfCells = kLargeBox;
const float kMostOfTorn = 16.0;
/// Levels for each doubling of the box. With a half a piece would span as many texels at its level whatever its size;
/// with more the larger ones, each texel of which gets less, span fewer.
const float kLevelsByOctave = 0.65;

/// Where between levels a piece is deposited: its flux is shared by two of them, so that where neighbours have about
/// the same size light stays even. 0: on the picture itself.
float levelOf(CellOnPicture shown, uint part) {
  float most = part == kWholePart ? kMostOfCells : kMostOfTorn;
  float level = kLevelsByOctave * log2(max(texelsOfBox(shown) / most, 1.0));
  return kAtLevels ? min(level, float(push.level_count)) : 0.0;
}

CellOnPicture scaled(CellOnPicture cell, float scale) {
  for (uint k = 0u; k < 4u; ++k) cell.corners[k] *= scale;
  cell.lower *= scale;
  cell.upper *= scale;
  return cell;
}

/// What is to be deposited, in one view.
struct Deposited {
  Coverage coverage;  // in texels of its level
  uint level;
  uint view;
  uint place;  // in the list
  Span span;
  Light light;
  uint salt;
};

ivec2 levelOriginOf(uint level) {
  return levelOrigin(paddedSize(uvec2(push.width, push.height), push.level_count), level);
}

/// The layer that is lit of a level's texel; kFluxLayers: none.
/// @param is_mixed  it shows several surfaces, so that this is not known
uint litLayerOf(ivec2 node, Deposited d, uint level, ivec2 origin, out bool is_mixed) {
  uint lit = kFluxLayers;
  is_mixed = false;
  [[unroll]] for (uint k = 0u; k < kFluxLayers; ++k) {
    ivec3 place = ivec3(origin + node, d.view * kFluxLayers + k);
    uint kind = imageLoad(level_kinds, place).x;
    vec3 forward = kViewsShare ? d.span.forward : views[0].forward;
    bool is_lit = kind == kNodeSurface && isLitAt(imageLoad(level_surfaces, place), forward, d.span.first,
                                                  d.span.third, d.span.reach, d.light.direction);
    is_mixed = is_mixed || (lit == kFluxLayers && kind == kNodeMixed);
    if (is_lit && lit == kFluxLayers && !is_mixed) lit = k;
  }
  return lit;
}

void addToLevel(ivec2 texel, uint picture, Light light, float share, uint salt) {
  uint random = mixBits(uint(texel.x) + (uint(texel.y) << 12) + salt * 0x9e3779b1u);
  vec3 steps = light.flux * (share * push.steps_per_watt);
  int layer = int(picture * kChannels);
  for (int c = 0; c < 3; ++c) imageAtomicAdd(level_flux, ivec3(texel, layer + c), toSteps(steps[c], random));
  if (!kKeepsDirections) return;
  vec3 along = light.direction * luminanceOf(steps);
  for (int c = 0; c < 3; ++c)
    imageAtomicAdd(level_flux, ivec3(texel, layer + 3 + c), toSteps(along[c], mixBits(random + uint(c))));
}

/// @param node  of a level, 0: of the picture itself. @return  false: it shows several surfaces
bool addToNode(ivec2 node, uint level, Deposited d, Light light, float share) {
  if (any(greaterThanEqual(node << level, ivec2(push.width, push.height)))) return true;
  uint layer;
  bool is_mixed = false;
  ivec2 origin = ivec2(0);
  if (!kAtLevels || level == 0u) {
    layer = litLayer(node, d.view, d.span, light.direction);
  } else {
    origin = levelOriginOf(level);
    layer = litLayerOf(node, d, level, origin, is_mixed);
  }
  if (is_mixed) return false;
  bool is_lit = layer < kFluxLayers;
  uint picture = d.view * kFluxLayers + (is_lit ? layer : 0u);
  if (!kAtLevels || level == 0u || !is_lit) addToTexel(node, picture, light, share, d.salt, is_lit);
  else addToLevel(origin + node, picture, light, share, d.salt);
  return true;
}

/// Bits of a place in the list of pieces: set where the first pass met texels of levels that show several surfaces.
const uint kMeetsMixed = 0x80000000u;
uint partOf(uint item) { return item >> kPartShift & 7u; }

Piece fetchPiece(uint item) {
  ivec2 first = firstOf(numberIn(item));
  if (partOf(item) != kWholePart) return pieceOf(fetchTorn(first), partOf(item));
  Cell cell = fetchCell(first, 1);
  return Piece(cell.places, cell.places[0], lightOf(cell));
}

/// Of a piece at one level. @param lane  of `lanes` threads that share it
void addAtLevel(Deposited d, uint lane, uint lanes);

/// A piece on all pictures that show some of it or, if they share surfaces, on the one that its surface faces.
void addPiece(Piece piece, uint place, uint lane, uint lanes) {
  uint number = numberIn(listed[place]), part = partOf(listed[place]), salt = saltOf(number, part);
  uint faced = kViewsShare ? viewFaced(anchorsOf(piece), piece.light.direction) : kViewCount;
  if (kViewsShare && faced == kViewCount && lane == 0u) addToLost(piece.light, salt);
  for (uint v = kViewsShare ? faced : 0u; v < (kViewsShare ? min(faced + 1u, kViewCount) : kViewCount); ++v) {
    CellOnPicture shown = cellOnPicture(piece.places, v);
    if (!mayBeSeen(shown)) continue;
    float level = levelOf(shown, part);
    Deposited d;
    d.view = v;
    d.span = spanOf(shown, anchorsOf(piece), v);
    d.salt = salt;
    d.place = place;
    for (uint k = 0u; k < (fract(level) > 0.0 ? 2u : 1u); ++k) {
      d.level = uint(level) + k;
      d.light = Light(piece.light.flux * (k == 0u ? 1.0 - fract(level) : fract(level)), piece.light.direction);
      vec2 size = vec2((uvec2(push.width, push.height) + (1u << d.level) - 1u) >> d.level);
      d.coverage = coverageOf(scaled(shown, 1.0 / float(1u << d.level)), size);
      addAtLevel(d, lane, lanes);
    }
  }
}

#endif
