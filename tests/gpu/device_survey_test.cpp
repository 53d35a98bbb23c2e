#include "gpu/device_survey.h"

#include <gtest/gtest.h>

namespace nephroid::gpu {
namespace {

TEST(SurveyDevices, FindsADeviceAndHandsOutNoHandleOfAnInstanceThatIsGone) {
  const DeviceSurvey survey = surveyDevices();
  ASSERT_FALSE(survey.devices.empty()) << survey.reason;
  for (const DeviceInfo& device : survey.devices) EXPECT_EQ(device.handle, nullptr);
}

TEST(SurveyDevices, AutoIsWhatChooseDeviceTakes) {
  const DeviceSurvey survey = surveyDevices();
  const DeviceChoice choice = chooseDevice(survey.devices, "auto");
  EXPECT_EQ(survey.auto_device, choice.index);
  EXPECT_EQ(survey.reason, choice.reason);
}

}  // namespace
}  // namespace nephroid::gpu
