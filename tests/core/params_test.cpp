#include "core/params.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <string>

#include "nephroid/error.h"

namespace nephroid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

ParamSet makeParams() {
  return ParamSet({
      {.name = "photons", .default_value = 1000, .lower = 1, .upper = 5000, .text = "Photons."},
      {.name = "radius", .default_value = 0.5F, .lower = 0.1, .upper = 0.7, .unit = "m", .text = "Radius."},
      {.name = "gain", .default_value = 1.0F, .text = "Unbounded."},
      {.name = "depth", .default_value = kInfinity, .lower = 0, .upper = kInfinity, .unit = "m", .text = "Depth."},
      {.name = "flux", .default_value = std::string("exact"), .text = "Rule.", .choices = {"exact", "eq6"}},
      {.name = "title", .default_value = std::string(), .text = "Any text."},
      {.name = "clip", .default_value = true, .text = "Clip."},
      {.name = "colour", .default_value = vec3(1.0F), .lower = 0, .upper = 1, .text = "Colour."},
  });
}

std::string getRefusal(std::string_view name, std::string_view text) {
  ParamSet params = makeParams();
  try {
    params.set(name, text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ParamSet, HoldsDefaultsUntilSet) {
  ParamSet params = makeParams();
  EXPECT_EQ(params.getInt("photons"), 1000);
  EXPECT_EQ(params.getFloat("radius"), 0.5F);
  EXPECT_EQ(params.getString("flux"), "exact");
  EXPECT_TRUE(params.getBool("clip"));
  EXPECT_EQ(params.getVec3("colour"), vec3(1.0F));
  EXPECT_FALSE(params.isSet("photons"));
  params.set("photons", "1000");
  EXPECT_TRUE(params.isSet("photons"));
  EXPECT_TRUE(params.has("flux"));
  EXPECT_FALSE(params.has("flu"));
}

TEST(ParamSet, ParsesEachType) {
  ParamSet params = makeParams();
  params.set("photons", "42");
  params.set("gain", "-1.5e-3");
  params.set("flux", "eq6");
  params.set("title", "a=b, c");
  params.set("clip", "off");
  params.set("colour", "1,0.5,0.25");
  EXPECT_EQ(params.getInt("photons"), 42);
  EXPECT_EQ(params.getFloat("gain"), -1.5e-3F);
  EXPECT_EQ(params.getString("flux"), "eq6");
  EXPECT_EQ(params.getString("title"), "a=b, c");
  EXPECT_FALSE(params.getBool("clip"));
  EXPECT_EQ(params.getVec3("colour"), vec3(1.0F, 0.5F, 0.25F));
}

TEST(ParamSet, ReadsHexColoursAsSrgb) {
  ParamSet params = makeParams();
  params.set("colour", "#ff0080");
  const vec3 colour = params.getVec3("colour");
  EXPECT_EQ(colour.x, 1.0F);
  EXPECT_EQ(colour.y, 0.0F);
  // ((128/255 + 0.055) / 1.055)^2.4
  EXPECT_NEAR(colour.z, 0.215861F, 1e-5F);
}

TEST(ParamSet, RefusesWhatIsNotExactlyANumber) {
  for (const char* text : {"", " 1", "1 ", "+1", "1.5", "0x10", "1e2", "one", "99999999999999", "1,2"})
    EXPECT_THAT(getRefusal("photons", text), HasSubstr("expected a whole number in [1, 5000]")) << text;
  for (const char* text : {"", " 1", "1 ", "+1", "1,5", "1.0f", "nan", "-nan", "NaN", "inf", "-inf", "1e39", "1e999"})
    EXPECT_THAT(getRefusal("gain", text), HasSubstr("expected a number")) << text;
  for (const char* text : {"", "1", "1,2", "1,2,3,4", "1,,1", "1,1,", ",1,1", "#fff", "#gg0000", "#-10000", "#ff00800"})
    EXPECT_THAT(getRefusal("colour", text), HasSubstr("three numbers")) << text;
  for (const char* text : {"", "TRUE", "2", "tru"})
    EXPECT_THAT(getRefusal("clip", text), HasSubstr("expected true or false")) << text;
}

TEST(ParamSet, ChecksRangesInclusively) {
  for (const char* text : {"1", "5000"}) EXPECT_EQ(getRefusal("photons", text), "accepted");
  for (const char* text : {"0", "5001"}) EXPECT_NE(getRefusal("photons", text), "accepted");
  // The nearest float of 0.1 lies above 0.1, that of 0.7 below: what is written counts.
  for (const char* text : {"0.1", "0.7"}) EXPECT_EQ(getRefusal("radius", text), "accepted");
  EXPECT_THAT(getRefusal("radius", "0.09999999999"), HasSubstr("a number in [0.1, 0.7] m"));
  EXPECT_NE(getRefusal("colour", "0,0,1.01"), "accepted");
}

TEST(ParamSet, TakesInfinityOnlyWhereTheRangeNamesIt) {
  EXPECT_EQ(getRefusal("depth", "inf"), "accepted");
  EXPECT_NE(getRefusal("depth", "-inf"), "accepted");
  EXPECT_NE(getRefusal("depth", "nan"), "accepted");
  EXPECT_NE(getRefusal("gain", "inf"), "accepted");
}

TEST(ParamSet, RoundsTinyNumbersToZero) {
  ParamSet params = makeParams();
  params.set("gain", "1e-60");
  EXPECT_EQ(params.getFloat("gain"), 0.0F);
}

TEST(ParamSet, NamesChoicesAndTheNearestOne) {
  EXPECT_EQ(getRefusal("flux", "eqq6"), "flux=eqq6: expected one of exact, eq6; did you mean 'eq6'?");
}

TEST(ParamSet, NamesTheNearestParameterOrAll) {
  EXPECT_THAT(getRefusal("photon", "1"), HasSubstr("unknown parameter 'photon'; did you mean 'photons'?"));
  EXPECT_THAT(getRefusal("zzzzzz", "1"), HasSubstr("(known: photons, radius"));
  EXPECT_THROW(ParamSet().set("x", "1"), UsageError);
}

TEST(ParamSet, KeepsTheOldValueIfTheNewOneIsRefused) {
  ParamSet params = makeParams();
  EXPECT_THROW(params.set("photons", "0"), UsageError);
  EXPECT_EQ(params.getInt("photons"), 1000);
  EXPECT_FALSE(params.isSet("photons"));
}

TEST(ParamSet, TreatsAWrongReadAsOurMistake) {
  const ParamSet params = makeParams();
  EXPECT_THROW(params.getInt("radius"), InternalError);
  EXPECT_THROW(params.getInt("none"), InternalError);
}

TEST(ParamSet, WritesTextThatSetsTheSameValue) {
  ParamSet params = makeParams();
  ParamSet copy = makeParams();
  params.set("radius", "0.3333333433");
  params.set("gain", "16777216");
  params.set("colour", "#123456");
  for (const ParamSpec& spec : params.specs()) {
    copy.set(spec.name, params.toText(spec.name));
    EXPECT_EQ(copy.toText(spec.name), params.toText(spec.name)) << spec.name;
  }
  EXPECT_EQ(copy.getFloat("radius"), params.getFloat("radius"));
  EXPECT_EQ(copy.getVec3("colour"), params.getVec3("colour"));
}

TEST(FormatParamValue, IsShortAndDoesNotDependOnTheLocale) {
  // Where the locale is not installed, setlocale leaves "C", which the expectation fits as well.
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  EXPECT_EQ(formatParamValue(0.1F), "0.1");
  ParamSet params = makeParams();
  params.set("gain", "2.5");
  EXPECT_EQ(params.getFloat("gain"), 2.5F);
  std::setlocale(LC_ALL, "C");
  EXPECT_EQ(formatParamValue(vec3(1.0F, 0.5F, -2.0F)), "1,0.5,-2");
  EXPECT_EQ(formatParamValue(false), "false");
  EXPECT_EQ(formatParamValue(std::string("a b")), "a b");
}

TEST(ParseKeyValues, SplitsAtTheSeparator) {
  EXPECT_THAT(parseKeyValues("eye=1,2,3:fov=40", ':'), ElementsAre(Pair("eye", "1,2,3"), Pair("fov", "40")));
  EXPECT_THAT(parseKeyValues("mesh=a.ply&ior=1.5", '&'), ElementsAre(Pair("mesh", "a.ply"), Pair("ior", "1.5")));
  EXPECT_THAT(parseKeyValues("", '&'), IsEmpty());
  EXPECT_THAT(parseKeyValues("a=", ','), ElementsAre(Pair("a", "")));
}

TEST(ParseKeyValues, KeepsCommasThatNoKeyFollows) {
  EXPECT_THAT(parseKeyValues("ior=1.5,attenuation=0.1,0.2,0.3,abbe=40", ','),
              ElementsAre(Pair("ior", "1.5"), Pair("attenuation", "0.1,0.2,0.3"), Pair("abbe", "40")));
}

TEST(ParseKeyValues, RefusesPiecesWithoutKey) {
  EXPECT_THROW(parseKeyValues("1.5", ','), UsageError);
  EXPECT_THROW(parseKeyValues("=1.5", ','), UsageError);
  EXPECT_THROW(parseKeyValues("a=1&b", '&'), UsageError);
  EXPECT_THROW(parseKeyValues("a=1,,b=2", ','), UsageError);
}

TEST(SuggestName, FindsLikelySlipsOnly) {
  const std::vector<std::string> names{"caustic-map", "photon-splat", "reference", "ior", "id"};
  EXPECT_EQ(suggestName("causticmap", names), "caustic-map");
  EXPECT_EQ(suggestName("refernece", names), "reference");
  EXPECT_EQ(suggestName("REFERENCE", names), "reference");
  EXPECT_EQ(suggestName("irr", names), "ior");
  EXPECT_EQ(suggestName("photon", names), "photon-splat");
  EXPECT_EQ(suggestName("x", names), "");
  EXPECT_EQ(suggestName("", names), "");
  EXPECT_EQ(suggestName("wavelength", names), "");
  EXPECT_EQ(suggestName(std::string(100000, 'a'), names), "");
}

}  // namespace
}  // namespace nephroid
