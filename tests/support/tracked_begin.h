// From here to tracked_end.h shared text is compiled with tracked numbers, into namespace nephroid::tracked. No include
// guard: it is a bracket. What such text includes beyond core/optics must have been included before.
#include "core/image/tonemap.shared.h"
#include "core/optics/absorption.shared.h"
#include "core/optics/dispersion.shared.h"
#include "core/optics/fresnel.shared.h"
#include "core/optics/lights.shared.h"
#include "core/optics/microfacet.shared.h"
#include "core/optics/photon.shared.h"
#include "core/optics/ray_differential.shared.h"
#include "core/optics/refraction.shared.h"
#include "core/optics/surface.shared.h"
#include "support/tracked.h"

#undef NEPHROID_ABSORPTION_SHARED_H
#undef NEPHROID_DISPERSION_SHARED_H
#undef NEPHROID_FRESNEL_SHARED_H
#undef NEPHROID_LIGHTS_SHARED_H
#undef NEPHROID_MICROFACET_SHARED_H
#undef NEPHROID_PHOTON_SHARED_H
#undef NEPHROID_RAY_DIFFERENTIAL_SHARED_H
#undef NEPHROID_REFRACTION_SHARED_H
#undef NEPHROID_SURFACE_SHARED_H
#undef NEPHROID_TONEMAP_SHARED_H

#undef NEPHROID_NAMESPACE_BEGIN
#define NEPHROID_NAMESPACE_BEGIN namespace nephroid::tracked {
// A keyword, but in this bracket there is no text of the standard library that could mind.
#ifdef __clang__
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wkeyword-macro"
#endif
#define float Number
#ifdef __clang__
#pragma clang diagnostic pop
#endif
