#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "nephroid/error.h"
#include "scene/import/gltf_materials.h"
#include "support/gltf_builder.h"

namespace nephroid::gltf {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing_support::GltfBuilder;
using testing_support::json;

Material loadMaterial(const json& material) {
  GltfBuilder builder;
  builder.addTriangleWith(material);
  return builder.load().materials.at(0);
}

json withExtension(const char* name, const json& value) { return {{"extensions", {{name, value}}}}; }

TEST(GltfMaterial, HasGltfsDefaults) {
  const Material material = loadMaterial(json::object());
  EXPECT_EQ(material.base_color, vec4(1));
  EXPECT_EQ(material.metallic, 1.0F);
  EXPECT_EQ(material.roughness, 1.0F);
  EXPECT_EQ(material.ior, 1.5F);
  EXPECT_EQ(material.transmission, 0.0F);
  EXPECT_FALSE(material.emits());
}

TEST(GltfMaterial, ReadsGlass) {
  const Material material =
      loadMaterial({{"extensions",
                     {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
                      {"KHR_materials_ior", {{"ior", 1.33}}},
                      {"KHR_materials_dispersion", {{"dispersion", 0.4}}},
                      {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 2}}}},
                      {"KHR_materials_volume",
                       {{"thicknessFactor", 0.2}, {"attenuationDistance", 3}, {"attenuationColor", {0.1, 0.2, 0.3}}}}}},
                    {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                    {"extras", {{"priority", 7}}}});
  EXPECT_FLOAT_EQ(material.transmission, 0.9F);
  EXPECT_FLOAT_EQ(material.ior, 1.33F);
  EXPECT_FLOAT_EQ(material.dispersion, 0.4F);
  EXPECT_FLOAT_EQ(material.specular_factor, 0.5F);
  EXPECT_EQ(material.specular_color, vec3(1, 0.5F, 2));
  EXPECT_FLOAT_EQ(material.attenuation_distance, 3.0F);
  EXPECT_EQ(material.attenuation_color, vec3(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(material.priority, 7);
  EXPECT_TRUE(material.isSolidDielectric());
}

TEST(GltfMaterial, ReadsIorZeroAsInfinite) {
  EXPECT_EQ(loadMaterial(withExtension("KHR_materials_ior", {{"ior", 0}})).ior, kInfiniteIor);
}

TEST(GltfMaterial, MultipliesEmissionByItsStrength) {
  json material = withExtension("KHR_materials_emissive_strength", {{"emissiveStrength", 10}});
  material["emissiveFactor"] = {0.5, 1, 0};
  EXPECT_EQ(loadMaterial(material).emission, vec3(5, 10, 0));
}

TEST(GltfMaterial, ReadsConductors) {
  const Material gold = loadMaterial({{"extras", {{"eta", {0.1, 0.4, 1.5}}, {"k", {4, 2.4, 1.9}}}}});
  ASSERT_TRUE(gold.conductor_ior.has_value());
  EXPECT_EQ(*gold.conductor_ior, vec3(0.1F, 0.4F, 1.5F));
  EXPECT_EQ(gold.conductor_k, vec3(4, 2.4F, 1.9F));
}

TEST(GltfMaterial, IgnoresExtrasOfOtherPrograms) {
  EXPECT_NO_THROW(loadMaterial({{"extras", "text"}}));
  EXPECT_EQ(loadMaterial({{"extras", {{"priority", "high"}, {"eta", 1}}}}).priority, 0);
}

/// A value out of range, what it becomes, and the word by which the warning names it.
struct OutOfRange {
  const char* name;
  json material;
  std::string word;
};
void PrintTo(const OutOfRange& value, std::ostream* out) { *out << value.name; }

class ValueOutOfRange : public testing::TestWithParam<OutOfRange> {};

TEST_P(ValueOutOfRange, IsUsedNearbyAndWarnedAbout) {
  GltfBuilder builder;
  builder.addTriangleWith(GetParam().material);
  const SceneData scene = builder.load();
  EXPECT_THAT(scene.warnings, Contains(HasSubstr(GetParam().word)));
  const Material& material = scene.materials.at(0);
  EXPECT_GE(material.ior, 1.0F);
  EXPECT_GE(material.roughness, 0.0F);
  EXPECT_LE(material.roughness, 1.0F);
  EXPECT_LE(material.transmission, 1.0F);
  EXPECT_GE(minComponent(material.emission), 0.0F);
  EXPECT_GT(material.attenuation_distance, 0.0F);
}

INSTANTIATE_TEST_SUITE_P(
    Values, ValueOutOfRange,
    testing::Values(OutOfRange{"IorBelowOne", withExtension("KHR_materials_ior", {{"ior", 0.7}}), "ior"},
                    OutOfRange{"Roughness", {{"pbrMetallicRoughness", {{"roughnessFactor", 2}}}}, "roughnessFactor"},
                    OutOfRange{"Transmission", withExtension("KHR_materials_transmission", {{"transmissionFactor", 3}}),
                               "transmissionFactor"},
                    OutOfRange{"EmissionNegative", {{"emissiveFactor", {-1, 0, 0}}}, "emissiveFactor"},
                    OutOfRange{"EmissionAboveOne", {{"emissiveFactor", {2, 0, 0}}}, "emissiveFactor"},
                    OutOfRange{"Attenuation", withExtension("KHR_materials_volume", {{"attenuationDistance", 0}}),
                               "attenuationDistance"},
                    OutOfRange{"Unlit", withExtension("KHR_materials_unlit", json::object()), "KHR_materials_unlit"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(GltfTexture, OutOfRangeIsRefused) { EXPECT_THROW(loadMaterial({{"normalTexture", {{"index", 3}}}}), InputError); }

TEST(GltfTexture, InKtx2OnlyIsRefusedByName) {
  GltfBuilder builder;
  builder.root["textures"] = {withExtension("KHR_texture_basisu", {{"source", 0}})};
  builder.root["images"] = {{{"uri", "a.ktx2"}, {"mimeType", "image/ktx2"}}};
  builder.addTriangleWith({{"normalTexture", {{"index", 0}}}});
  try {
    builder.load();
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(std::string(error.what()), HasSubstr("KHR_texture_basisu"));
  }
}

/// The extension's own example: the lower left quadrant of the picture, turned by 90°. v points down, so that quadrant
/// is u in [0, 0.5], v in [0.5, 1].
TEST(TextureTransform, AgreesWithTheWorkedExampleOfTheExtension) {
  const mat3 m = makeTextureTransform({0, 1}, kPi / 2, {0.5F, 0.5F});
  const auto apply = [&](float u, float v) { return vec2(m * vec3(u, v, 1)); };
  const auto expectNear = [](vec2 a, vec2 b) { EXPECT_LT(glm::length(a - b), 1e-6F) << a.x << " " << a.y; };
  expectNear(apply(0, 0), {0, 1});
  expectNear(apply(1, 0), {0, 0.5F});
  expectNear(apply(0, 1), {0.5F, 1});
  expectNear(apply(1, 1), {0.5F, 0.5F});
}

}  // namespace
}  // namespace nephroid::gltf
