// Scenes of the micro-benchmarks.
#pragma once

#include <memory>

#include "support/tiny_scenes.h"

namespace nephroid::bench {

/// Facets around the ball: 130 560 triangles, more than the caches next to a core hold.
inline constexpr int kBallSegments = 512;

/// A glass ball of radius 1 about the origin, and nothing else.
inline SceneData makeBall(int segments = kBallSegments) {
  SceneData data;
  test::addObject(data, makeSphere("ball", dvec3(0), 1.0, segments), test::makeGlass(1.5F));
  return data;
}

/// What shines on the ball.
enum class LightChoice { kSun, kPoint, kSpot, kMesh, kEnvironment };

inline Material makeLampMaterial() {
  Material material;
  material.name = "lamp";
  material.emission = vec3(7.0F);
  return material;
}

/// The ball under one light, 3 m away where that means something.
inline SceneData makeLitBall(LightChoice choice, int segments = kBallSegments) {
  SceneData data = makeBall(segments);
  switch (choice) {
    case LightChoice::kSun:
      data.lights.push_back(test::makeSun(vec3(1, -2, 0.3F), vec3(10.0F), 0.5F));
      break;
    case LightChoice::kPoint:
      data.lights.push_back(test::makePoint(vec3(0, 3, 0), vec3(5.0F), 0.05F));
      break;
    case LightChoice::kSpot: {
      Light spot = test::makePoint(vec3(0, 3, 0), vec3(5.0F));
      spot.kind = LightKind::kSpot;
      spot.direction = vec3(0, -1, 0);
      spot.inner_cone = 0.2F;
      data.lights.push_back(spot);
      break;
    }
    case LightChoice::kMesh:
      test::addObject(data, makeRectangle("lamp", dvec3(0, 3, 0), dvec3(0.5, 0, 0), dvec3(0, 0, 0.5)),
                      makeLampMaterial());
      break;
    case LightChoice::kEnvironment: {
      // Bright towards one side, as skies are.
      auto radiance = std::make_shared<Image>(256, 128, 3, 0.5F);
      for (int y = 30; y < 40; ++y)
        for (int x = 60; x < 70; ++x) radiance->setRgb(x, y, vec3(500.0F));
      Environment environment;
      environment.radiance = radiance;
      data.environment = environment;
      break;
    }
  }
  return data;
}

}  // namespace nephroid::bench
