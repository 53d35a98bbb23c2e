// Every function of dispersion.shared.h on one input, for the device and for C++. No include guard: its test compiles
// it twice.
#include "core/optics/dispersion.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct DispersionInput {
  float ior_d;
  float dispersion;
  float wavelength_nm;
};

struct DispersionOutput {
  float ior;
};

NEPHROID_FN DispersionOutput evaluateDispersion(DispersionInput given) {
  DispersionOutput result;
  result.ior = dispersiveIor(given.ior_d, given.dispersion, given.wavelength_nm);
  return result;
}

NEPHROID_NAMESPACE_END
