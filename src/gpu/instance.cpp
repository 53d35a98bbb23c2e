#include "gpu/instance.h"

#include <algorithm>
#include <cstring>
#include <mutex>

#include "nephroid/error.h"

namespace nephroid::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool hasLayer(const GlobalApi& api, const char* name) {
  std::uint32_t count = 0;
  check(api.EnumerateInstanceLayerProperties(&count, nullptr), "listing Vulkan layers");
  std::vector<VkLayerProperties> layers(count);
  check(api.EnumerateInstanceLayerProperties(&count, layers.data()), "listing Vulkan layers");
  return std::any_of(layers.begin(), layers.end(),
                     [&](const VkLayerProperties& l) { return std::strcmp(l.layerName, name) == 0; });
}

bool hasExtension(const GlobalApi& api, const char* name) {
  std::uint32_t count = 0;
  check(api.EnumerateInstanceExtensionProperties(nullptr, &count, nullptr), "listing Vulkan extensions");
  std::vector<VkExtensionProperties> extensions(count);
  check(api.EnumerateInstanceExtensionProperties(nullptr, &count, extensions.data()), "listing Vulkan extensions");
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

}  // namespace

struct Instance::Messages {
  std::mutex guard;
  std::vector<std::string> texts;

  static VKAPI_ATTR VkBool32 VKAPI_CALL add(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                            VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& messages = *static_cast<Messages*>(user);
    const std::lock_guard lock(messages.guard);
    messages.texts.emplace_back(data->pMessage ? data->pMessage : "");
    return VK_FALSE;
  }
};

Instance::Instance(const InstanceSettings& settings) : global_(GlobalApi::open()) {
  if (settings.validation && !hasLayer(global_, kValidationLayer))
    throw DeviceError("no Vulkan validation layer: install vulkan-validationlayers");
  // Names and labels are worth having in any build; they are what captures and messages show.
  const bool debug_utils = hasExtension(global_, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) || settings.validation;
  const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .pApplicationName = "nephroid",
                                      .pEngineName = "nephroid",
                                      .apiVersion = VK_API_VERSION_1_3};
  const VkValidationFeatureEnableEXT synchronisation = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                         .enabledValidationFeatureCount = 1,
                                         .pEnabledValidationFeatures = &synchronisation};
  const VkInstanceCreateInfo create{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                    .pNext = settings.validation ? &features : nullptr,
                                    .pApplicationInfo = &application,
                                    .enabledLayerCount = settings.validation ? 1U : 0U,
                                    .ppEnabledLayerNames = &kValidationLayer,
                                    .enabledExtensionCount = debug_utils ? 1U : 0U,
                                    .ppEnabledExtensionNames = extensions};
  check(global_.CreateInstance(&create, nullptr, &handle_), "creating a Vulkan instance");
  try {
    api_ = InstanceApi::load(global_.GetInstanceProcAddr, handle_);
    if (!settings.validation) return;
    messages_ = std::make_unique<Messages>();
    const VkDebugUtilsMessengerCreateInfoEXT messenger{
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = Messages::add,
        .pUserData = messages_.get()};
    check(api_.CreateDebugUtilsMessengerEXT(handle_, &messenger, nullptr, &messenger_), "listening to validation");
  } catch (...) {
    destroy();
    throw;
  }
}

Instance::~Instance() { destroy(); }

void Instance::destroy() {
  if (messenger_) api_.DestroyDebugUtilsMessengerEXT(handle_, messenger_, nullptr);
  if (api_.DestroyInstance) api_.DestroyInstance(handle_, nullptr);
}

std::vector<std::string> Instance::validationMessages() const {
  if (!messages_) return {};
  const std::lock_guard lock(messages_->guard);
  return messages_->texts;
}

}  // namespace nephroid::gpu
