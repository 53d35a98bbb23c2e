#include "techniques/reference/path_class.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace nephroid {
namespace {

/// Events as they are met from the eye: "DSS" is L S S D E.
PathClass classOf(std::string_view from_eye) {
  PathClass c;
  for (const char event : from_eye) c.add(event == 'S' ? EventClass::kSpecular : EventClass::kDiffuse);
  return c;
}

/// Every string of up to six events.
std::vector<std::string> allStrings() {
  std::vector<std::string> strings{""};
  for (std::size_t i = 0; strings[i].size() < 6; ++i)
    for (const char event : {'S', 'D'}) strings.push_back(strings[i] + event);
  return strings;
}

TEST(PathClass, PartitionsPathsAsTheLayersAreDefined) {
  EXPECT_EQ(classOf("").layer(), PathLayer::kEmission);
  EXPECT_EQ(classOf("D").layer(), PathLayer::kDirect);
  EXPECT_EQ(classOf("DS").layer(), PathLayer::kCaustic);
  EXPECT_EQ(classOf("DSSS").layer(), PathLayer::kCaustic);
  EXPECT_EQ(classOf("S").layer(), PathLayer::kSpecular);
  EXPECT_EQ(classOf("SSDS").layer(), PathLayer::kSpecular);
  EXPECT_EQ(classOf("DD").layer(), PathLayer::kIndirect);
  EXPECT_EQ(classOf("DDS").layer(), PathLayer::kIndirect);
  EXPECT_EQ(classOf("DSD").layer(), PathLayer::kIndirect);
}

TEST(PathClass, SpecularCausticIsLightSpecularReceiverSpecularEye) {
  EXPECT_TRUE(classOf("SDS").isSpecularCaustic());
  EXPECT_TRUE(classOf("SSDSS").isSpecularCaustic());
  for (const char* other : {"S", "SD", "DS", "SDDS", "SDSD", "SS"})
    EXPECT_FALSE(classOf(other).isSpecularCaustic()) << other;
}

TEST(PathClass, LightTracingTakesWhatBeginsSpecularAndEndsDiffuse) {
  for (const char* yes : {"DS", "DSS", "DDS", "DSDS"}) EXPECT_TRUE(classOf(yes).isLightTraced()) << yes;
  for (const char* no : {"", "D", "S", "DD", "SDS", "DSD"}) EXPECT_FALSE(classOf(no).isLightTraced()) << no;
}

TEST(PathClass, KnowsWhatMayStillBecomeACaustic) {
  const std::vector<std::string> strings = allStrings();
  for (const std::string& events : strings) {
    const auto begins = [&](const std::string& whole) { return whole.starts_with(events); };
    const bool caustic = std::any_of(strings.begin(), strings.end(), [&](const std::string& whole) {
      return begins(whole) && classOf(whole).layer() == PathLayer::kCaustic;
    });
    const bool specular_caustic = std::any_of(strings.begin(), strings.end(), [&](const std::string& whole) {
      return begins(whole) && classOf(whole).isSpecularCaustic();
    });
    // The longest strings have no room for what would follow.
    if (events.empty() || events.size() > 4) continue;
    EXPECT_EQ(classOf(events).mayBecomeCaustic(), caustic) << events;
    EXPECT_EQ(classOf(events).mayBecomeSpecularCaustic(), specular_caustic) << events;
  }
}

TEST(PathClass, SpecularIndirectBeginsAndEndsSpecularWithTwoDiffuseOrMore) {
  for (const char* yes : {"SDDS", "SSDDS", "SDSDS", "SDDDS", "SDDSS", "SDSDSS"})
    EXPECT_TRUE(classOf(yes).isSpecularIndirect()) << yes;
  for (const char* no : {"", "S", "SS", "SD", "SDS", "SDD", "SDSD", "DDS", "DSDS"})
    EXPECT_FALSE(classOf(no).isSpecularIndirect()) << no;
}

TEST(PhotonPaths, TogetherAreAllThatBeginSpecularAtTheLightAndMeetADiffuseSurface) {
  const PhotonPaths all{true, true, true, true};
  for (const std::string& events : allStrings()) {
    const bool expected = events.ends_with('S') && events.find('D') != std::string::npos;
    EXPECT_EQ(all.include(classOf(events)), expected) << events;
    EXPECT_FALSE(PhotonPaths{}.include(classOf(events))) << events;
  }
}

TEST(PhotonPaths, ShareNoPath) {
  const PhotonPaths kinds[] = {
      {.caustic = true}, {.indirect = true}, {.specular_caustic = true}, {.specular_indirect = true}};
  for (const std::string& events : allStrings()) {
    const auto count = std::count_if(std::begin(kinds), std::end(kinds),
                                     [&](const PhotonPaths& k) { return k.include(classOf(events)); });
    EXPECT_LE(count, 1) << events;
  }
}

// What a photon does and where the eye's path ends decide what is gathered: each cut of a path at a D is a candidate,
// and only the one at the D that the eye meets first after S⁺ is taken.
TEST(PhotonPaths, SpecularKindsAreGatheredAtExactlyOneVertex) {
  const PhotonPaths gathered{.specular_caustic = true, .specular_indirect = true};
  for (const std::string& events : allStrings()) {
    int cuts = 0;
    for (std::size_t i = 0; i < events.size(); ++i) {
      const std::string eye = events.substr(0, i), light = events.substr(i + 1);
      // Photons leave by S; the eye gathers after mirrors and glass alone.
      if (events[i] == 'D' && light.ends_with('S') && classOf(eye).isEyeSpecular()) ++cuts;
    }
    EXPECT_EQ(cuts, gathered.include(classOf(events)) ? 1 : 0) << events;
  }
}

}  // namespace
}  // namespace nephroid
