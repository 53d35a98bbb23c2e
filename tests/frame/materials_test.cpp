// Textures, colours of vertices and normal maps, as the reference reads them.
#include <cmath>
#include <random>

#include "frame/frame.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

constexpr int kSize = 48;

class MaterialsTest : public testing::GpuTest {
 protected:
  /// The layers of geometry are made without chance: every pixel agrees but where an edge passes its centre.
  static void expectLayerLikeReference(const SceneData& scene, const std::string& layer, float tolerance) {
    const Camera camera = makeCamera("eye", vec3(0.3F, 2, 1.5F), vec3(0), 0.8F);
    RealtimeFrame frame(device(), scene, camera, {.width = kSize, .height = kSize});
    const Image ours = frame.readGeometry(layer);
    const RenderResult reference = test::renderReference(scene, camera, test::makeSettings(kSize, 1, 1, {layer}));
    const Image& theirs = reference.image.layers[0].image;
    int off = 0;
    float widest = 0.0F;
    for (std::size_t i = 0; i < ours.pixels.size(); ++i) {
      off += std::abs(ours.pixels[i] - theirs.pixels[i]) > tolerance ? 1 : 0;
      widest = std::max(widest, theirs.pixels[i]);
    }
    EXPECT_LE(off, 3) << layer;
    EXPECT_GT(widest, 0.0F);
  }
};

/// A floor with coordinates that run beyond the image on both sides, in two sets.
SceneData makeTexturedFloor() {
  SceneData scene;
  Mesh floor = test::makeFloor(2.0);
  floor.texcoords[0].clear();
  for (const vec3& p : floor.positions) {
    floor.texcoords[0].emplace_back(1.7F * p.x + 0.2F, 1.3F * p.z - 0.4F);
    floor.texcoords[1].emplace_back(0.4F * p.z + 0.5F, 0.6F * p.x + 0.5F);
  }
  test::addObject(scene, floor, test::makeDiffuse(vec3(0.9F, 0.8F, 0.7F)));
  std::mt19937 random(5);
  ByteImage bytes{5, 3, {}};
  Image floats(4, 4, 3);
  for (int i = 0; i < 5 * 3 * 4; ++i) bytes.pixels.push_back(static_cast<std::uint8_t>(random() & 255U));
  for (float& f : floats.pixels) f = static_cast<float>(random() & 255U) / 255.0F;
  scene.images.push_back({"bytes", bytes});
  scene.images.push_back({"floats", floats});
  scene.lights.push_back(test::makeSun(vec3(0.2F, -1, 0.1F), vec3(2)));
  return scene;
}

TEST_F(MaterialsTest, TexturesAreReadAsTheReferenceReadsThem) {
  const SceneData plain = makeTexturedFloor();
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kClamp, Wrap::kMirror})
    for (int kind = 0; kind < 4; ++kind) {
      SceneData scene = plain;
      TextureRef& reference = scene.materials[0].base_color_texture;
      reference.image = kind == 1 ? 1 : 0;
      reference.wrap_u = wrap;
      reference.wrap_v = kind == 0 ? Wrap::kClamp : wrap;
      reference.nearest = kind == 2;
      reference.texcoord = kind == 3 ? 1 : 0;
      reference.uv_from_texcoord = mat3(vec3(0.8F, 0.6F, 0), vec3(-0.6F, 0.8F, 0), vec3(0.3F, -0.2F, 1));
      SCOPED_TRACE(::testing::Message() << "wrap " << static_cast<int>(wrap) << ", kind " << kind);
      expectLayerLikeReference(scene, "albedo", 2e-4F);
    }
}

TEST_F(MaterialsTest, ColoursOfVerticesMultiplyTheBase) {
  SceneData scene = makeTexturedFloor();
  scene.meshes[0].colors = {vec4(1, 0, 0, 1), vec4(0, 1, 0, 1), vec4(0, 0, 1, 1), vec4(1, 1, 0, 1)};
  ASSERT_EQ(scene.meshes[0].colors.size(), scene.meshes[0].positions.size());
  expectLayerLikeReference(scene, "albedo", 2e-5F);
}

TEST_F(MaterialsTest, NormalMapsLeanTheNormal) {
  for (const bool tangents : {false, true}) {
    SceneData scene = makeTexturedFloor();
    scene.materials[0].normal_texture.image = 0;
    scene.materials[0].normal_scale = 0.7F;
    if (tangents) scene.meshes[0].tangents.assign(4, vec4(0.6F, 0, 0.8F, -1));
    SCOPED_TRACE(tangents);
    expectLayerLikeReference(scene, "normal", 3e-4F);
    scene.instances[0].world_from_object[0] = vec4(-1.2F, 0, 0, 0);  // mirrored
    expectLayerLikeReference(scene, "normal", 3e-4F);
  }
}

TEST_F(MaterialsTest, TexturesBearOnLight) {
  // Roughness, metal and emission by texture: `direct` and `emission` of the mean picture.
  SceneData scene = makeTexturedFloor();
  Material& m = scene.materials[0];
  m.metallic_roughness_texture.image = 0;
  m.metallic_roughness_texture.texcoord = 1;
  m.metallic = 1.0F;
  m.emission = vec3(1, 2, 3);
  m.emission_texture.image = 0;
  m.specular_color_texture.image = 0;
  const Camera camera = makeCamera("eye", vec3(0.3F, 2, 1.5F), vec3(0), 0.8F);
  RealtimeFrame frame(device(), scene, camera, {.width = 32, .height = 32});
  for (std::uint32_t s = 0; s < 64; ++s) frame.render(s);
  const RenderResult reference =
      test::renderReference(scene, camera, test::makeSettings(32, 256, 1, {"direct", "emission"}));
  for (const Layer& layer : reference.image.layers) {
    const dvec3 a = test::meanOf(frame.readSummed(layer.name)), b = test::meanOf(layer.image);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 0.004 * b[c]) << layer.name;
  }
}

TEST_F(MaterialsTest, TexturedLampsLightByTheirTexture) {
  SceneData scene = makeTexturedFloor();
  scene.lights.clear();
  Mesh lamp = makeRectangle("lamp", dvec3(0.2, 0.7, 0), dvec3(0.4, 0, 0), dvec3(0, 0, 0.4));
  lamp.texcoords[0].clear();
  for (const vec3& p : lamp.positions) lamp.texcoords[0].emplace_back(p.x, p.z);
  Material glow = test::makeDiffuse(vec3(0.0F));
  glow.emission = vec3(5);
  glow.emission_texture.image = 0;
  test::addObject(scene, lamp, glow);
  const Camera camera = makeCamera("eye", vec3(0.3F, 2, 1.5F), vec3(0), 0.8F);
  RealtimeFrame frame(device(), scene, camera, {.width = 24, .height = 24});
  for (std::uint32_t s = 0; s < 512; ++s) frame.render(s);
  const RenderResult reference = test::renderReference(scene, camera, test::makeSettings(24, 256, 1, {"direct"}));
  const dvec3 a = test::meanOf(frame.readSummed("direct")), b = test::meanOf(reference.image.layers[0].image);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 0.02 * b[c]);
}

}  // namespace
}  // namespace nephroid
