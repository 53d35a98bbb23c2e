// Everything that both directions of transport share for one render.
#pragma once

#include <memory>

#include "core/spectrum.h"
#include "scene/classify.h"
#include "techniques/technique.h"
#include "trace/camera_model.h"
#include "trace/emission.h"
#include "trace/light_set.h"
#include "trace/walk.h"

namespace nephroid {

struct ReferenceOptions {
  float specular_alpha = kDefaultSpecularAlpha;
  int max_bounces = 64;
  SpectralMode spectral;
  std::uint32_t seed = 0;
};

/// Immutable while rendering.
struct ReferenceWorld {
  ReferenceWorld(const SceneData& data, const Camera& camera, int width, int height, const ReferenceOptions& opts)
      : scene(data),
        materials(scene),
        lights(scene, materials),
        walker(scene, materials),
        camera_model(camera, width, height),
        camera_interior(findInterior(scene, camera.eye)),
        options(opts) {}
  TraceScene scene;
  MaterialTable materials;
  LightSet lights;
  Walker walker;
  CameraModel camera_model;
  InteriorList camera_interior;
  ReferenceOptions options;
};

}  // namespace nephroid
