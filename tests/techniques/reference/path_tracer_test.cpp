// How often paths from the eye go on changes their noise, and no mean.
#include "techniques/reference/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

using test::addObject;
using test::makeDiffuse;

constexpr int kSide = 12;
constexpr std::uint32_t kPasses = 512, kSeeds = 8;
const std::vector<std::string> kLayers{"direct", "specular", "indirect", "irradiance"};

/// A ball of glass over a floor, a wall, a lamp above: light on all ways.
SceneData makeRoom() {
  SceneData scene = test::makeBallScene(test::makeGlass(1.5F), 24);
  addObject(scene, makeRectangle("wall", dvec3(-2.5, 2, 0), dvec3(0, 0, 4), dvec3(0, 2, 0)),
            makeDiffuse(vec3(0.8F, 0.3F, 0.2F)));
  Material lamp = makeDiffuse(vec3(0.0F));
  lamp.emission = vec3(6.0F, 5.0F, 4.0F);
  addObject(scene, makeRectangle("lamp", dvec3(1, 4, 0), dvec3(1, 0, 0), dvec3(0, 0, 1)), lamp);
  return scene;
}

Camera makeRoomCamera() { return makeCamera("room", vec3(4.0F, 3.0F, 3.0F), vec3(0, 0.4F, 0), radians(45)); }

/// Means over the picture of each layer by one scrambling.
std::vector<double> render(std::uint32_t seed, const Continuation& continuation, const DirectionGuide& guide) {
  const Camera camera = makeRoomCamera();
  const SceneData scene = makeRoom();
  ReferenceWorld world(scene, camera, kSide, kSide, ReferenceOptions{.seed = seed});
  const LayerNeeds needs(kLayers);
  PathTracer tracer(world, needs);
  tracer.continueBy(continuation);
  tracer.guideBy(&guide);
  Film film(kSide, kSide, needs);
  parallelFor(kSide, [&](std::size_t y) {
    for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
      PathCounters counters;
      for (int x = 0; x < kSide; ++x) tracer.tracePath(x, static_cast<int>(y), pass, film, counters);
    }
  });
  std::vector<double> means;
  for (const FilmPlane* plane : {&film.direct, &film.specular, &film.indirect_from_eye, &film.irradiance_from_eye}) {
    double mean = 0.0;
    for (std::size_t pixel = 0; pixel < kSide * kSide; ++pixel) mean += plane->at(pixel).x / (kPasses * kSide * kSide);
    means.push_back(mean);
  }
  return means;
}

void expectSameMeans(const Continuation& continuation, const DirectionGuide& guide = {}) {
  std::vector<double> difference(kLayers.size(), 0.0), squares(difference), mean(difference);
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const auto plain = render(seed, {}, {}), other = render(seed + 100, continuation, guide);
    for (std::size_t layer = 0; layer < kLayers.size(); ++layer) {
      const double d = other[layer] - plain[layer];
      difference[layer] += d / kSeeds, squares[layer] += d * d / kSeeds, mean[layer] += plain[layer] / kSeeds;
    }
  }
  for (std::size_t layer = 0; layer < kLayers.size(); ++layer) {
    const double error = std::sqrt(squares[layer] / kSeeds);
    EXPECT_GT(mean[layer], 0.0) << kLayers[layer];
    EXPECT_LT(error, 0.01 * mean[layer]) << kLayers[layer];
    EXPECT_NEAR(difference[layer], 0.0, 3.5 * error) << kLayers[layer];
  }
}

TEST(PathCounters, CountKernelsAsAFifthOfARay) { EXPECT_EQ((PathCounters{.rays = 10, .kernels = 26}).work(), 15U); }

TEST(PathTracer, GoingOnByChanceHasTheSameMean) {
  Continuation seldom;
  seldom.probability[1] = 0.3F, seldom.probability[2] = 0.5F;
  expectSameMeans(seldom);
}

TEST(PathTracer, LesserWaysByChanceHaveTheSameMean) {
  Continuation seldom;
  seldom.lesser_way = 0.3F;
  expectSameMeans(seldom);
}

std::vector<DirectionLesson> learnInRoom() {
  const SceneData scene = makeRoom();
  ReferenceWorld world(scene, makeRoomCamera(), kSide, kSide, ReferenceOptions{.seed = 77});
  const LayerNeeds needs(kLayers);
  const PathTracer tracer(world, needs);
  Film film(kSide, kSide, needs);
  std::vector<DirectionLesson> lessons;
  PathCounters counters;
  counters.lessons = &lessons;
  for (std::uint32_t pass = 0; pass < 16; ++pass)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) tracer.tracePath(x, y, pass, film, counters);
  return lessons;
}

TEST(PathTracer, GuidedPathsHaveTheSameMean) { expectSameMeans({}, DirectionGuide(learnInRoom())); }

TEST(PathTracer, TellsWhatCameByEachWay) {
  const std::vector<DirectionLesson> lessons = learnInRoom();
  ASSERT_GT(lessons.size(), 5'000U);
  double brought = 0.0;
  for (const DirectionLesson& lesson : lessons) {
    EXPECT_NEAR(length(lesson.dir), 1.0F, 1e-4F);
    EXPECT_GT(lesson.pdf, 0.0F);
    EXPECT_EQ(lesson.pdf, lesson.pdf_bsdf);
    if (lesson.value > 0.0F) {
      EXPECT_GT(lesson.distance, 0.0F);
      EXPECT_GE(lesson.rays, 1.0F);
    }
    brought += lesson.value;
  }
  EXPECT_GT(brought, 0.0);
}

}  // namespace
}  // namespace nephroid
