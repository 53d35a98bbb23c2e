// A Vulkan device with the validation layer for every test that draws. There is always one (lavapipe); none is a
// failure, and so is anything that the layer says.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "gpu/device.h"

namespace nephroid::testing {

class GpuTest : public ::testing::Test {
 protected:
  /// One instance and device for all tests of a program: opening them takes a while.
  struct Shared {
    gpu::Instance instance{{.validation = true}};
    std::vector<gpu::DeviceInfo> infos = gpu::listDevices(instance);
    gpu::DeviceInfo info = infos[gpu::chooseDevice(infos, "auto").index];
    gpu::Device device{instance, info};
  };

  static void SetUpTestSuite() {
    if (!shared_) shared_ = std::make_unique<Shared>();
  }
  static void TearDownTestSuite() { shared_.reset(); }
  void SetUp() override { said_before_ = shared_->instance.validationMessages().size(); }
  void TearDown() override {
    const std::vector<std::string> messages = shared_->instance.validationMessages();
    for (std::size_t i = said_before_; i < messages.size(); ++i) ADD_FAILURE() << "validation: " << messages[i];
  }

  static gpu::Instance& instance() { return shared_->instance; }
  static const gpu::DeviceInfo& info() { return shared_->info; }
  static gpu::Device& device() { return shared_->device; }

 private:
  static inline std::unique_ptr<Shared> shared_;
  std::size_t said_before_ = 0;
};

}  // namespace nephroid::testing
