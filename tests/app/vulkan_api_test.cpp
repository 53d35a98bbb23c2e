// The public header alone, on a device that the test makes itself; what reads images back is borrowed from src/gpu.
#include "nephroid/vulkan.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "gpu/commands.h"
#include "gpu/device_list.h"
#include "gpu/instance.h"
#include "support/gpu_fixture.h"

namespace nephroid {
namespace {

constexpr std::uint32_t kWidth = 64, kHeight = 48;

/// A device of the caller's: made with what Requirements say and nothing else, or with 64-bit atomics too.
class CallersDevice {
 public:
  CallersDevice(const gpu::Instance& instance, const gpu::DeviceInfo& info, bool int64_atomics = false)
      : api_(instance.api()) {
    vulkan::Requirements requirements;
    if (int64_atomics) {
      auto* vulkan12 = static_cast<VkPhysicalDeviceVulkan12Features*>(requirements.features()->pNext);
      EXPECT_EQ(vulkan12->sType, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
      requirements.features()->features.shaderInt64 = vulkan12->shaderBufferInt64Atomics = VK_TRUE;
      given.int64_atomics = true;
    }
    const std::vector<const char*> extensions = requirements.extensions();
    const float priority = 1.0F;
    const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                        .queueFamilyIndex = info.queue_family,
                                        .queueCount = 1,
                                        .pQueuePriorities = &priority};
    const VkDeviceCreateInfo create{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                    .pNext = requirements.features(),
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queue,
                                    .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                                    .ppEnabledExtensionNames = extensions.data()};
    gpu::check(api_.CreateDevice(info.handle, &create, nullptr, &given.device), "making the caller's device");
    functions_ = gpu::DeviceApi::load(api_.GetDeviceProcAddr, given.device);
    given.get_instance_proc_addr = gpu::GlobalApi::open().GetInstanceProcAddr;
    given.instance = instance.handle();
    given.physical = info.handle;
    given.queue_family = info.queue_family;
    functions_.GetDeviceQueue(given.device, info.queue_family, 0, &given.queue);
  }
  ~CallersDevice() { functions_.DestroyDevice(given.device, nullptr); }
  CallersDevice(const CallersDevice&) = delete;
  CallersDevice& operator=(const CallersDevice&) = delete;

  vulkan::Device given;

 private:
  const gpu::InstanceApi& api_;
  gpu::DeviceApi functions_;
};

class VulkanApi : public testing::GpuTest {
 protected:
  explicit VulkanApi(bool int64_atomics = false)
      : callers_(std::make_unique<CallersDevice>(instance(), info(), int64_atomics)),
        tools_(gpu::ForeignDevice{given().get_instance_proc_addr, given().instance, given().physical, given().device,
                                  given().queue, given().queue_family}) {}

  const vulkan::Device& given() const { return callers_->given; }

  gpu::Image makeImage(VkFormat format, VkImageUsageFlags usage) {
    return {tools_, {.format = format, .width = kWidth, .height = kHeight, .usage = usage}, "caller's"};
  }
  static vulkan::Image describe(const gpu::Image& image, VkImageLayout layout) {
    return {image.handle(), image.desc().format, image.desc().width, image.desc().height, layout};
  }
  /// An image that the library left in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL.
  std::vector<std::byte> readLeft(const gpu::Image& image) {
    image.state() = {.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    return gpu::readBack(tools_, image);
  }
  std::vector<float> readFloats(const gpu::Image& image) {
    const std::vector<std::byte> bytes = readLeft(image);
    std::vector<float> floats(bytes.size() / sizeof(float));
    std::memcpy(floats.data(), bytes.data(), bytes.size());
    return floats;
  }
  /// Fills an image and leaves it in `layout`.
  void fill(const gpu::Image& image, std::span<const std::byte> bytes, VkImageLayout layout) {
    gpu::CommandRecorder recorder(tools_);
    recorder.begin();
    recorder.upload(image, bytes);
    recorder.handOver(image, layout);
    recorder.submit();
    recorder.wait();
  }

  std::unique_ptr<CallersDevice> callers_;
  gpu::Device tools_;
};

RenderRequest requestOf(std::vector<std::string> layers) {
  RenderRequest request;
  request.technique = "none";
  request.width = kWidth;
  request.height = kHeight;
  request.samples = 2;
  request.layers = std::move(layers);
  return request;
}

TEST_F(VulkanApi, DrawsWhatRenderRenders) {
  Scene scene = Scene::load("builtin:ring");
  const Picture expected = render(scene, requestOf({"direct", "specular"}));
  const gpu::Image target = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT, 0);
  vulkan::Renderer renderer(given(), scene);
  for (const char* layer : {"direct", "specular"}) {
    SCOPED_TRACE(layer);
    renderer.sceneChanged(vulkan::Edit::kAnything);
    renderer.drawPicture(describe(target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
                         {.layers = {layer}, .samples = 2, .for_screen = false});
    const std::vector<float> drawn = readFloats(target);
    const LayerView view = expected.layer(layer);
    ASSERT_EQ(drawn.size() / 4, view.pixels.size() / 3);
    for (std::size_t i = 0; i < drawn.size() / 4; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(drawn[4 * i + c], view.pixels[3 * i + c], 1e-6F + 1e-5F * view.pixels[3 * i + c]) << i;
  }
  EXPECT_FALSE(renderer.passTimes().empty());
}

/// On a device that was made with 64-bit atomics.
class VulkanApiWithInt64Atomics : public VulkanApi {
 protected:
  VulkanApiWithInt64Atomics() : VulkanApi(true) {}
};

/// Draws builtin:sphere. @return  whether its mesh was drawn in compute, which is faster on devices that are CPUs
bool drawsInCompute(const vulkan::Device& device, const vulkan::Image& target) {
  Scene scene = Scene::load("builtin:sphere");
  vulkan::Renderer renderer(device, scene);
  renderer.drawPicture(target, {.layers = {"direct"}, .for_screen = false});
  return std::ranges::any_of(renderer.passTimes(),
                             [](const vulkan::PassTime& pass) { return pass.name == "raster triangles"; });
}

TEST_F(VulkanApi, LeavesFineMeshesToTheHardware) {
  const gpu::Image target = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT, 0);
  EXPECT_FALSE(drawsInCompute(given(), describe(target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL)));
}

TEST_F(VulkanApiWithInt64Atomics, DrawsFineMeshesInCompute) {
  const gpu::Image target = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT, 0);
  EXPECT_EQ(drawsInCompute(given(), describe(target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL)), device().isCpu());
}

TEST_F(VulkanApi, ScreensGetTheSamePictureByEitherWayOfCoding) {
  Scene scene = Scene::load("builtin:ring");
  vulkan::Renderer renderer(given(), scene);
  std::vector<std::vector<std::byte>> pictures;
  for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB}) {
    const gpu::Image target = makeImage(format, 0);
    renderer.sceneChanged(vulkan::Edit::kAnything);
    renderer.drawPicture(describe(target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL), {.filmic = true});
    pictures.push_back(readLeft(target));
  }
  int bright = 0;
  for (std::size_t i = 0; i < pictures[0].size(); ++i) {
    ASSERT_NEAR(std::to_integer<int>(pictures[0][i]), std::to_integer<int>(pictures[1][i]), 1) << i;
    if (i % 4 == 3) {
      ASSERT_EQ(std::to_integer<int>(pictures[0][i]), 255);
    }
    bright += i % 4 == 1 && std::to_integer<int>(pictures[0][i]) > 64 ? 1 : 0;
  }
  EXPECT_GT(bright, 500);
}

TEST_F(VulkanApi, FollowsEditsAndViews) {
  Scene scene = Scene::load("builtin:ring");
  vulkan::Renderer renderer(given(), scene);
  const gpu::Image target = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT, 0);
  const auto brightness = [&] {
    renderer.drawPicture(describe(target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL),
                         {.layers = {"direct"}, .for_screen = false});
    const std::vector<float> drawn = readFloats(target);
    double sum = 0.0;
    for (std::size_t i = 0; i < drawn.size(); i += 4) sum += drawn[i];
    return sum;
  };
  const double before = brightness();
  ASSERT_GT(before, 0.0);
  scene.editLight("*:intensity=0");
  renderer.sceneChanged(vulkan::Edit::kLights);
  EXPECT_EQ(brightness(), 0.0);
  scene.editLight("*:intensity=20");
  renderer.sceneChanged(vulkan::Edit::kLights);
  EXPECT_GT(brightness(), 0.0);
  // Away from everything.
  renderer.setView({.eye = {0, 100, 0}, .target = {0, 200, 0}, .up = {0, 0, 1}});
  EXPECT_EQ(brightness(), 0.0);
}

/// Depths and normals of the scene as a caller would have drawn them, by the layers of `render`.
struct CallersPicture {
  std::array<float, 16> clip_from_world;
  std::vector<float> depths, normals;
};

CallersPicture drawFromAbove(Scene& scene) {
  // Parallel rays straight down from y = 1 m, x to the right, z towards the lower edge; 0.4 m high. Depth is y.
  scene.setCamera("eye=0,1,0:target=0,0,0:fov=45:ortho=0.4");
  const Picture picture = render(scene, requestOf({"normal", "position", "id"}));
  const LayerView normal = picture.layer("normal"), position = picture.layer("position"), id = picture.layer("id");
  CallersPicture drawn;
  const float half_width = 0.2F * kWidth / kHeight;
  drawn.clip_from_world = {1 / half_width, 0, 0, 0, 0, 0, 1, 0, 0, 5, 0, 0, 0, 0, 0, 1};
  for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
    const bool there = id.pixels[i] > 0.0F;
    drawn.depths.push_back(there ? position.pixels[3 * i + 1] : 0.0F);
    for (std::size_t c = 0; c < 3; ++c) drawn.normals.push_back(there ? normal.pixels[3 * i + c] : 0.0F);
    drawn.normals.push_back(1.0F);
  }
  return drawn;
}

TEST_F(VulkanApi, IrradianceFallsOnTheCallersSurfaces) {
  // A diffuse ball in the sun. Its direct light is albedo/π times the irradiance, whoever drew the surface; the albedo
  // is a layer, and an index of 1 leaves nothing but the base.
  Scene scene = Scene::load("builtin:sphere?light=sun");
  scene.editMaterial("*:transmission=0,metallic=0,roughness=1,ior=1,baseColor=#808080");
  const CallersPicture drawn = drawFromAbove(scene);
  RenderRequest request = requestOf({"direct", "albedo"});
  request.samples = 1;  // through the pixels' centres, as the caller's picture
  const Picture expected = render(scene, request);
  const LayerView direct = expected.layer("direct"), albedo = expected.layer("albedo");

  constexpr VkImageUsageFlags kRead = VK_IMAGE_USAGE_SAMPLED_BIT;
  const gpu::Image depth = makeImage(VK_FORMAT_D32_SFLOAT, kRead | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  const gpu::Image normal = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT, kRead);
  fill(depth, std::as_bytes(std::span(drawn.depths)), VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
  fill(normal, std::as_bytes(std::span(drawn.normals)), VK_IMAGE_LAYOUT_GENERAL);
  const gpu::Image irradiance = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT, 0);
  const gpu::Image direction = makeImage(VK_FORMAT_R16G16B16A16_SFLOAT, 0);
  const vulkan::Surfaces surfaces{.depth = describe(depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL),
                                  .normal = describe(normal, VK_IMAGE_LAYOUT_GENERAL),
                                  .clip_from_world = drawn.clip_from_world};
  const vulkan::Image mean = describe(direction, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  vulkan::Renderer renderer(given(), scene);
  renderer.drawIrradiance(surfaces, describe(irradiance, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL), &mean);
  // Once more: the images were given back as they came.
  renderer.drawIrradiance(surfaces, describe(irradiance, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL), &mean);
  const std::vector<float> found = readFloats(irradiance);
  int lit = 0, off = 0;
  for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
    const float wanted = direct.pixels[3 * i] * 3.14159265F;
    const float got = found[4 * i] * albedo.pixels[3 * i];
    lit += wanted > 0.0F ? 1 : 0;
    off += std::abs(got - wanted) > 5e-3F * wanted + 1e-3F ? 1 : 0;
  }
  EXPECT_GT(lit, 1000);
  // Edges of shadows.
  EXPECT_LE(off, 20);
  EXPECT_FALSE(readLeft(direction).empty());
}

TEST_F(VulkanApi, RefusesWithOneLineWhatCannotBe) {
  Scene scene = Scene::load("builtin:ring");
  EXPECT_THROW(vulkan::Renderer({}, scene), UsageError);
  EXPECT_THROW(vulkan::Renderer(given(), scene, {.technique = "reference"}), UsageError);
  EXPECT_THROW(vulkan::Renderer(given(), scene, {.technique = "nothing"}), UsageError);
  EXPECT_THROW(vulkan::Renderer(given(), scene, {.parameters = {{"nothing", "1"}}}), UsageError);
  vulkan::Renderer renderer(given(), scene);
  EXPECT_THROW(renderer.setView({.eye = {1, 1, 1}, .target = {1, 1, 1}}), UsageError);
  EXPECT_THROW(renderer.setView({.eye = {0, 0, 0}, .target = {0, 1, 0}}), UsageError);
  EXPECT_THROW(renderer.setView({.vertical_fov_deg = 180.0F}), UsageError);
  EXPECT_THROW(renderer.drawPicture({}), UsageError);
  const gpu::Image image = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT);
  const vulkan::Image target = describe(image, VK_IMAGE_LAYOUT_GENERAL);
  EXPECT_THROW(renderer.drawPicture(describe(image, VK_IMAGE_LAYOUT_UNDEFINED)), UsageError);
  EXPECT_THROW(renderer.drawPicture(target, {.layers = {"depth"}}), UsageError);
  EXPECT_THROW(renderer.drawPicture(target, {.layers = {"nothing"}}), UsageError);
  vulkan::Surfaces surfaces{.depth = target, .normal = target};
  surfaces.normal.width = 7;
  EXPECT_THROW(renderer.drawIrradiance(surfaces, target), UsageError);
  // A matrix of zeros.
  surfaces.normal.width = kWidth;
  EXPECT_THROW(renderer.drawIrradiance(surfaces, target), UsageError);
  EXPECT_THROW(renderer.drawIrradiance(surfaces, {}), UsageError);
  // And goes on; the image must outlive what is drawn to it.
  renderer.drawPicture(target);
  gpu::check(tools_.api().DeviceWaitIdle(tools_.handle()), "waiting");
}

TEST_F(VulkanApi, TellsWhatADeviceLacks) {
  const vulkan::Requirements requirements;
  EXPECT_TRUE(requirements.missing(given().get_instance_proc_addr, given().instance, given().physical).empty());
  EXPECT_EQ(requirements.extensions().size(), 1U);
}

}  // namespace
}  // namespace nephroid
