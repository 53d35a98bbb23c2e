// Cells whose photons did not all take the same way: a thread for each corner. And splats. Large quarters are left to
// deposit_large.comp.glsl.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "frame/deposit_quarters.glsl"

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

/// The only picture that shows some of a quarter; kViewCount: none does. @return  false: there are several
bool findView(Piece piece, out uint view, out CellOnPicture shown) {
  uint faced = kViewsShare ? viewFaced(piece.places, piece.light.direction) : kViewCount;
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

void addQuarter(Piece piece, uint number, uint corner) {
  uint view, salt = 4u * number + corner;
  CellOnPicture shown;
  bool is_one = findView(piece, view, shown);
  if (kViewsShare && view == kViewCount) addToLost(piece.light, salt);
  if (view == kViewCount) return;
  Coverage coverage = coverageOf(shown);
  if ((!is_one || countTexels(coverage) > kLargeBox) && leave(number, corner)) return;
  addRows(coverage, view, spanOf(shown, piece.places, view), piece.light, salt);
}

void main() {
  uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint i = gl_GlobalInvocationID.x; i < 4u * torn_count; i += threads) {
    uint number = listed[cellCount() - 1u - i / 4u], corner = i % 4u;
    ivec2 first = firstOf(number);
    Piece piece = quarterOf(first, fetchCell(first, 1), corner);
    if (piece.is_cell) addQuarter(piece, number, corner);
    if (piece.is_splat) splat(piece.places[0], piece.light, 4u * number + corner);
  }
}
