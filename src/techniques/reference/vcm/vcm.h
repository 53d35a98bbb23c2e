// Vertex connection and merging ([georgiev-2012-vcm]) as an estimator of caustics: what it keeps from pass to pass.
//
// A pass is one or more batches of photons, then a path from the eye through each pixel. Photons are seen by the camera
// in all batches; those of the last one are merged, and connected where interfaces are rough. Kernels shrink from pass
// to pass, r_i = r_1 √(i^(α−1)) (Eq. 19), and so the weights change: they sum to one only if all batches and paths of a
// pass have the same, which is why passes are never cut.
#pragma once

#include <cstdint>
#include <memory>

#include "techniques/reference/photon_batch.h"
#include "techniques/reference/vcm/eye_path.h"

namespace nephroid {

/// How photons are spread over passes.
struct VcmSchedule {
  std::uint64_t batches_per_pass = 1;
  std::uint32_t batch_photons = 1;

  /// @param passes   of the whole render  @param photons  ditto; 0: as many a pass as there are pixels
  static VcmSchedule choose(std::uint64_t passes, std::uint64_t photons, std::uint64_t pixels);
};

class Vcm {
 public:
  /// @param tracer  must outlive it; its photons carry weights from now on
  Vcm(const ReferenceWorld& world, LightTracer& tracer, const LayerNeeds& needs)
      : world_(world), tracer_(tracer), needs_(needs) {}
  /// Once photons are shared among lights, before the first of them: measures how wide kernels begin.
  void begin(const PhotonBatch& batch, int width, int height);

  void setSchedule(const VcmSchedule& schedule) { batches_per_pass_ = schedule.batches_per_pass; }
  std::uint64_t batchesFor(std::uint64_t passes) const { return passes * batches_per_pass_; }
  template <class State>
  void visitState(State& state) {
    state.value(batches_per_pass_);
  }

  /// Before batch number `batch` (from 0) is traced.
  void prepareBatch(std::uint64_t batch);
  /// Afterwards: the last batch of a pass is kept for the paths from the eye.
  void takeBatch(std::uint64_t batch, const PhotonBatch& photons);
  /// Safe from any thread as long as no two share a pixel.
  void tracePath(int x, int y, std::uint32_t sample, Film& film, PathCounters& counters) const {
    traceVcmEyePath(*techniques_, photons_, needs_, x, y, sample, film, counters);
  }

 private:
  const ReferenceWorld& world_;
  LightTracer& tracer_;
  const LayerNeeds& needs_;
  std::unique_ptr<VcmTechniques> techniques_;
  VcmPhotons photons_;
  float first_radius_ = 0.0F;
  std::uint64_t batches_per_pass_ = 1;
};

/// @throws UsageError if vertex connection and merging cannot make this render
/// @param estimates_errors  whether standard errors are wanted
void checkVcm(const SceneData& scene, bool estimates_errors);

}  // namespace nephroid
