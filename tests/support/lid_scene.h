// A small room under a lid of glass.
#pragma once

#include "support/tiny_scenes.h"

namespace nephroid::test {

/// A slab of glass over a floor between two walls, without a light.
inline SceneData makeLid() {
  SceneData scene;
  addObject(scene, makeFloor(5.0), makeDiffuse(vec3(0.8F)));
  addObject(scene, makeRectangle("left", dvec3(-1.5, 0.75, 0), dvec3(0, 0.75, 0), dvec3(0, 0, 2.5)),
            makeDiffuse(vec3(0.8F)));
  addObject(scene, makeRectangle("back", dvec3(0, 0.75, -1.5), dvec3(0, 0, 2.5), dvec3(0, 0.75, 0)),
            makeDiffuse(vec3(0.8F)));
  addObject(scene, makeBox("slab", dvec3(-2.5, 1.5, -2.5), dvec3(2.5, 1.8, 2.5)), makeGlass(1.5F));
  return scene;
}

}  // namespace nephroid::test
