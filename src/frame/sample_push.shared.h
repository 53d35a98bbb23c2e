// What passes over pixels are told of a sample of the frame.
#ifndef NEPHROID_SAMPLE_PUSH_SHARED_H
#define NEPHROID_SAMPLE_PUSH_SHARED_H

#include "core/optics/bridge.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct SamplePush {
  vec2 film_offset;  // of the sample in the pixel, in [0, 1)
  uint frame;
  uint light_count;
  uint lamp_count;
  float specular_alpha;
  float environment_scale;  // 0: there is none
  float cos_rotation;       // of the environment
  float sin_rotation;
};

NEPHROID_NAMESPACE_END

#endif
