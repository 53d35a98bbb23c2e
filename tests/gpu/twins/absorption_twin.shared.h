// Every function of absorption.shared.h on one input, for the device and for C++. No include guard: its test compiles
// it twice.
#include "core/optics/absorption.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct AbsorptionInput {
  vec3 sigma_a;
  float path_length;
};

struct AbsorptionOutput {
  vec3 transmitted;
  float channel;
};

NEPHROID_FN AbsorptionOutput evaluateAbsorption(AbsorptionInput given) {
  AbsorptionOutput result;
  result.transmitted = transmittance(given.sigma_a, given.path_length);
  result.channel = transmittanceChannel(given.sigma_a.y, given.path_length);
  return result;
}

NEPHROID_NAMESPACE_END
