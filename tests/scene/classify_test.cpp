#include "scene/classify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace nephroid {
namespace {

Material makeGlass() {
  Material m;
  m.roughness = 0;
  m.transmission = 1;
  m.thickness = 1;
  return m;
}

TEST(Classify, MirrorIsAGeneratorAndNoReceiver) {
  Material m;
  m.metallic = 1;
  m.roughness = 0;
  m.base_color = vec4(0.5F, 0.5F, 0.5F, 1);
  const Classification c = classify(m);
  EXPECT_TRUE(c.is_generator);
  EXPECT_FALSE(c.is_receiver);
  EXPECT_FLOAT_EQ(c.specular_albedo, 0.5F);
}

TEST(Classify, DarkMetalIsOnlyAWeakGenerator) {
  Material m;
  m.metallic = 1;
  m.roughness = 0;
  m.base_color = vec4(0.09F, 0.09F, 0.09F, 1);
  EXPECT_FALSE(classify(m).is_generator);
  EXPECT_TRUE(classify(m).is_weak_generator);
}

// ((1.5 − 1)/(1.5 + 1))² = 0.04 is reflected, 0.96 transmitted.
TEST(Classify, SolidGlassIsAGeneratorByItsTransmission) {
  const Classification c = classify(makeGlass());
  EXPECT_TRUE(c.is_generator);
  EXPECT_FALSE(c.is_receiver);
  EXPECT_NEAR(c.specular_albedo, 0.04F, 1e-6F);
  EXPECT_NEAR(c.specular_transmission, 0.96F, 1e-6F);
}

// Both faces: R' = 2R/(1 + R) = 0.08/1.04.
TEST(Classify, SmoothPaneTransmitsWithoutAnEvent) {
  Material m = makeGlass();
  m.thickness = 0;
  const Classification c = classify(m);
  EXPECT_FALSE(c.is_generator);
  EXPECT_TRUE(c.is_weak_generator);
  EXPECT_FALSE(c.is_receiver);
  EXPECT_EQ(c.specular_transmission, 0.0F);
  EXPECT_NEAR(c.specular_albedo, 0.08F / 1.04F, 1e-6F);
}

TEST(Classify, RoughnessAtTheBoundIsDiffuse) {
  Material m = makeGlass();
  m.roughness = 0.5F;  // alpha = 0.25, the bound itself: S is strictly below it
  EXPECT_FALSE(classify(m).is_generator);
  EXPECT_TRUE(classify(m).is_receiver);
  m.roughness = 0.49F;
  EXPECT_TRUE(classify(m).is_generator);
  EXPECT_FALSE(classify(m).is_receiver);
  EXPECT_FALSE(classify(m, 0.2F).is_generator);
}

TEST(Classify, RoughDielectricIsLambertian) {
  Material m;
  m.base_color = vec4(0.6F, 0.6F, 0.6F, 1);
  const Classification c = classify(m);
  EXPECT_TRUE(c.is_receiver);
  EXPECT_FALSE(c.is_generator);
  EXPECT_FALSE(c.is_weak_generator);
  EXPECT_FLOAT_EQ(c.diffuse_albedo, 0.6F);
  EXPECT_EQ(c.specular_albedo, 0.0F);
}

TEST(Classify, VarnishIsAWeakGeneratorAndAReceiver) {
  Material m;
  m.roughness = 0;
  m.base_color = vec4(0.5F, 0.5F, 0.5F, 1);
  const Classification c = classify(m);
  EXPECT_FALSE(c.is_generator);
  EXPECT_TRUE(c.is_weak_generator);
  EXPECT_TRUE(c.is_receiver);
  EXPECT_NEAR(c.specular_albedo, 0.04F, 1e-6F);
  EXPECT_NEAR(c.diffuse_albedo, 0.5F * 0.96F, 1e-6F);
}

TEST(Classify, HalfTransmissiveSurfaceIsBoth) {
  Material m = makeGlass();
  m.transmission = 0.5F;
  EXPECT_TRUE(classify(m).is_generator);
  EXPECT_TRUE(classify(m).is_receiver);
}

TEST(Classify, BlackRoughSurfaceIsNeither) {
  Material m;
  m.base_color = vec4(0, 0, 0, 1);
  EXPECT_FALSE(classify(m).is_receiver);
  EXPECT_FALSE(classify(m).is_generator);
}

// Gold-like n = 0.2, k = 3: ((0.8)² + 9)/((1.2)² + 9) = 9.64/10.44.
TEST(Classify, ComplexIndexReplacesTheBaseColour) {
  Material m;
  m.metallic = 1;
  m.roughness = 0;
  m.base_color = vec4(0, 0, 0, 1);
  m.conductor_ior = vec3(0.2F);
  m.conductor_k = vec3(3.0F);
  EXPECT_NEAR(classify(m).specular_albedo, 9.64F / 10.44F, 1e-5F);
}

TEST(Classify, ReasonNamesTheDecidingNumbers) {
  Material m;
  m.metallic = 1;
  m.roughness = 0.2F;
  EXPECT_EQ(classify(m).reason, "metal, alpha 0.04 < 0.25, specular albedo 1 > 0.1");
}

/// A scene's image whose texels `fill` says, RGBA as stored. @return how a material refers to it
TextureRef addTexture(SceneData& scene, int width, int height, const std::function<glm::u8vec4(int x, int y)>& fill) {
  ByteImage image;
  image.width = width, image.height = height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c) image.pixels.push_back(fill(x, y)[c]);
  TextureRef reference;
  reference.image = static_cast<std::uint32_t>(scene.images.size());
  scene.images.push_back({"texture", image});
  return reference;
}

TextureRef addConstant(SceneData& scene, glm::u8vec4 texel) {
  return addTexture(scene, 1, 1, [=](int, int) { return texel; });
}

/// Metallic-roughness texels: G is roughness, B metallic.
constexpr glm::u8vec4 kRoughDielectric(0, 255, 0, 255), kMirror(0, 0, 255, 255), kRoughMetal(0, 255, 255, 255),
    kSmoothDielectric(0, 0, 0, 255);

Material makeMetalFactors() {
  Material m;
  m.metallic = 1;
  return m;
}

// 3 of 512 texels each way: less than the distance of the samples of any coarser grid.
TEST(ClassifyTextured, FindsASmallSpecularPatchWhereverItLies) {
  for (const glm::ivec2 corner : {glm::ivec2(0, 0), glm::ivec2(300, 217), glm::ivec2(509, 509)}) {
    SceneData scene;
    Material m = makeMetalFactors();
    m.metallic_roughness_texture = addTexture(scene, 512, 512, [&](int x, int y) {
      return x >= corner.x && x < corner.x + 3 && y >= corner.y && y < corner.y + 3 ? kMirror : kRoughDielectric;
    });
    const Classification c = classify(scene, m);
    EXPECT_TRUE(c.is_generator) << corner.x;
    EXPECT_TRUE(c.is_receiver) << corner.x;
    EXPECT_FLOAT_EQ(c.specular_albedo, 1.0F);
    EXPECT_EQ(c.alpha, 0.0F);
    EXPECT_THAT(c.reason, testing::EndsWith("(textured)"));
  }
}

TEST(ClassifyTextured, WithoutASpecularTexelIsNoGenerator) {
  SceneData scene;
  Material m = makeMetalFactors();
  m.metallic_roughness_texture =
      addTexture(scene, 64, 64, [](int x, int) { return x == 7 ? kRoughMetal : kRoughDielectric; });
  EXPECT_FALSE(classify(scene, m).is_generator);
  EXPECT_FALSE(classify(scene, m).is_weak_generator);
  EXPECT_TRUE(classify(scene, m).is_receiver);
}

// White metal is rough, smooth metal black: the product of the two textures is nowhere a bright mirror.
TEST(ClassifyTextured, PairsTexelsOfTexturesThatLieAlike) {
  const auto classifyWith = [](glm::u8vec4 left, glm::u8vec4 right) {
    SceneData scene;
    Material m = makeMetalFactors();
    m.metallic_roughness_texture =
        addTexture(scene, 256, 128, [](int x, int) { return x < 128 ? kMirror : kRoughMetal; });
    m.base_color_texture = addTexture(scene, 64, 512, [=](int x, int) { return x < 32 ? left : right; });
    return classify(scene, m);
  };
  const glm::u8vec4 black(0, 0, 0, 255), white(255);
  EXPECT_FALSE(classifyWith(black, white).is_generator);
  EXPECT_FALSE(classifyWith(black, white).is_weak_generator);
  EXPECT_TRUE(classifyWith(white, black).is_generator);
}

// All is smooth metal; one texel of a quarter of a million is bright.
TEST(ClassifyTextured, FindsTheBrightTexelOfACombinationMetBefore) {
  SceneData scene;
  Material m = makeMetalFactors();
  m.metallic_roughness_texture = addConstant(scene, kMirror);
  m.base_color_texture = addTexture(
      scene, 512, 512, [](int x, int y) { return x == 211 && y == 300 ? glm::u8vec4(255) : glm::u8vec4(10); });
  const Classification c = classify(scene, m);
  EXPECT_TRUE(c.is_generator);
  EXPECT_FLOAT_EQ(c.specular_albedo, 1.0F);
}

// The same textures as above, but one is repeated four times across: black and smooth no longer go together.
TEST(ClassifyTextured, LetsTexturesWithDifferentTransformsMeetAnywhere) {
  SceneData scene;
  Material m = makeMetalFactors();
  m.metallic_roughness_texture =
      addTexture(scene, 256, 128, [](int x, int) { return x < 128 ? kMirror : kRoughMetal; });
  m.base_color_texture =
      addTexture(scene, 64, 64, [](int x, int) { return x < 32 ? glm::u8vec4(0, 0, 0, 255) : glm::u8vec4(255); });
  m.base_color_texture.uv_from_texcoord = mat3(4.0F);
  EXPECT_TRUE(classify(scene, m).is_generator);
}

TEST(ClassifyTextured, ScalesFactorsByEveryTexture) {
  SceneData scene;
  Material m = makeGlass();
  m.transmission_texture =
      addTexture(scene, 128, 128, [](int x, int y) { return glm::u8vec4(x == 90 && y == 4 ? 255 : 0, 9, 9, 9); });
  EXPECT_NEAR(classify(scene, m).specular_transmission, 0.96F, 1e-6F);
  EXPECT_TRUE(classify(scene, m).is_receiver);
  m.specular_texture = addConstant(scene, glm::u8vec4(255, 255, 255, 0));
  EXPECT_EQ(classify(scene, m).specular_albedo, 0.0F);
  EXPECT_NEAR(classify(scene, m).specular_transmission, 1.0F, 1e-6F);
  m.specular_texture = TextureRef{};
  m.specular_color_texture = addConstant(scene, glm::u8vec4(255, 0, 0, 255));
  EXPECT_NEAR(classify(scene, m).specular_transmission, 0.2126F * 0.96F + 0.7874F, 1e-5F);
}

TEST(ClassifyTextured, ReadsFloatTextures) {
  SceneData scene;
  Image image(33, 65, 3, 1.0F);
  image.setRgb(32, 64, vec3(1.0F, 0.1F, 1.0F));
  scene.images.push_back({"float", image});
  Material m = makeMetalFactors();
  m.metallic_roughness_texture.image = 0;
  EXPECT_TRUE(classify(scene, m).is_generator);
  EXPECT_FLOAT_EQ(classify(scene, m).alpha, 0.01F);
}

TEST(ClassifyMaterials, IsByMaterial) {
  SceneData scene;
  Material m = makeMetalFactors();
  m.metallic_roughness_texture = addConstant(scene, kSmoothDielectric);
  scene.materials = {Material{}, makeGlass(), m};
  const std::vector<Classification> classes = classifyMaterials(scene);
  ASSERT_EQ(classes.size(), 3U);
  EXPECT_TRUE(classes[0].is_receiver);
  EXPECT_FALSE(classes[0].is_weak_generator);
  EXPECT_TRUE(classes[1].is_generator);
  EXPECT_TRUE(classes[2].is_weak_generator);
}

}  // namespace
}  // namespace nephroid
