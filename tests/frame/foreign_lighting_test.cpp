#include "frame/foreign_lighting.h"

#include <cmath>
#include <cstring>
#include <numeric>

#include <glm/gtc/matrix_transform.hpp>

#include "frame/frame.h"
#include "frame/mean_direction.h"
#include "nephroid/error.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

constexpr int kSize = 48;

/// A picture of the frame's own, as somebody else would hand it over.
struct Drawn {
  mat4 clip_from_world;
  gpu::Image depth, normal;
};

class ForeignLightingTest : public testing::GpuTest {
 protected:
  static gpu::Image upload(VkFormat format, std::span<const std::byte> bytes) {
    gpu::Image image(device(), {.format = format, .width = kSize, .height = kSize, .usage = VK_IMAGE_USAGE_SAMPLED_BIT},
                     "foreign");
    gpu::CommandRecorder recorder(device());
    recorder.begin();
    recorder.upload(image, bytes);
    recorder.submit();
    return image;
  }

  /// @param reversed  depth 1 near and 0 far; else the other way round
  static Drawn draw(RealtimeFrame& frame, const Camera& camera, bool reversed, bool coded) {
    const float near = 0.5F, far = 40.0F;
    mat4 projection = reversed ? glm::perspectiveRH_ZO(camera.fov_y, 1.0F, far, near)
                               : glm::perspectiveRH_ZO(camera.fov_y, 1.0F, near, far);
    projection[1][1] = -projection[1][1];  // y down
    const mat4 clip_from_world = projection * glm::lookAtRH(camera.eye, camera.eye + camera.forward, camera.up);
    const Image position = frame.readGeometry("position"), normal = frame.readGeometry("normal"),
                id = frame.readGeometry("id");
    std::vector<float> depths;
    std::vector<vec4> normals;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const vec4 clip = clip_from_world * vec4(position.rgb(x, y), 1.0F);
        const bool there = id.at(x, y)[0] > 0.0F;
        depths.push_back(there ? clip.z / clip.w : reversed ? 0.0F : 1.0F);
        const vec3 n = there ? normal.rgb(x, y) : vec3(0.0F);
        normals.emplace_back(coded ? 0.5F + 0.5F * n : n, 1.0F);
      }
    return {clip_from_world, upload(VK_FORMAT_D32_SFLOAT, std::as_bytes(std::span(depths))),
            upload(VK_FORMAT_R32G32B32A32_SFLOAT, std::as_bytes(std::span(normals)))};
  }

  static std::vector<vec4> read(const gpu::Image& image) {
    const std::vector<std::byte> bytes = gpu::readBack(device(), image);
    std::vector<vec4> texels(bytes.size() / sizeof(vec4));
    std::memcpy(static_cast<void*>(texels.data()), bytes.data(), bytes.size());
    return texels;
  }

  static IrradianceImages makeTarget() {
    IrradianceImages target = makeIrradianceImages(device(), kSize, kSize);
    gpu::CommandRecorder recorder(device());
    recorder.begin();
    clearIrradiance(recorder, target);
    recorder.submit();
    return target;
  }
};

Camera lookAcross() { return makeCamera("across", vec3(2, 3, 5), vec3(0, 0.8F, 0), 0.7F); }

/// White without an interface, so that L = E/π.
SceneData makeWhiteBall() {
  SceneData scene = test::makeBallScene(test::makeDiffuse(vec3(1.0F)));
  for (Material& m : scene.materials) {
    m.base_color = vec4(1.0F);
    m.ior = 1.0F;
  }
  return scene;
}

TEST_F(ForeignLightingTest, IsWhatTheFrameSeesOfTheSameSurfaces) {
  SceneData scene = makeWhiteBall();
  scene.lights.push_back(test::makePoint(vec3(1.5F, 4, 2), vec3(30, 20, 10)));
  scene.lights.push_back(test::makeSun(vec3(1, -1, 0.2F), vec3(1, 2, 3)));
  RealtimeFrame frame(device(), scene, lookAcross(), {.width = kSize, .height = kSize});
  frame.render(0);
  const Image direct = frame.readSummed("direct");
  for (const bool reversed : {false, true})
    for (const bool coded : {false, true}) {
      SCOPED_TRACE(::testing::Message() << reversed << coded);
      const Drawn drawn = draw(frame, lookAcross(), reversed, coded);
      const IrradianceImages target = makeTarget();
      frame.lightForeign({{drawn.clip_from_world, coded}, drawn.depth, drawn.normal}, target, {}, 0, 1.0F);
      const std::vector<vec4> irradiance = read(target.irradiance);
      // Places from depths are off by some rounding, which moves edges of shadows.
      int off = 0;
      for (std::size_t i = 0; i < irradiance.size(); ++i) {
        const float expected = kPi * direct.pixels[3 * i + 1];
        off += std::abs(irradiance[i].y - expected) > 2e-3F * expected + 1e-4F ? 1 : 0;
      }
      EXPECT_LE(off, 8);
      EXPECT_GT(std::accumulate(irradiance.begin(), irradiance.end(), vec4(0.0F)).y, 100.0F);
    }
}

TEST_F(ForeignLightingTest, SamplesAddUp) {
  SceneData scene = makeWhiteBall();
  scene.lights.push_back(test::makePoint(vec3(1.5F, 4, 2), vec3(30)));
  RealtimeFrame frame(device(), scene, lookAcross(), {.width = kSize, .height = kSize});
  const Drawn drawn = draw(frame, lookAcross(), true, false);
  const ForeignPicture picture{{drawn.clip_from_world}, drawn.depth, drawn.normal};
  const IrradianceImages once = makeTarget(), quarters = makeTarget();
  frame.lightForeign(picture, once, {}, 0, 1.0F);
  for (std::uint32_t s = 0; s < 4; ++s) frame.lightForeign(picture, quarters, {}, s, 0.25F);
  const std::vector<vec4> a = read(once.irradiance), b = read(quarters.irradiance);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i].x, b[i].x, 1e-6F * a[i].x);
}

TEST_F(ForeignLightingTest, MeanDirectionIsTheLights) {
  SceneData scene = makeWhiteBall();
  const vec3 light(1.5F, 4, 2);
  scene.lights.push_back(test::makePoint(light, vec3(30)));
  RealtimeFrame frame(device(), scene, lookAcross(), {.width = kSize, .height = kSize});
  const Image position = frame.readGeometry("position");
  const Drawn drawn = draw(frame, lookAcross(), true, false);
  const IrradianceImages target = makeTarget();
  frame.lightForeign({{drawn.clip_from_world}, drawn.depth, drawn.normal}, target, {}, 0, 1.0F);
  MeanDirection mean(device());
  gpu::CommandRecorder recorder(device());
  recorder.begin();
  mean.record(recorder, target.direction);
  recorder.submit();
  const std::vector<vec4> irradiance = read(target.irradiance), direction = read(target.direction);
  int lit = 0;
  for (int i = 0; i < kSize * kSize; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (irradiance[k].x <= 0.0F) {
      EXPECT_EQ(vec3(direction[k]), vec3(0.0F));
      continue;
    }
    ++lit;
    const vec3 expected = normalize(position.rgb(i % kSize, i / kSize) - light);
    ASSERT_NEAR(dot(vec3(direction[k]), expected), 1.0F, 1e-4F);
  }
  EXPECT_GT(lit, kSize * kSize / 4);
}

TEST_F(ForeignLightingTest, DirectAndCausticAreChosenApart) {
  SceneData scene = makeWhiteBall();
  scene.lights.push_back(test::makePoint(vec3(1.5F, 4, 2), vec3(30)));
  RealtimeFrame frame(device(), scene, lookAcross(), {.width = kSize, .height = kSize});
  const Drawn drawn = draw(frame, lookAcross(), true, false);
  const IrradianceImages target = makeTarget();
  // There is no technique, so no caustic.
  frame.lightForeign({{drawn.clip_from_world}, drawn.depth, drawn.normal}, target, {.direct = false}, 0, 1.0F);
  for (const vec4& texel : read(target.irradiance)) ASSERT_EQ(texel, vec4(0.0F));
}

TEST(ForeignView, RefusesWhatHasNoInverse) {
  EXPECT_THROW(makeForeignView({mat4(0.0F)}, VK_FORMAT_D32_SFLOAT), UsageError);
  EXPECT_THROW(makeForeignView({mat4(std::nanf(""))}, VK_FORMAT_D32_SFLOAT), UsageError);
  const ForeignViewRecord record = makeForeignView({glm::scale(mat4(1.0F), vec3(2, 4, 8))}, VK_FORMAT_D16_UNORM);
  EXPECT_EQ(record.world_row_y, vec4(0, 0.25F, 0, 0));
  EXPECT_EQ(record.depth_step, 1.0F / 65535.0F);
  EXPECT_EQ(record.depth_ulp, 0.0F);
}

}  // namespace
}  // namespace nephroid
