#include "gpu/device_survey.h"

#include "nephroid/error.h"
#ifdef NEPHROID_VULKAN
#include "gpu/instance.h"
#endif

namespace nephroid::gpu {

#ifdef NEPHROID_VULKAN

DeviceSurvey surveyDevices() {
  DeviceSurvey survey;
  try {
    const Instance instance;
    survey.devices = listDevices(instance);
    // They die with the instance, at the end of this block.
    for (DeviceInfo& device : survey.devices) device.handle = nullptr;
    DeviceChoice choice = chooseDevice(survey.devices, "auto");
    survey.auto_device = choice.index;
    survey.reason = std::move(choice.reason);
  } catch (const DeviceError& error) {
    survey.reason = error.what();
  }
  return survey;
}

#else

DeviceSurvey surveyDevices() {
  return {.reason =
              "this build has no Vulkan half (NEPHROID_VULKAN=OFF): use --device cpu, or build with "
              "-DNEPHROID_VULKAN=ON"};
}

#endif

}  // namespace nephroid::gpu
