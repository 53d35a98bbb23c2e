// What the low-pass of a map of flux and C++ tell each other.
#ifndef NEPHROID_LOW_PASS_SHARED_H
#define NEPHROID_LOW_PASS_SHARED_H

#include "core/optics/bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct LowPassPush {
  uint width;  // texels of each view's picture
  uint height;
  uint layer_count;  // of each view, in the images of surfaces
  uint axis;         // 0: along rows; 1: along columns
  float deviation;   // texels, of the Gaussian
  int reach;         // texels to either side
};

NEPHROID_NAMESPACE_END

#endif
