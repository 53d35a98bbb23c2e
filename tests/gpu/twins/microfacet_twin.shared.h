// Every function of microfacet.shared.h on one input, for the device and for C++. No include guard: its test compiles
// it twice.
#include "core/optics/microfacet.shared.h"

NEPHROID_NAMESPACE_BEGIN

struct MicrofacetInput {
  vec3 wo;
  vec3 wi;
  vec3 h;
  float alpha;
  vec2 u;
};

struct MicrofacetOutput {
  float distribution;
  float stretch;
  float lambda;
  float g1;
  float g2;
  float g2_transmission;
  vec3 facet;
  float pdf;
  vec2 inverse;
};

NEPHROID_FN MicrofacetOutput evaluateMicrofacet(MicrofacetInput given) {
  MicrofacetOutput result;
  result.distribution = ggxD(given.h, given.alpha);
  result.stretch = ggxStretch(given.wo, given.alpha);
  result.lambda = ggxLambda(given.wo, given.alpha);
  result.g1 = ggxG1(given.wo, given.alpha);
  result.g2 = ggxG2(given.wi, given.wo, given.alpha);
  result.g2_transmission = ggxG2Transmission(given.wi, given.wo, given.alpha);
  result.facet = sampleGgxVndf(given.wo, given.alpha, given.u);
  result.pdf = pdfGgxVndf(given.wo, given.h, given.alpha);
  // Of a facet that wo does not see there is no u.
  bool seen = dot(given.wo, given.h) > 0.0f && given.h.z > 0.0f;
  result.inverse = seen ? invertGgxVndf(given.wo, given.h, given.alpha) : vec2(0.0f, 0.0f);
  return result;
}

NEPHROID_NAMESPACE_END
