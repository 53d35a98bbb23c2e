// The insides of the public Scene, for the parts of the API that draw it.
#pragma once

#include <string>

#include "nephroid/nephroid.h"
#include "scene/load.h"
#include "scene/scene_data.h"

namespace nephroid {

struct Scene::Impl {
  SceneData data;
  Floor floor = Floor::kAuto;
  std::string camera_choice = "0";
  bool completed = false;

  /// Adds what the scene lacks. Only when it is needed: an edit may still add the light that it lacks.
  void complete();
};

struct RenderResult;

/// What the parts of the API see of its classes, so that their insides stay out of the public header.
struct SceneAccess {
  using SceneImpl = Scene::Impl;
  static SceneImpl& get(Scene& scene) { return *scene.impl_; }
  static Picture makePicture(RenderResult result);
};

}  // namespace nephroid
