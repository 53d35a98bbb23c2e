// Photons beside which some cells are torn: the quarters of their flux that no whole cell has, or all of it at once if
// none has any. And splats. Large pieces are left to deposit_large.comp.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit_torn.glsl"

layout(local_size_x = 64) in;

/// A Gaussian over the texels about a place that show its surface, which together get all of it; nothing if the texel
/// that it lies in shows another.
void splat(vec3 place, Light light, uint salt) {
  vec2 size = vec2(push.width, push.height);
  uint faced = kViewsShare ? searchViewFaced(place, light.direction) : kViewCount;
  if (kViewsShare && faced == kViewCount) addToLost(light, salt);
  for (uint v = kViewsShare ? faced : 0u; v < (kViewsShare ? min(faced + 1u, kViewCount) : kViewCount); ++v) {
    OnPicture on = onView(place, v);
    if (!isOnPicture(on, size)) continue;
    float reach = texelSize(on.w, size) * (1.0 + push.splat_radius);
    ivec2 first = ivec2(max(floor(on.texels - push.splat_radius), vec2(0.0)));
    ivec2 last = ivec2(min(floor(on.texels + push.splat_radius), size - 1.0));
    Span span = Span(place, place, reach, kViewsShare ? forwardOf(v) : vec3(0.0));
    if (litLayer(ivec2(on.texels), v, span, light.direction) == kFluxLayers) {
      // Beside an edge others must not get what it hides.
      addToLost(light, salt);
      return;
    }
    float inverse = 2.0 / (push.splat_radius * push.splat_radius);
    float sum = 0.0;
    for (uint round = 0u; round < 2u; ++round)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
          uint layer = litLayer(ivec2(x, y), v, span, light.direction);
          vec2 off = vec2(x, y) + 0.5 - on.texels;
          float weight = exp(-dot(off, off) * inverse);
          if (layer == kFluxLayers) continue;
          if (round == 0u) sum += weight;
          else addToTexel(ivec2(x, y), v * kFluxLayers + layer, light, weight / sum, salt, true);
        }
  }
}

/// The only picture that shows some of a piece; kViewCount: none does. @return  false: there are several
bool findView(Piece piece, out uint view, out CellOnPicture shown) {
  uint faced = kViewsShare ? viewFaced(anchorsOf(piece), piece.light.direction) : kViewCount;
  view = kViewCount;
  bool is_one = true;
  for (uint v = kViewsShare ? faced : 0u; v < (kViewsShare ? min(faced + 1u, kViewCount) : kViewCount); ++v) {
    CellOnPicture here = cellOnPicture(piece.places, v);
    if (!mayBeSeen(here)) continue;
    is_one = view == kViewCount;
    view = v;
    shown = here;
  }
  return is_one;
}

void addPiece(Piece piece, uint number, uint part) {
  uint view;
  CellOnPicture shown;
  bool is_one = findView(piece, view, shown);
  if (kViewsShare && view == kViewCount) addToLost(piece.light, saltOf(number, part));
  if (view == kViewCount) return;
  Coverage coverage = coverageOf(shown);
  bool is_large = !is_one || texelsOfBox(shown) > kLargeBox;
  if (is_large && leave(number, part, countTexels(coverage))) return;
  addRows(coverage, view, spanOf(shown, anchorsOf(piece), view), piece.light, saltOf(number, part));
}

void main() {
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x, count = lists.torn_count;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += threads) {
    uint item = listed[cellCount() - 1u - i], number = numberIn(item);
    TornPhoton torn = fetchTorn(firstOf(number));
    uint quarters = item >> kPartShift, parts = quarters == kAllQuarters ? 1u << kPhotonPart : quarters;
    if (torn.is_lone) {
      Light light = Light(0.25 * float(bitCount(quarters)) * torn.photon.flux, torn.photon.direction);
      splat(torn.photon.position, light, saltOf(number, kPhotonPart));
      parts = 0u;
    }
    for (; parts != 0u; parts &= parts - 1u) {
      uint part = uint(findLSB(parts));
      addPiece(pieceOf(torn, part), number, part);
    }
  }
  addLostByThread();
}
