#include "gpu/device_list.h"

#include <gtest/gtest.h>

#include "nephroid/error.h"

namespace nephroid::gpu {
namespace {

DeviceInfo makeDevice(std::string name, std::string kind, std::uint64_t memory_bytes) {
  DeviceInfo info;
  info.name = std::move(name);
  info.kind = std::move(kind);
  info.memory_bytes = memory_bytes;
  return info;
}

TEST(ChooseDevice, AutoPrefersDiscreteThenIntegratedThenTheCpu) {
  const DeviceInfo cpu = makeDevice("cpu", "CPU", 100), integrated = makeDevice("small", "integrated GPU", 10),
                   discrete = makeDevice("large", "discrete GPU", 5);
  EXPECT_EQ(chooseDevice({cpu, integrated, discrete}, "auto").index, 2U);
  EXPECT_EQ(chooseDevice({integrated, cpu}, "auto").index, 0U);
  EXPECT_EQ(chooseDevice({cpu}, "auto").index, 0U);
  EXPECT_FALSE(chooseDevice({cpu}, "auto").reason.empty());
}

TEST(ChooseDevice, AutoTakesTheMostMemoryAmongEqualsAndSkipsWhatIsUnusable) {
  DeviceInfo first = makeDevice("first", "discrete GPU", 8), second = makeDevice("second", "discrete GPU", 16);
  EXPECT_EQ(chooseDevice({first, second}, "auto").index, 1U);
  second.missing.emplace_back("multiview");
  EXPECT_EQ(chooseDevice({first, second}, "auto").index, 0U);
}

TEST(ChooseDevice, SaysWhatIsMissingWhereNothingFits) {
  EXPECT_THROW(chooseDevice({}, "auto"), DeviceError);
  DeviceInfo old = makeDevice("old", "discrete GPU", 1);
  old.missing.emplace_back("Vulkan 1.3 (has 1.2.0)");
  try {
    chooseDevice({old}, "auto");
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("old lacks Vulkan 1.3"), std::string::npos) << error.what();
  }
  EXPECT_THROW(chooseDevice({old}, "0"), DeviceError);
  EXPECT_THROW(chooseDevice({old}, "1"), DeviceError);
  EXPECT_THROW(chooseDevice({old}, "fast"), UsageError);
}

}  // namespace
}  // namespace nephroid::gpu
