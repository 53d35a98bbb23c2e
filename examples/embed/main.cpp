// A tiny Vulkan program of its own: it has an instance, a device, a queue and an image, and nephroid draws into that.
// Usage: embed [SCENE [OUT.ppm]]
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "nephroid/vulkan.h"

namespace {

constexpr std::uint32_t kWidth = 320, kHeight = 240;

void check(VkResult result, const char* what) {
  if (result != VK_SUCCESS) throw std::runtime_error(what);
}

/// What every Vulkan program has. Destroyed in reverse.
struct Program {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t family = 0;
  VkImage image = VK_NULL_HANDLE;
  VkBuffer pixels = VK_NULL_HANDLE;
  VkDeviceMemory image_memory = VK_NULL_HANDLE, pixel_memory = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;

  Program() = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() {
    if (device) {
      vkDeviceWaitIdle(device);
      vkDestroyCommandPool(device, pool, nullptr);
      vkDestroyBuffer(device, pixels, nullptr);
      vkDestroyImage(device, image, nullptr);
      vkFreeMemory(device, pixel_memory, nullptr);
      vkFreeMemory(device, image_memory, nullptr);
      vkDestroyDevice(device, nullptr);
    }
    if (instance) vkDestroyInstance(instance, nullptr);
  }
};

/// The first device that has what nephroid needs, and a queue for graphics and compute.
void openDevice(Program& p) {
  const VkApplicationInfo application{
      VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "embed", 1, nullptr, 0, VK_API_VERSION_1_3};
  VkInstanceCreateInfo instance{};
  instance.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  instance.pApplicationInfo = &application;
  check(vkCreateInstance(&instance, nullptr, &p.instance), "no Vulkan instance");

  nephroid::vulkan::Requirements needed;
  std::uint32_t count = 0;
  vkEnumeratePhysicalDevices(p.instance, &count, nullptr);
  std::vector<VkPhysicalDevice> all(count);
  vkEnumeratePhysicalDevices(p.instance, &count, all.data());
  for (const VkPhysicalDevice candidate : all)
    if (!p.physical && needed.missing(vkGetInstanceProcAddr, p.instance, candidate).empty()) p.physical = candidate;
  if (!p.physical) throw std::runtime_error("no device has what nephroid needs");

  vkGetPhysicalDeviceQueueFamilyProperties(p.physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(p.physical, &count, families.data());
  constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  while (p.family + 1 < count && (families[p.family].queueFlags & kBoth) != kBoth) ++p.family;

  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = p.family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  const std::vector<const char*> extensions = needed.extensions();
  VkDeviceCreateInfo device{};
  device.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  device.pNext = needed.features();
  device.queueCreateInfoCount = 1;
  device.pQueueCreateInfos = &queue;
  device.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  device.ppEnabledExtensionNames = extensions.data();
  check(vkCreateDevice(p.physical, &device, nullptr, &p.device), "no Vulkan device");
  vkGetDeviceQueue(p.device, p.family, 0, &p.queue);
}

VkDeviceMemory allocate(const Program& p, const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(p.physical, &memory);
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, 0};
  while ((needs.memoryTypeBits >> info.memoryTypeIndex & 1U) == 0 ||
         (memory.memoryTypes[info.memoryTypeIndex].propertyFlags & wanted) != wanted)
    if (++info.memoryTypeIndex == memory.memoryTypeCount) throw std::runtime_error("no such memory");
  VkDeviceMemory allocated = VK_NULL_HANDLE;
  check(vkAllocateMemory(p.device, &info, nullptr, &allocated), "out of memory");
  return allocated;
}

/// An image for the picture, and a buffer to look at it.
void makeImages(Program& p) {
  VkImageCreateInfo image{};
  image.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  image.imageType = VK_IMAGE_TYPE_2D;
  image.format = VK_FORMAT_R8G8B8A8_SRGB;
  image.extent = {kWidth, kHeight, 1};
  image.mipLevels = image.arrayLayers = 1;
  image.samples = VK_SAMPLE_COUNT_1_BIT;
  image.usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  check(vkCreateImage(p.device, &image, nullptr, &p.image), "no image");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(p.device, p.image, &needs);
  p.image_memory = allocate(p, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  check(vkBindImageMemory(p.device, p.image, p.image_memory, 0), "no memory for the image");

  VkBufferCreateInfo buffer{};
  buffer.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  buffer.size = VkDeviceSize{4} * kWidth * kHeight;
  buffer.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  check(vkCreateBuffer(p.device, &buffer, nullptr, &p.pixels), "no buffer");
  vkGetBufferMemoryRequirements(p.device, p.pixels, &needs);
  p.pixel_memory = allocate(p, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  check(vkBindBufferMemory(p.device, p.pixels, p.pixel_memory, 0), "no memory for the buffer");
}

/// The program's own commands on the same queue: they run after nephroid's.
std::vector<unsigned char> readImage(Program& p) {
  const VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, p.family};
  check(vkCreateCommandPool(p.device, &pool, nullptr, &p.pool), "no command pool");
  const VkCommandBufferAllocateInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, p.pool,
                                           VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(p.device, &buffer, &commands), "no command buffer");
  const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                       VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
  check(vkBeginCommandBuffer(commands, &begin), "cannot record");
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {kWidth, kHeight, 1};
  vkCmdCopyImageToBuffer(commands, p.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, p.pixels, 1, &region);
  check(vkEndCommandBuffer(commands), "cannot record");
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  check(vkQueueSubmit(p.queue, 1, &submit, VK_NULL_HANDLE), "cannot submit");
  check(vkQueueWaitIdle(p.queue), "the device was lost");
  void* mapped = nullptr;
  check(vkMapMemory(p.device, p.pixel_memory, 0, VK_WHOLE_SIZE, 0, &mapped), "cannot map");
  std::vector<unsigned char> bytes(std::size_t{4} * kWidth * kHeight);
  std::memcpy(bytes.data(), mapped, bytes.size());
  vkUnmapMemory(p.device, p.pixel_memory);
  return bytes;
}

void writePpm(const char* path, const std::vector<unsigned char>& rgba) {
  std::FILE* file = std::fopen(path, "wb");
  if (!file) throw std::runtime_error("cannot write the picture");
  std::fprintf(file, "P6\n%u %u\n255\n", kWidth, kHeight);
  for (std::size_t i = 0; i < rgba.size(); i += 4) std::fwrite(&rgba[i], 1, 3, file);
  if (std::fclose(file) != 0) throw std::runtime_error("cannot write the picture");
}

void run(const char* source, const char* path) {
  Program p;
  openDevice(p);
  makeImages(p);

  nephroid::Scene scene = nephroid::Scene::load(source);
  const nephroid::vulkan::Device device{vkGetInstanceProcAddr, p.instance, p.physical, p.device, p.queue, p.family};
  nephroid::vulkan::Renderer renderer(device, scene);
  // The image is left where the program's own commands want it.
  const nephroid::vulkan::Image image{p.image, VK_FORMAT_R8G8B8A8_SRGB, kWidth, kHeight,
                                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
  nephroid::vulkan::PictureSettings settings;
  settings.samples = 16;
  settings.filmic = true;
  renderer.drawPicture(image, settings);
  writePpm(path, readImage(p));
  for (const nephroid::vulkan::PassTime& pass : renderer.passTimes())
    std::printf("%-18s %7.3f ms\n", pass.name.c_str(), pass.ms);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc > 1 ? argv[1] : "builtin:ring", argc > 2 ? argv[2] : "embed.ppm");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
