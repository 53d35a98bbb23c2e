// `nephroid compare` on pictures whose differences are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/process.h"
#include "core/image/image_io.h"

namespace nephroid::test {
namespace {

using ::testing::HasSubstr;

/// Layers of one constant colour each.
void writeConstant(const std::string& path, int width, int height,
                   const std::vector<std::pair<std::string, float>>& layers) {
  LayeredImage image{.width = width, .height = height};
  for (const auto& [name, value] : layers) image.layers.push_back({name, Image(width, height, 3, value)});
  writeExr(path, image);
}

TEST(Compare, TellsMeansRatioAndError) {
  const TempFolder folder;
  writeConstant(folder.file("a.exr"), 4, 3, {{"beauty", 3.0F}});
  writeConstant(folder.file("b.exr"), 4, 3, {{"beauty", 2.0F}});
  const ProcessResult result =
      runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr"), "--metric", "rmse", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_DOUBLE_EQ(json["ratio"][1].get<double>(), 1.5);
  EXPECT_NEAR(json["metrics"]["rmse"].get<double>(), 1.0, 1e-6);
  EXPECT_EQ(json["pixels"], 12);
  EXPECT_THAT(runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr")}).out, HasSubstr("ratio"));
}

TEST(Compare, SumsLayersAndTakesAnotherOfTheReference) {
  const TempFolder folder;
  writeConstant(folder.file("a.exr"), 4, 3, {{"direct", 1.0F}, {"caustic", 2.0F}});
  writeConstant(folder.file("b.exr"), 4, 3, {{"beauty", 3.0F}});
  const ProcessResult result = runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr"), "--layer",
                                            "direct+caustic", "--reference-layer", "beauty", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_DOUBLE_EQ(nlohmann::json::parse(result.out)["ratio"][0].get<double>(), 1.0);
}

TEST(Compare, CountsOnlyPixelsWhereTheMaskIsWhite) {
  const TempFolder folder;
  LayeredImage image{.width = 2, .height = 1};
  image.layers.push_back({"beauty", Image(2, 1, 3, 1.0F)});
  image.layers[0].image.setRgb(1, 0, vec3(9.0F));
  writeExr(folder.file("a.exr"), image);
  writeConstant(folder.file("b.exr"), 2, 1, {{"beauty", 1.0F}});
  Image mask(2, 1, 3, 1.0F);
  mask.setRgb(1, 0, vec3(0.5F));
  writePng(folder.file("m.png"), mask);
  const ProcessResult result =
      runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr"), "--mask", folder.file("m.png"), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["pixels"], 1);
  EXPECT_DOUBLE_EQ(json["mean"][0].get<double>(), 1.0);
}

TEST(Compare, OtherSizeOrMissingLayerIsBadInput) {
  const TempFolder folder;
  writeConstant(folder.file("a.exr"), 4, 3, {{"beauty", 1.0F}});
  writeConstant(folder.file("b.exr"), 4, 4, {{"beauty", 1.0F}});
  const ProcessResult size = runNephroid({"compare", folder.file("a.exr"), folder.file("b.exr")});
  EXPECT_EQ(size.exit_code, 3);
  EXPECT_THAT(size.err, HasSubstr("4x3"));
  EXPECT_THAT(size.err, HasSubstr("4x4"));
  const ProcessResult layer =
      runNephroid({"compare", folder.file("a.exr"), folder.file("a.exr"), "--layer", "caustic"});
  EXPECT_EQ(layer.exit_code, 3);
  EXPECT_THAT(layer.err, HasSubstr(folder.file("a.exr")));
  EXPECT_THAT(layer.err, HasSubstr("caustic"));
  EXPECT_EQ(runNephroid({"compare", folder.file("a.exr"), folder.file("missing.exr")}).exit_code, 3);
}

TEST(Compare, UnknownMetricIsWrongUsage) {
  const TempFolder folder;
  writeConstant(folder.file("a.exr"), 4, 3, {{"beauty", 1.0F}});
  const ProcessResult result =
      runNephroid({"compare", folder.file("a.exr"), folder.file("a.exr"), "--metric", "beauty"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("rmse"));
}

}  // namespace
}  // namespace nephroid::test
