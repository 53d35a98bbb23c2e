// The exposure value of a histogram of luminances, by the rule of core/image/tonemap.cpp: the mean of their logarithms
// goes to middle grey, and the 99th percentile not above what still shades. Exact to half a cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "frame/display.shared.h"
#include "core/image/tonemap.shared.h"

layout(local_size_x = 256) in;
layout(scalar, set = 0, binding = 0) readonly buffer Histogram { uint cells[]; };
layout(scalar, set = 0, binding = 1) writeonly buffer Exposure { float exposure_ev; };

shared uint counts[kHistogramCells];

float octaveOf(uint cell) { return kFirstOctave + (float(cell) + 0.5) / float(kCellsPerOctave); }

void main() {
  for (uint i = gl_LocalInvocationIndex; i < kHistogramCells; i += 256u) counts[i] = cells[i];
  barrier();
  if (gl_LocalInvocationIndex != 0u) return;
  uint all = 0u;
  for (uint i = 0u; i < kHistogramCells; ++i) all += counts[i];
  if (all == 0u) {
    exposure_ev = 0.0;
    return;
  }
  uint highlight = 0u, below = counts[0];
  while (below < highlightRank(all)) below += counts[++highlight];
  uint first = highlight - min(highlight, uint(kBlackOctaves) * kCellsPerOctave);
  float counted = 0.0, sum = 0.0;
  for (uint i = first; i < kHistogramCells; ++i) {
    counted += float(counts[i]);
    sum += float(counts[i]) * octaveOf(i);
  }
  exposure_ev = min(log2(kMiddleGrey) - sum / counted, log2(kMaxHighlight) - octaveOf(highlight));
}
