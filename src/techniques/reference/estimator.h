// Which estimator makes the caustics: the parameter `estimator`.
//
//   light       photons, each for the one pixel that sees it: no kernel, no bias
//   footprint   photons, each spread over its footprint (see footprint.h): the least error until photons are many
//   photon-map  photons gathered by paths from the eye under a kernel that shrinks (progressive photon mapping)
//   path        paths from the eye alone: shares nothing with the others; needs lights with a size
//   manifold    walks from what is seen over one or two smooth interfaces to the lights (see manifold/manifold.h);
//               photons, each for the one pixel that sees it, for all longer or rougher ways
//   vcm         all of these by their weights: vertex connection and merging (see vcm/vcm.h)
//   auto        path where a pilot shows that it is better, for each kind of caustic; else footprint, or light where
//               errors of caustics alone are to be estimated: there a footprint's blur, which is in no standard error,
//               counts as much as its noise
//
// Caustics in mirrors and through glass can be met by paths from the eye alone, so they are gathered by all but `path`
// and `vcm`; `manifold` gathers what its walks cannot make.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/params.h"
#include "techniques/reference/estimator_pilot.h"
#include "techniques/reference/film.h"
#include "techniques/reference/photon_batch.h"
#include "techniques/reference/receiver_view.h"

namespace nephroid {

enum class Estimator : std::uint8_t { kLight, kFootprint, kPhotonMap, kPath, kManifold, kVcm };

ParamSpec makeEstimatorParam();
/// What makes the paths whose light begins with S.
struct EstimatorChoice {
  Estimator caustic;           ///< L S⁺ D E
  Estimator specular_caustic;  ///< L S⁺ D S⁺ E, and L S … D … D S⁺ E, which it lights in turn
  Estimator indirect;          ///< L S … D … D E: kLight, kPhotonMap or kPath
  PilotFigures figures;        ///< by which it was chosen, if it was measured
};

/// What a value of the parameter stands for in a scene.
/// @param name      as checked by the parameter; `auto` measures where there is something to choose
/// @param may_blur  whether caustics may have a blur that no standard error knows
/// @param world     seen by `camera`, `width` × `height` pixels; others meanwhile (see measureEstimators)
EstimatorChoice chooseEstimators(std::string_view name, bool may_blur, ReferenceWorld& world, const Camera& camera,
                                 int width, int height, const LayerNeeds& needs);
std::string_view nameOf(Estimator estimator);
/// Every value of the parameter but `auto`.
std::vector<std::string> estimatorNames();

/// The paths that are left to photons, not to chance.
PhotonPaths photonPathsOf(const EstimatorChoice& choice);

/// What spreads photons over footprints: the view that they are spread over, and how far for each light.
struct FootprintSpread {
  std::unique_ptr<ReceiverView> view;
  std::vector<float> overlaps;  ///< by emitter

  /// Measures the scene, and makes tracer and batch spread. This must outlive both.
  void apply(const ReferenceWorld& world, LightTracer& tracer, PhotonBatch& batch);
};

/// Says in the metadata what makes each kind of caustic that was asked for, "estimator.caustic", …, and what was
/// measured, "estimator.caustic.measured", ….
void describeEstimators(const EstimatorChoice& choice, const LayerNeeds& needs,
                        std::map<std::string, std::string>& metadata);
/// The same for people: a sentence for each kind that was measured.
std::vector<std::string> explainEstimators(const EstimatorChoice& choice);

}  // namespace nephroid
