// Which photons are worth emitting: learned before the first batch, from photons that are not in the picture.
//
// With even emission a light spends as much on what the camera never sees, and on a bright spot that is long smooth, as
// on what is dark and noisy. A pilot notes where in the emission domain each of its photons began and what it adds to
// which pixels. Of photons that are drawn by a density p, the error summed over pixels, each weighted by w, is least
// where p ∝ √E[Σ w v²]: v is what a photon adds to a pixel. w = 1 / (Ī √(I² + (Ī/10)²)), with I the radiance about the
// pixel and Ī its mean, stands between the squared error (w = 1) and the squared relative one (w = 1 / I²): each of
// these alone would let the other grow.
// I holds direct light as well, under which noise is seen less.
// Where photons are gathered, kernels are the narrower the more photons there are: v² is the same for all that end
// where paths gather, and blur is what guiding lessens. Limits: what caustics light in turn is not learned, nor, but
// where photons are gathered, what is seen of them in mirrors or through glass.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/params.h"
#include "techniques/reference/estimator.h"
#include "techniques/reference/film.h"
#include "techniques/reference/gather_places.h"
#include "techniques/reference/light_tracer.h"

namespace nephroid {

/// The share of photons that is guided; the others are emitted evenly.
ParamSpec makeGuidingParam();

/// Are caustics that the camera sees directly all that photons are asked for? Guides know of no others, and would
/// starve what they do not know of.
bool paysToGuide(Estimator estimator, const LayerNeeds& needs);

struct GuideRequest {
  const std::vector<std::uint32_t>& photons;  ///< of each emitter in the first batch
  const std::vector<float>& overlaps;         ///< of footprints, by emitter; empty: photons are not spread
  float guided;                               ///< share of the photons, in [0, 1)
};
/// What guiding does to one light.
struct GuidedLight {
  std::string name;
  double seen_even, seen_guided;  ///< shares of photons that are of use to the picture, by the pilot
};

/// Guides the emitters that can be guided and have photons enough to pay for a pilot. Deterministic, whatever the
/// threads. @pre emission is even
std::vector<GuidedLight> guideEmission(const ReferenceWorld& world, LightTracer& tracer, const GuideRequest& request);
/// The same, where photons are gathered: by the share of a block's photons that end near places where they are, or in
/// sight. Each of those is taken for as good as the others, for kernels are the narrower the more there are. Lights
/// most of whose photons are of use stay even.
std::vector<GuidedLight> guideToPlaces(const ReferenceWorld& world, LightTracer& tracer, const GuideRequest& request,
                                       const GatherPlaces& places);
void emitEvenly(LightTracer& tracer);

}  // namespace nephroid
