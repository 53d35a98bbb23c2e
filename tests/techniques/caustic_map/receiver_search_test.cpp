// How fast each method of finding the receiver converges: what docs/techniques/caustic-map-intersection.md shows.
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <string>

#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"
#include "techniques/caustic_map/light_rig.h"

namespace nephroid {
namespace {

using ReceiverSearchTest = testing::GpuTest;
using testing::Flown;
using testing::LightRig;

struct Method {
  const char* name;
  Search search;
};
constexpr Method kMethods[] = {
    {"iterate", Search::kIterate}, {"newton", Search::kNewton}, {"secant", Search::kSecant}, {"march", Search::kMarch}};

/// Of photons that both runs deposit.
struct Error {
  double mean = 0.0, lost = 0.0;  ///< m; share of photons
};
Error compare(const Flown& found, const Flown& exact) {
  double sum = 0.0;
  int both = 0, all = 0;
  for (std::size_t i = 0; i < exact.photons.size(); ++i) {
    if (Flown::outcomeOf(exact.photons[i]) != kOutcomeDeposited) continue;
    ++all;
    if (Flown::outcomeOf(found.photons[i]) != kOutcomeDeposited) continue;
    ++both;
    sum += length(dvec3(found.photons[i].position) - dvec3(exact.photons[i].position));
  }
  return {sum / both, 1.0 - static_cast<double>(both) / all};
}

/// A tilted sheet of water over a floor, under a sun that stands straight above.
SceneData makeTiltedSheet(double tilt, float ior) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.6F)));
  test::addObject(
      scene, makeRectangle("sheet", dvec3(0, 1, 0), dvec3(0, 0, 0.3), 0.3 * dvec3(std::cos(tilt), std::sin(tilt), 0)),
      test::makeGlass(ior));
  scene.lights.push_back(test::makeSun(vec3(0, -1, 0), vec3(1)));
  return scene;
}

TEST_F(ReceiverSearchTest, TheIterationsErrorShrinksBySineSquaredAStep) {
  for (const double tilt : {0.9, 1.1}) {
    constexpr float kIor = 2.4F;
    const double delta = tilt - std::asin(std::sin(tilt) / kIor), ratio = std::sin(delta) * std::sin(delta);
    const SceneData scene = makeTiltedSheet(tilt, kIor);
    LightRig rig(device(), scene, 512);
    const Flown exact = rig.fly({.branch = 1});
    ASSERT_GT(exact.outcomes.at(kOutcomeDeposited), 10000);
    double last = 0.0;
    int steps = 0;
    for (std::uint32_t n = 0; n < 6; ++n) {
      const double error =
          compare(rig.fly({.branch = 1, .receiver_iterations = n, .search = Search::kIterate}), exact).mean;
      // As long as the texel, 4 m / 512, does not count.
      if (n > 0 && error > 0.007) {
        EXPECT_NEAR(error / last, ratio, 0.12 * ratio) << tilt << " step " << n;
        ++steps;
      }
      last = error;
    }
    EXPECT_LT(last, 4.0 / 512.0) << tilt;
    EXPECT_GE(steps, 2) << tilt;
  }
}

TEST_F(ReceiverSearchTest, MarchingHalvesItsError) {
  const SceneData scene = makeTiltedSheet(1.1, 2.4F);
  LightRig rig(device(), scene, 512);
  const Flown exact = rig.fly({.branch = 1});
  const double coarse = compare(rig.fly({.branch = 1, .receiver_iterations = 1, .search = Search::kMarch}), exact).mean,
               fine = compare(rig.fly({.branch = 1, .receiver_iterations = 4, .search = Search::kMarch}), exact).mean;
  EXPECT_GT(coarse, 4.0 * fine);
  EXPECT_LT(fine, 0.02);
}

TEST_F(ReceiverSearchTest, TableOfErrors) {
  SceneData glass = test::makeBallScene(test::makeGlass(1.5F), 128),
            metal = test::makeBallScene(test::makeMetal(vec3(1)), 128);
  std::cout << "| ball | method | 1 | 2 | 3 | 5 | 8 | lost at 8 |\n|---|---|---|---|---|---|---|---|\n";
  for (SceneData* scene : {&glass, &metal}) {
    scene->lights.push_back(test::makeSun(vec3(0.3F, -1, 0.1F), vec3(1)));
    const std::uint32_t branch = scene == &glass ? 1 : 0;
    LightRig rig(device(), *scene, 256);
    const Flown exact = rig.fly({.branch = branch});
    for (const Method& method : kMethods) {
      std::string line = fmt::format("| {} | `{}` |", branch == 1 ? "refracts" : "reflects", method.name);
      Error error;
      for (const std::uint32_t n : {1U, 2U, 3U, 5U, 8U}) {
        error = compare(rig.fly({.branch = branch, .receiver_iterations = n, .search = method.search}), exact);
        line += fmt::format(" {:.4f} |", error.mean);
      }
      std::cout << line << fmt::format(" {:.1f} % |\n", 100.0 * error.lost);
      // Of refraction all make something; a texel is 8 m / 256 and more, as the sun's picture holds the ball too.
      if (branch == 1) {
        EXPECT_LT(error.mean, 0.07) << method.name;
      }
    }
    if (branch == 0) continue;
    const Error wyman = compare(rig.fly({.branch = branch, .exit = Exit::kWyman}), exact);
    std::cout << fmt::format("Wyman's exit: {:.4f} m, lost {:.1f} %\n", wyman.mean, 100.0 * wyman.lost);
    EXPECT_LT(wyman.mean, 0.5);
  }
}

}  // namespace
}  // namespace nephroid
