#include "techniques/settings.h"

#include "scene/classify.h"

namespace nephroid {

ParamSpec makeSpecularAlphaParam() {
  return {"specular-alpha",
          kDefaultSpecularAlpha,
          0.0,
          1.0,
          "",
          "microfacet width below which a lobe counts as specular (an S event)",
          {}};
}

}  // namespace nephroid
