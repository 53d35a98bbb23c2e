// A Vulkan instance, and what the validation layer said.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu/api.h"

namespace nephroid::gpu {

struct InstanceSettings {
  bool validation = false;  ///< load VK_LAYER_KHRONOS_validation with synchronisation checks
};

/// Owns a VkInstance. Thread-safe but for destruction.
class Instance {
 public:
  /// @throws DeviceError if there is no Vulkan 1.3 loader, or no validation layer where it was asked for
  explicit Instance(const InstanceSettings& settings = {});
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return handle_; }
  const InstanceApi& api() const { return api_; }
  bool validates() const { return messenger_ != VK_NULL_HANDLE; }
  /// Warnings and errors of the validation layer so far, oldest first; empty without it.
  std::vector<std::string> validationMessages() const;

 private:
  struct Messages;
  void destroy();

  GlobalApi global_;
  InstanceApi api_;
  VkInstance handle_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::unique_ptr<Messages> messages_;  ///< stays where it is: the layer holds its address
};

}  // namespace nephroid::gpu
