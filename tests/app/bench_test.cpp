// `nephroid bench` as a process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/process.h"

namespace nephroid::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Bench, ReportsMedianAndSpreadAsJson) {
  const ProcessResult result =
      runNephroid({"bench", "builtin:ring", "--technique", "reference", "--repeats", "2", "--warmup", "0", "--size",
                   "16x12", "--samples", "1", "--photons", "1000", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["results"][0]["scene"], "builtin:ring");
  std::vector<std::string> names;
  for (const auto& measurement : json["results"][0]["measurements"]) {
    names.push_back(measurement["name"]);
    EXPECT_GT(measurement["median"].get<double>(), 0) << names.back();
  }
  EXPECT_THAT(names, Contains("rays"));
  EXPECT_THAT(names, Contains("peak memory"));
}

/// The reference against itself, with random numbers of its own: what needs no device.
std::vector<std::string> errorArguments(std::vector<std::string> more) {
  std::vector<std::string> arguments{"bench",  "--error", "builtin:slab",        "--technique", "reference",
                                     "--size", "24x18",   "--reference-photons", "100k",        "--photons",
                                     "100k",   "--set",   "estimator=light"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(BenchError, OfTheReferenceItselfIsNoise) {
  const ProcessResult result = runNephroid(errorArguments({"--json"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["reference_photons"], 100'000);
  EXPECT_EQ(json["size"], "24x18");
  ASSERT_EQ(json["results"].size(), 2U);
  const nlohmann::json &noise = json["results"][0], &other = json["results"][1];
  EXPECT_EQ(noise["technique"], "reference/2");
  EXPECT_EQ(other["technique"], "reference");
  for (const nlohmann::json& row : json["results"]) {
    EXPECT_EQ(row["scene"], "builtin:slab");
    EXPECT_NEAR(row["energy"].get<double>(), 1.0, 0.02);
    EXPECT_GT(row["flip"].get<double>(), 0.0);
    EXPECT_LT(row["flip"].get<double>(), 0.1);
    EXPECT_LT(row["lost"].get<double>(), 0.01);
  }
  // The variance of a half and that of the mean of two: three times that of the mean for independent photons, about
  // twice for those that are spread evenly. It is 1 if random numbers are the same as a half's.
  const double ratio = other["relmse"].get<double>() / noise["relmse"].get<double>();
  EXPECT_GT(ratio, 1.4);
  EXPECT_LT(ratio, 4.5);
}

TEST(BenchError, PrintsATableOfSceneAndTechnique) {
  const ProcessResult result = runNephroid(errorArguments({}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("caustic at 24x18 against the reference's of 0.1 M photons\n"));
  EXPECT_THAT(
      result.out,
      HasSubstr("\nscene         technique        relMSE     FLIP   energy      lost\nbuiltin:slab  reference/2 "));
  EXPECT_THAT(result.out, HasSubstr("\nbuiltin:slab  reference  "));
}

TEST(BenchError, TellsTheShareThatTheLedgerHasAsLost) {
  // One bounce is what a photon needs to enter glass: all that does is lost.
  const ProcessResult result =
      runNephroid({"bench", "--error", "builtin:slab", "--technique", "reference", "--set", "max-bounces=1", "--size",
                   "8x6", "--reference-photons", "20k", "--photons", "20k", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json row = nlohmann::json::parse(result.out)["results"][1];
  EXPECT_GT(row["lost"].get<double>(), 0.8);
  EXPECT_NEAR(row["lost_by_reason"]["bounce limit"].get<double>(), row["lost"].get<double>(), 1e-6);
  EXPECT_LT(row["energy"].get<double>(), 0.2);
}

TEST(BenchError, RefusesOptionsThatWouldDoNothing) {
  EXPECT_EQ(runNephroid(errorArguments({"--repeats", "2"})).exit_code, 2);
  EXPECT_EQ(runNephroid(errorArguments({"--warmup", "2"})).exit_code, 2);
  EXPECT_EQ(runNephroid({"bench", "--error", "builtin:ring", "--reference-photons", "1"}).exit_code, 2);
  const ProcessResult result = runNephroid({"bench", "builtin:ring", "--reference-photons", "100"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--reference-photons is for --error"));
}

TEST(BenchRace, GivesEachEstimatorACurveWhoseErrorFalls) {
  const TempFolder folder;
  const ProcessResult result = runNephroid({"bench", "--race", "builtin:slab", "--size", "32x24", "--reference-photons",
                                            "200k", "--race-seconds", "0.5", "--set", "estimator=light", "--set",
                                            "estimator=footprint", "--json", "--svg", folder.file("race.svg")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json curves = nlohmann::json::parse(result.out)["results"][0]["curves"];
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_EQ(curves[0]["estimator"], "light");
  EXPECT_EQ(curves[1]["estimator"], "footprint");
  const nlohmann::json& points = curves[0]["points"];
  ASSERT_GE(points.size(), 2U);
  EXPECT_EQ(points[0]["photons"], 32768);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i]["photons"], points[0]["photons"].get<std::uint64_t>() << i);
    EXPECT_GT(points[i]["cpu_s"].get<double>(), 0.0);
    EXPECT_GT(points[i]["nrmse"].get<double>(), 0.0);
  }
  EXPECT_LT(points.back()["l1"].get<double>(), points[0]["l1"].get<double>());
  const std::string svg = readText(folder.file("race.svg"));
  EXPECT_THAT(svg, StartsWith("<svg "));
  EXPECT_THAT(svg, HasSubstr(">footprint</text>"));
}

TEST(BenchRace, ComparesWithAReferenceUnderAMask) {
  const TempFolder folder;
  const std::string truth = folder.file("truth.exr");
  ASSERT_EQ(runNephroid({"render", "builtin:slab", "--technique", "reference", "-o", truth, "--size", "32x24", "--aov",
                         "direct,caustic", "--samples", "43", "--photons", "32768", "--set", "estimator=light"})
                .exit_code,
            0);
  const std::vector<std::string> race{"bench", "--race", "builtin:slab",    "--size", "32x24",       "--race-seconds",
                                      "0.001", "--set",  "estimator=light", "--json", "--reference", truth};
  const ProcessResult result = runNephroid(race);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // The same seed, photons and samples (32768 photons over 768 pixels, rounded up): the very picture.
  EXPECT_EQ(nlohmann::json::parse(result.out)["results"][0]["curves"][0]["points"][0]["nrmse"], 0.0);
  std::vector<std::string> masked = race;
  masked.insert(masked.end(), {"--mask", folder.file("none.png")});
  EXPECT_EQ(runNephroid(masked).exit_code, 3);
}

TEST(BenchRace, RefusesOptionsThatWouldDoNothing) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"bench", "--race", "builtin:slab", "--photons", "1k"},
           {"bench", "--race", "builtin:slab", "--repeats", "2"},
           {"bench", "--race", "builtin:slab", "--error"},
           {"bench", "--race", "builtin:slab", "--technique", "caustic-map"},
           {"bench", "--race", "builtin:slab", "builtin:ring", "--reference", "a.exr"},
           {"bench", "builtin:slab", "--svg", "a.svg"}})
    EXPECT_EQ(runNephroid(arguments).exit_code, 2) << arguments.back();
}

/// The cheapest closed form: no device, few photons.
std::vector<std::string> closedFormArguments(std::vector<std::string> more) {
  std::vector<std::string> arguments{"bench",       "--closed-form", "slab-coloured-45",
                                     "--technique", "reference",     "--photons",
                                     "200k",        "--set",         "estimator=light"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(BenchClosedForm, HoldsTheReferenceAgainstTheFormulaAsJson) {
  const ProcessResult result = runNephroid(closedFormArguments({"--set", "estimator=path", "--json"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json["results"].size(), 6U);
  const std::vector<std::string> figures{"red", "green", "blue", "red", "green", "blue"};
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const nlohmann::json& row = json["results"][i];
    EXPECT_EQ(row["closed_form"], "slab-coloured-45");
    EXPECT_EQ(row["figure"], figures[i]);
    EXPECT_EQ(row["unit"], "share");
    EXPECT_EQ(row["technique"], "reference");
    EXPECT_EQ(row["tolerance"], 0.01);
    if (i < 3) {
      EXPECT_EQ(row["estimator"], "light");
      EXPECT_GT(row["error"].get<double>(), 0.0);
      EXPECT_LT(row["error"].get<double>(), 0.01);
      EXPECT_EQ(row["holds"], true);
    } else {  // no path from the eye meets a sun without a size: there is no light
      EXPECT_EQ(row["estimator"], "path");
      EXPECT_TRUE(row["error"].is_null());
      EXPECT_EQ(row["holds"], false);
    }
  }
}

TEST(BenchClosedForm, SaysWhatDoesNotHoldAndEndsWell) {
  // One bounce is what a photon needs to enter glass: nothing comes out.
  const ProcessResult result = runNephroid(closedFormArguments({"--set", "max-bounces=1"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("\nclosed form      figure     technique                  error  tolerance  holds\n"));
  EXPECT_THAT(result.out, HasSubstr("\nslab-coloured-45 red        reference light                -        1 %  NO\n"));
}

TEST(BenchClosedForm, RefusesWhatItDoesNotKnow) {
  const ProcessResult form = runNephroid({"bench", "--closed-form", "builtin:slab"});
  EXPECT_EQ(form.exit_code, 2);
  EXPECT_THAT(form.err, HasSubstr("no closed form 'builtin:slab'; there are: slab-0, "));
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {"--size", "8x8"}, {"--seconds", "1"}, {"--repeats", "2"}, {"--race"}, {"--error"}, {"--set", "none=1"}})
    EXPECT_EQ(runNephroid(closedFormArguments(more)).exit_code, 2) << more[0];
}

}  // namespace
}  // namespace nephroid::test
