// The public API, as a user of the library meets it: nothing else is included.
#include "nephroid/nephroid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace nephroid {
namespace {

RenderRequest smallRequest() {
  RenderRequest request;
  request.technique = "reference";
  request.width = 16;
  request.height = 12;
  request.samples = 1;
  request.photons = 1000;
  return request;
}

TEST(Api, RendersTheLayersAskedFor) {
  Scene scene = Scene::load("builtin:ring");
  RenderRequest request = smallRequest();
  request.layers = {"caustic", "beauty", "depth"};
  const Picture picture = render(scene, request);
  EXPECT_THAT(picture.layerNames(), ::testing::UnorderedElementsAre("beauty", "caustic", "depth"));
  const LayerView beauty = picture.layer("beauty");
  EXPECT_EQ(beauty.width, 16);
  EXPECT_EQ(beauty.height, 12);
  EXPECT_EQ(beauty.pixels.size(), 16U * 12U * 3U);
  EXPECT_EQ(picture.layer("depth").channels, 1);
  EXPECT_THROW(picture.layer("normal"), UsageError);
  EXPECT_FALSE(picture.interrupted());
  EXPECT_EQ(picture.metadata("scene"), "builtin:ring");
  EXPECT_EQ(picture.metadata("no such key"), "");
}

TEST(Api, SaysWhatThereIs) {
  EXPECT_THAT(builtinSceneNames(), ::testing::Contains("ring"));
  EXPECT_THAT(techniqueNames(), ::testing::Contains("reference"));
  EXPECT_THAT(layerNames(), ::testing::Contains("caustic"));
  EXPECT_FALSE(version().empty());
}

TEST(Api, RefusesWhatItDoesNotKnow) {
  EXPECT_THROW(Scene::load("builtin:nothing"), UsageError);
  EXPECT_THROW(Scene::load("/no/such/file.glb"), InputError);
  Scene scene = Scene::load("builtin:ring");
  EXPECT_THROW(scene.editMaterial("no such thing:ior=2"), UsageError);
  RenderRequest request = smallRequest();
  request.width = 0;
  EXPECT_THROW(render(scene, request), UsageError);
  request = smallRequest();
  request.technique = "magic";
  EXPECT_THROW(render(scene, request), UsageError);
  request = smallRequest();
  request.parameters = {{"no such parameter", "1"}};
  EXPECT_THROW(render(scene, request), UsageError);
}

TEST(Api, StopsWhenTheCallbackSaysSo) {
  Scene scene = Scene::load("builtin:ring");
  RenderRequest request = smallRequest();
  request.photons = request.samples = 0;
  request.seconds = 600;
  int calls = 0;
  request.on_progress = [&calls](double, const std::string&) { return ++calls < 3; };
  try {
    EXPECT_TRUE(render(scene, request).interrupted());
  } catch (const InterruptedError&) {  // stopped before there was anything to keep
  }
  EXPECT_GE(calls, 3);
}

TEST(Api, EditsChangeTheScene) {
  Scene scene = Scene::load("builtin:ring");
  const std::string before = scene.describe();
  scene.editObject("*:scale=2");
  EXPECT_NE(scene.describe(), before);
}

}  // namespace
}  // namespace nephroid
