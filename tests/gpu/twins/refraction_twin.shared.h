// Every function of refraction.shared.h on one input, for the device and for C++. No include guard: its test compiles
// it twice.
#include "core/optics/refraction.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct RefractionInput {
  vec3 dir;
  vec3 n;
  float ior_ratio;
};

struct RefractionOutput {
  vec3 reflected;
  vec3 refracted;
  uint valid;
};

NEPHROID_FN RefractionOutput evaluateRefraction(RefractionInput given) {
  RefractionOutput result;
  result.reflected = reflectDir(given.dir, given.n);
  Refraction refraction = refractDir(given.dir, given.n, given.ior_ratio);
  result.refracted = refraction.dir;
  result.valid = refraction.valid ? 1u : 0u;
  return result;
}

NEPHROID_NAMESPACE_END
