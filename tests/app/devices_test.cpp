// `nephroid devices` on this machine; lavapipe, Vulkan on the CPU, is always there (scripts/setup).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/process.h"

namespace nephroid::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

#ifdef NEPHROID_VULKAN

// Mesa's drivers forget memory and are unloaded before the leak checker looks, so that no suppression by name fits.
const std::string kForgivingLeaks = "LSAN_OPTIONS=detect_leaks=0";

TEST(Devices, ListsAtLeastOneForPeopleAndPrograms) {
  const ProcessResult text = runNephroid({"devices"}, {.environment = {kForgivingLeaks}});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, StartsWith("0  "));
  EXPECT_THAT(text.out, HasSubstr("\nauto takes "));

  const ProcessResult result = runNephroid({"devices", "--json"}, {.environment = {kForgivingLeaks}});
  EXPECT_EQ(result.exit_code, 0);
  const json survey = json::parse(result.out);
  ASSERT_GE(survey["devices"].size(), 1U);
  for (std::size_t i = 0; i < survey["devices"].size(); ++i) {
    const json& device = survey["devices"][i];
    EXPECT_EQ(device["device"], i);
    EXPECT_EQ(device["usable"], device["missing"].empty());
    EXPECT_THAT(text.out, HasSubstr(device["name"].get<std::string>()));
  }
  ASSERT_TRUE(survey["auto"].is_number_integer()) << survey["reason"];
  EXPECT_TRUE(survey["devices"].at(survey["auto"].get<std::size_t>())["usable"]);
  EXPECT_NE(survey["reason"], "");
}

// A loader that finds no driver is what a machine without any has; newer loaders read the first name, older the second.
const ProcessOptions kNoDriver{.environment = {"VK_DRIVER_FILES=/nonexistent", "VK_ICD_FILENAMES=/nonexistent"}};

TEST(Devices, WithoutADriverIsOneLineThatSaysWhatToInstall) {
  const ProcessResult result = runNephroid({"devices"}, kNoDriver);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("only the CPU: "));
  EXPECT_THAT(result.out, HasSubstr("install"));
  EXPECT_THAT(result.out, HasSubstr("--device cpu"));
  EXPECT_EQ(countLines(result.out), 1) << result.out;
}

TEST(Devices, WithoutADriverAreAnEmptyListInJson) {
  const ProcessResult result = runNephroid({"devices", "--json"}, kNoDriver);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const json survey = json::parse(result.out);
  EXPECT_TRUE(survey["devices"].is_array());
  EXPECT_TRUE(survey["devices"].empty());
  EXPECT_TRUE(survey["auto"].is_null());
  EXPECT_THAT(survey["reason"].get<std::string>(), HasSubstr("install"));
}

#else

TEST(Devices, OfABuildWithoutVulkanAreNoneAndItSaysSo) {
  const ProcessResult result = runNephroid({"devices"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, StartsWith("only the CPU: this build has no Vulkan"));
  EXPECT_EQ(countLines(result.out), 1) << result.out;
  EXPECT_TRUE(json::parse(runNephroid({"devices", "--json"}).out)["auto"].is_null());
}

#endif

TEST(Devices, TakesNoArgument) { EXPECT_EQ(runNephroid({"devices", "0"}).exit_code, 2); }

}  // namespace
}  // namespace nephroid::test
