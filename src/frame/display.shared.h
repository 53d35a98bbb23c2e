// How a frame is brought to a screen: what its passes are told and keep.
#ifndef NEPHROID_DISPLAY_SHARED_H
#define NEPHROID_DISPLAY_SHARED_H

#include "core/optics/bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

/// The histogram of luminances: cells for an octave, and where the first lies.
NEPHROID_CONST uint kCellsPerOctave = 16u;
NEPHROID_CONST uint kHistogramCells = 1024u;
NEPHROID_CONST float kFirstOctave = -32.0f;

struct DisplayPush {
  vec4 weights;  // of the images that are summed
  float exposure_ev;
  uint is_automatic;  // exposure
  uint is_filmic;
  uint is_coded;  // as sRGB; else linear
};

NEPHROID_NAMESPACE_END

#endif
