#include "techniques/reference/path_class.h"

#include <gtest/gtest.h>

#include <string_view>

namespace nephroid {
namespace {

/// Events as they are met from the eye: "DSS" is L S S D E.
PathClass classOf(std::string_view from_eye) {
  PathClass c;
  for (const char event : from_eye) c.add(event == 'S' ? EventClass::kSpecular : EventClass::kDiffuse);
  return c;
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

}  // namespace
}  // namespace nephroid
