#include "frame/realtime_technique.h"

#include <cmath>

#include "frame/direct_irradiance.h"
#include "frame/frame.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

class RealtimeTechniqueTest : public testing::GpuTest {};

/// What was told to a technique.
struct Told {
  int records = 0, moved = 0;
  std::vector<std::size_t> lights;
};

/// Says that the light which comes straight from the lights is what it found: so `caustic` must be `direct`.
class Echo : public RealtimeTechnique {
 public:
  Echo(const RealtimeInputs& inputs, Told& told)
      : told_(told), irradiance_(inputs.device, inputs.buffers, inputs.lights, false) {}
  void record(gpu::CommandRecorder& recorder, const RealtimeSample& sample) override {
    ++told_.records;
    irradiance_.record(recorder, sample);
  }
  void lightChanged(std::size_t index) override { told_.lights.push_back(index); }
  void objectsMoved() override { ++told_.moved; }

 private:
  Told& told_;
  DirectIrradiance irradiance_;
};

MakeRealtimeTechnique makeEcho(Told& told) {
  return [&told](const RealtimeInputs& inputs) { return std::make_unique<Echo>(inputs, told); };
}

/// A ball over a floor, from the side.
Camera lookAcross() { return makeCamera("across", vec3(2, 3, 5), vec3(0, 0.8F, 0), 0.7F); }

void expectEqualLayers(RealtimeFrame& frame, const char* first, const char* second, float tolerance) {
  const Image a = frame.readSummed(first), b = frame.readSummed(second);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    ASSERT_NEAR(a.pixels[i], b.pixels[i], tolerance * (std::abs(b.pixels[i]) + 1e-3F)) << i;
    sum += b.pixels[i];
  }
  EXPECT_GT(sum, 1.0);
}

TEST_F(RealtimeTechniqueTest, IrradianceIsShadedAsDirectLightIs) {
  // Diffuse, plastic and rough metal: one light has one direction, so that the mean direction is the light's.
  Material plastic = test::makeDiffuse(vec3(0.2F, 0.5F, 0.7F));
  plastic.roughness = 0.8F;
  for (const Material& material :
       {test::makeDiffuse(vec3(0.5F, 0.2F, 0.9F)), plastic, test::makeMetal(vec3(0.9F, 0.6F, 0.3F), 0.7F)}) {
    SCOPED_TRACE(material.name);
    SceneData scene = test::makeBallScene(material);
    scene.lights.push_back(test::makePoint(vec3(1.5F, 4, 2), vec3(30, 20, 10)));
    Told told;
    RealtimeFrame frame(device(), scene, lookAcross(), {.width = 96, .height = 64}, makeEcho(told));
    frame.render(0);
    frame.render(1);
    EXPECT_EQ(told.records, 2);
    expectEqualLayers(frame, "caustic", "direct", 2e-3F);
  }
}

TEST_F(RealtimeTechniqueTest, DiffuseSurfacesSeeTheSumOfAllLights) {
  SceneData scene = test::makeBallScene(test::makeDiffuse(vec3(0.4F)));
  scene.lights.push_back(test::makePoint(vec3(1.5F, 4, 2), vec3(30, 20, 10)));
  scene.lights.push_back(test::makeSun(vec3(1, -1, 0.2F), vec3(1, 2, 3)));
  scene.lights.push_back(test::makePoint(vec3(-2, 2, 1), vec3(3, 9, 1), 0.3F));
  // Without an interface, or its reflection would ask for each direction.
  for (Material& m : scene.materials) m.ior = 1.0F;
  Told told;
  RealtimeFrame frame(device(), scene, lookAcross(), {.width = 96, .height = 64}, makeEcho(told));
  for (std::uint32_t s = 0; s < 3; ++s) frame.render(s);
  expectEqualLayers(frame, "caustic", "direct", 1e-4F);
}

TEST_F(RealtimeTechniqueTest, IrradianceOfCausticsIsWhatTheTechniqueFound) {
  // E = I·h/d³ of a point light at height h over the floor, seen from above.
  constexpr int kSize = 16;
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.6F)));
  scene.lights.push_back(test::makePoint(vec3(0, 1.5F, 0), vec3(5)));
  Told told;
  RealtimeFrame frame(device(), scene, makeCamera("down", vec3(0, 3, 0), vec3(0), 0.0F, 2.0F),
                      {.width = kSize, .height = kSize}, makeEcho(told));
  frame.render(0);
  const Image irradiance = frame.readSummed("irradiance_caustic");
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double px = (x + 0.5) * 2.0 / kSize - 1.0, pz = (y + 0.5) * 2.0 / kSize - 1.0;
      const double d = std::sqrt(px * px + pz * pz + 2.25);
      ASSERT_NEAR(irradiance.at(x, y)[1], 5.0 * 1.5 / (d * d * d), 1e-4) << x << ", " << y;
    }
}

TEST_F(RealtimeTechniqueTest, IsToldOfChanges) {
  SceneData scene = test::makeBallScene(test::makeDiffuse(vec3(0.4F)));
  scene.lights.push_back(test::makePoint(vec3(1.5F, 4, 2), vec3(30)));
  scene.lights.push_back(test::makePoint(vec3(-1.5F, 4, 2), vec3(10)));
  Told told;
  RealtimeFrame frame(device(), scene, lookAcross(), {.width = 48, .height = 32}, makeEcho(told));
  frame.render(0);
  scene.lights[1].intensity = vec3(20);
  frame.lightChanged(1);
  scene.instances[1].world_from_object = glm::translate(mat4(1.0F), vec3(0.5F, 0, 0));
  frame.objectsMoved();
  EXPECT_EQ(told.lights, std::vector<std::size_t>{1});
  EXPECT_EQ(told.moved, 1);
  frame.resize(60, 40);
  frame.render(0);
  expectEqualLayers(frame, "caustic", "direct", 2e-3F);
}

TEST_F(RealtimeTechniqueTest, WithoutOneThereIsNoCaustic) {
  const SceneData scene = test::makeBallScene(test::makeDiffuse(vec3(0.4F)));
  const MakeRealtimeTechnique nothing = [](const RealtimeInputs&) { return nullptr; };
  RealtimeFrame frame(device(), scene, lookAcross(), {.width = 8, .height = 8}, nothing);
  frame.render(0);
  for (const char* layer : {"caustic", "irradiance_caustic"})
    for (const float value : frame.readSummed(layer).pixels) ASSERT_EQ(value, 0.0F);
}

}  // namespace
}  // namespace nephroid
