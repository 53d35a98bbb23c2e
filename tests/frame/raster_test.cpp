// The rasteriser in compute against a search through all triangles in double precision, and against the hardware's.
#include "frame/raster.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "frame/frame.h"
#include "frame/view.h"
#include "scene/builtin/builtin.h"
#include "scene/load.h"
#include "support/gpu_fixture.h"
#include "support/tiny_scenes.h"

namespace nephroid {
namespace {

/// Triangles that pass a pixel's centre by less than this many pixels may be seen there or not: corners are rounded.
constexpr double kEdge = 0.004;

/// What one triangle does at pixels' centres, without any clipping: linear over the film.
struct ExactTriangle {
  dvec3 edges[3];  ///< pixels from each edge, > 0 inside: dot(edge, (x, y, 1))
  dvec3 depth;     ///< 1 near to 0 far
  bool valid;

  ExactTriangle(const ViewRecord& view, const dvec3 (&corners)[3], int width, int height) {
    dvec3 p[3];
    double z[3];
    for (int k = 0; k < 3; ++k) {
      const glm::dvec4 corner(corners[k], 1.0);
      const double w = dot(glm::dvec4(view.clip_row_w), corner);
      p[k] = {0.5 * width * (dot(glm::dvec4(view.clip_row_x), corner) + w) - 0.5 * w,
              0.5 * height * (dot(glm::dvec4(view.clip_row_y), corner) + w) - 0.5 * w, w};
      z[k] = dot(glm::dvec4(view.clip_row_z), corner);
    }
    const double volume = dot(p[0], cross(p[1], p[2]));
    valid = volume != 0.0;
    depth = dvec3(0.0);
    for (int k = 0; k < 3; ++k) {
      const dvec3 plane = cross(p[(k + 1) % 3], p[(k + 2) % 3]);
      depth += plane * (z[k] / volume);
      edges[k] = (volume < 0.0 ? -1.0 : 1.0) / std::hypot(plane.x, plane.y) * plane;
    }
  }
  double insideAt(dvec3 pixel) const {
    return std::min({dot(edges[0], pixel), dot(edges[1], pixel), dot(edges[2], pixel)});
  }
  double depthAt(dvec3 pixel) const { return dot(depth, pixel); }
  /// By how much the depth may be off where the triangle only passes by.
  double depthError(dvec3 pixel) const {
    return 2e-5 * std::abs(depthAt(pixel)) + 1e-7 + 2.0 * kEdge * (std::abs(depth.x) + std::abs(depth.y));
  }
};

class RasterTest : public testing::GpuTest {
 protected:
  /// Instance + 1 and triangle of each pixel, all drawn in compute; row 0 on top.
  static std::vector<glm::uvec2> drawComputed(const SceneData& scene, const ViewRecord& view, int width, int height) {
    gpu::CommandRecorder recorder(device());
    recorder.begin();
    const SceneBuffers buffers(device(), recorder, scene, 0.25F);
    ComputeRaster raster(device(), recorder, buffers, width, height);
    const auto w = static_cast<std::uint32_t>(width), h = static_cast<std::uint32_t>(height);
    const gpu::Image seen(device(),
                          {.format = VK_FORMAT_R32G32_UINT,
                           .width = w,
                           .height = h,
                           .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT},
                          "seen");
    const gpu::Image depth(device(),
                           {.format = VK_FORMAT_D32_SFLOAT,
                            .width = w,
                            .height = h,
                            .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT},
                           "depth");
    recorder.pass("clear", {{seen, gpu::Access::kColorTarget, true}, {depth, gpu::Access::kDepthTarget, true}},
                  [&](gpu::PassCommands& commands) {
                    commands.beginRendering({.colors = {{.image = seen}}, .depth = &depth});
                    commands.endRendering();
                  });
    const DrawSplit split = splitDraws(view, buffers.draws(), w * h, Rasteriser::kCompute);
    if (!split.compute.empty()) raster.record(recorder, view, split.compute, seen, depth);
    recorder.submit();
    recorder.wait();
    const std::vector<std::byte> bytes = gpu::readBack(device(), seen);
    std::vector<glm::uvec2> pairs(bytes.size() / sizeof(glm::uvec2));
    std::memcpy(static_cast<void*>(pairs.data()), bytes.data(), bytes.size());
    return pairs;
  }

  /// That each pixel sees the nearest of all triangles: exactly, but where an edge is closer than kEdge.
  /// @return pixels that see something
  static int expectSeesNearest(const SceneData& scene, const Camera& camera, int width, int height, vec2 offset) {
    const ViewRecord view = makeCameraView(camera, width, height, scene.bounds(), offset);
    const std::vector<glm::uvec2> seen = drawComputed(scene, view, width, height);
    std::vector<std::vector<ExactTriangle>> exact;
    for (const Instance& instance : scene.instances) {
      std::vector<ExactTriangle>& triangles = exact.emplace_back();
      const Mesh& mesh = scene.meshes[instance.mesh];
      const auto place = [&](std::uint32_t v) {
        return dvec3(transformPoint(instance.world_from_object, mesh.positions[v]));
      };
      for (const uvec3& t : mesh.triangles) {
        const dvec3 corners[3] = {place(t.x), place(t.y), place(t.z)};
        triangles.emplace_back(view, corners, width, height);
      }
    }
    int covered = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const dvec3 pixel(x, y, 1.0);
        double nearest = 0.0;
        for (const auto& triangles : exact)
          for (const ExactTriangle& t : triangles)
            if (t.valid && t.insideAt(pixel) > kEdge && t.depthAt(pixel) < 1.0 - 1e-5)
              nearest = std::max(nearest, t.depthAt(pixel) - t.depthError(pixel));
        const glm::uvec2 name = seen[static_cast<std::size_t>(y) * width + x];
        if (name.x == 0) {
          EXPECT_EQ(nearest, 0.0) << "a hole at " << x << ", " << y;
          continue;
        }
        ++covered;
        const ExactTriangle& t = exact[name.x - 1][name.y];
        EXPECT_GT(t.insideAt(pixel), -kEdge) << x << ", " << y;
        EXPECT_GE(t.depthAt(pixel) + t.depthError(pixel), nearest) << x << ", " << y;
        EXPECT_LT(t.depthAt(pixel) - t.depthError(pixel), 1.0 + 1e-5) << x << ", " << y;
      }
    return covered;
  }
};

/// Triangles of all sizes, anywhere in a ball about the origin.
Mesh makeSoup(int count, float size, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  const auto point = [&] { return vec3(uniform(random), uniform(random), uniform(random)); };
  Mesh mesh;
  mesh.name = "soup";
  for (int i = 0; i < count; ++i) {
    const vec3 middle = point();
    const float scale = size * std::pow(0.5F * (uniform(random) + 1.0F), 3.0F);
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(middle + scale * point());
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

/// The soup, and once more mirrored, stretched and turned.
SceneData makeSoupScene(int count, float size) {
  SceneData scene;
  test::addObject(scene, makeSoup(count, size, 1), test::makeDiffuse(vec3(0.5F)));
  test::addObject(scene, makeSoup(count, size, 2), test::makeDiffuse(vec3(0.5F)),
                  mat4(-0.6F, 0.3F, 0, 0, 0.2F, 0.9F, 0.1F, 0, 0, -0.2F, 1.1F, 0, 0.3F, 0, 0.1F, 1));
  return scene;
}

TEST_F(RasterTest, SeesTheNearestTriangle) {
  const SceneData scene = makeSoupScene(150, 1.0F);
  for (const float ortho_height : {0.0F, 2.0F})
    for (const vec2 offset : {vec2(0.5F), vec2(0.07F, 0.91F)}) {
      const Camera camera = makeCamera("far", vec3(0.5F, 1, 4), vec3(0), 0.6F, ortho_height);
      EXPECT_GT(expectSeesNearest(scene, camera, 80, 60, offset), 500);
    }
}

TEST_F(RasterTest, SeesTheNearestFromAmongTheTriangles) {
  // Large ones all about the eye: they pass beside it, behind it, and through the near end.
  const SceneData scene = makeSoupScene(150, 3.0F);
  for (const vec3 target : {vec3(1, 0.2F, 0), vec3(-1, 0, 0.4F), vec3(0, -1, 0.1F)})
    EXPECT_GT(
        expectSeesNearest(scene, makeCamera("within", vec3(0.03F, 0.01F, 0.02F), target, 1.2F), 80, 60, vec2(0.5F)),
        4000);
}

TEST_F(RasterTest, SeesTrianglesSmallerThanPixels) {
  SceneData scene;
  test::addObject(scene, makeSphere("ball", dvec3(0), 1.0, 200), test::makeDiffuse(vec3(0.5F)));
  EXPECT_GT(expectSeesNearest(scene, makeCamera("eye", vec3(0, 1, 4), vec3(0), 0.6F), 40, 30, vec2(0.5F)), 300);
}

TEST_F(RasterTest, NothingIsSeenBeforeTheNearEnd) {
  // The view begins at 4e-4 m; a triangle leans through that distance before a wall at 4 m.
  SceneData scene;
  test::addObject(scene, makeRectangle("wall", dvec3(0, 0, -4), dvec3(1, 0, 0), dvec3(0, 1, 0)),
                  test::makeDiffuse(vec3(0.5F)));
  Mesh mesh;
  mesh.name = "leaning";
  mesh.positions = {vec3(-2e-4F, -2e-4F, -2e-4F), vec3(2e-4F, -2e-4F, -2e-4F), vec3(0, 1e-4F, -8e-4F)};
  mesh.triangles = {uvec3(0, 1, 2)};
  test::addObject(scene, mesh, test::makeDiffuse(vec3(0.5F)));
  const Camera camera = makeCamera("eye", vec3(0), vec3(0, 0, -1), 1.0F);
  EXPECT_GT(expectSeesNearest(scene, camera, 80, 60, vec2(0.5F)), 500);
}

TEST_F(RasterTest, OnePixelIsAPicture) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.5F)));
  EXPECT_EQ(expectSeesNearest(scene, makeCamera("eye", vec3(0.2F, 3, 1), vec3(0), 0.6F), 1, 1, vec2(0.5F)), 1);
}

TEST_F(RasterTest, SeesTheFirstOfEquallyNearTriangles) {
  // The same mesh twice, its faces twice again: whichever thread comes first.
  SceneData scene;
  Mesh ball = makeSphere("ball", dvec3(0), 1.0, 64);
  const std::size_t count = ball.triangles.size();
  for (std::size_t i = 0; i < count; ++i) ball.triangles.push_back(ball.triangles[i]);
  test::addObject(scene, ball, test::makeDiffuse(vec3(0.5F)));
  test::addObject(scene, ball, test::makeDiffuse(vec3(0.5F)));
  const ViewRecord view =
      makeCameraView(makeCamera("eye", vec3(0, 1, 4), vec3(0), 0.6F), 200, 150, scene.bounds(), vec2(0.5F));
  const std::vector<glm::uvec2> first = drawComputed(scene, view, 200, 150);
  int covered = 0;
  for (const glm::uvec2 name : first) {
    if (name.x == 0) continue;
    ++covered;
    EXPECT_EQ(name.x, 1U);
    EXPECT_LT(name.y, count);
  }
  EXPECT_GT(covered, 5000);
  for (int run = 0; run < 3; ++run) EXPECT_EQ(drawComputed(scene, view, 200, 150), first);
}

TEST_F(RasterTest, HasRoomForAnyNumberOfLargeTriangles) {
  // Each covers the picture and is cut in 64 parts: more than the list of parts holds. The last is the nearest.
  constexpr int kCount = 3000;
  SceneData scene;
  Mesh stack;
  stack.name = "stack";
  for (int i = 0; i < kCount; ++i) {
    const float z = 1e-4F * static_cast<float>(i);
    stack.positions.insert(stack.positions.end(), {vec3(-9, -9, z), vec3(9, -9, z), vec3(0, 18, z)});
    const auto first = static_cast<std::uint32_t>(3 * i);
    stack.triangles.emplace_back(first, first + 1, first + 2);
  }
  test::addObject(scene, stack, test::makeDiffuse(vec3(0.5F)));
  const ViewRecord view =
      makeCameraView(makeCamera("eye", vec3(0, 0, 4), vec3(0), 0.6F), 64, 64, scene.bounds(), vec2(0.5F));
  for (const glm::uvec2 name : drawComputed(scene, view, 64, 64)) EXPECT_EQ(name, glm::uvec2(1, kCount - 1));
}

/// That two pictures of ids and depths agree but for `allowed` of their pixels, each with a neighbour like it.
void expectSamePicture(RealtimeFrame& frame, RealtimeFrame& other, double allowed) {
  const Image id = frame.readGeometry("id"), depth = frame.readGeometry("depth");
  const Image other_id = other.readGeometry("id"), other_depth = other.readGeometry("depth");
  int different = 0;
  for (int y = 0; y < id.height; ++y)
    for (int x = 0; x < id.width; ++x) {
      // Depths of background are infinite.
      const auto agree = [&](int qx, int qy, double tolerance) {
        const float a = depth.at(x, y)[0], b = other_depth.at(qx, qy)[0];
        return id.at(x, y)[0] == other_id.at(qx, qy)[0] && (a == b || std::abs(a - b) <= tolerance * b);
      };
      if (agree(x, y, 1e-4)) continue;
      ++different;
      bool like_neighbour = false;
      for (int qy = std::max(y - 1, 0); qy <= std::min(y + 1, id.height - 1); ++qy)
        for (int qx = std::max(x - 1, 0); qx <= std::min(x + 1, id.width - 1); ++qx)
          like_neighbour = like_neighbour || agree(qx, qy, 0.02);
      EXPECT_TRUE(like_neighbour) << x << ", " << y;
    }
  EXPECT_LE(different, allowed * id.width * id.height);
}

TEST_F(RasterTest, AgreesWithTheHardware) {
  for (const char* name : {"ring", "sphere", "pool", "cube", "coffee"}) {
    SCOPED_TRACE(name);
    const SceneData scene = loadScene(std::string("builtin:") + name);
    ASSERT_FALSE(scene.cameras.empty());
    const auto makeFrame = [&](Rasteriser rasteriser) {
      return RealtimeFrame(device(), scene, scene.cameras[0],
                           {.width = 320, .height = 240, .shadow_size = 16, .rasteriser = rasteriser});
    };
    RealtimeFrame hardware = makeFrame(Rasteriser::kHardware), compute = makeFrame(Rasteriser::kCompute),
                  mixed = makeFrame(Rasteriser::kAuto);
    // Of 76,800: measured are 0 to 4.
    expectSamePicture(compute, hardware, 2e-4);
    expectSamePicture(mixed, hardware, 2e-4);
  }
}

TEST_F(RasterTest, LeavesNothingForTheNextPicture) {
  SceneData scene;
  test::addObject(scene, makeSphere("ball", dvec3(0), 0.5, 64), test::makeDiffuse(vec3(0.5F)));
  const FrameSettings settings{.width = 160, .height = 120, .rasteriser = Rasteriser::kCompute};
  const Camera near = makeCamera("near", vec3(0, 0.5F, 2), vec3(0), 0.6F);
  const Camera far = makeCamera("far", vec3(0, 1, 5), vec3(0.4F, 0, 0), 0.6F);
  RealtimeFrame moved(device(), scene, near, settings), still(device(), scene, far, settings);
  const Image before = moved.readGeometry("id");
  moved.setCamera(far);
  const Image id = moved.readGeometry("id"), expected = still.readGeometry("id");
  int changed = 0;
  for (int y = 0; y < id.height; ++y)
    for (int x = 0; x < id.width; ++x) {
      EXPECT_EQ(id.at(x, y)[0], expected.at(x, y)[0]) << x << ", " << y;
      changed += before.at(x, y)[0] != expected.at(x, y)[0] ? 1 : 0;
    }
  EXPECT_GT(changed, 1000);
}

TEST_F(RasterTest, AClosedRoomHasNoHoles) {
  // Walls of the hardware's, a floor and a ceiling of so many triangles that they are drawn in compute.
  SceneData scene;
  const dvec3 x(2, 0, 0), y(0, 1, 0), z(0, 0, 2);
  for (const double side : {-1.0, 1.0}) {
    test::addObject(scene, makeRectangle("wall", side * x, y, z), test::makeDiffuse(vec3(0.5F)));
    test::addObject(scene, makeRectangle("wall", side * z, y, x), test::makeDiffuse(vec3(0.5F)));
    const auto flat = [](double, double) { return HeightSample{}; };
    mat4 raised(1.0F);
    raised[3].y = static_cast<float>(side);
    const Mesh floor = makeHeightField("floor", 4.0, 4.0, 100, 100, flat);
    test::addObject(scene, floor, test::makeDiffuse(vec3(0.5F)), raised);
  }
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-0.9F, 0.9F);
  for (const Rasteriser rasteriser : {Rasteriser::kAuto, Rasteriser::kCompute})
    for (int i = 0; i < 8; ++i) {
      const vec3 eye(2.0F * uniform(random), uniform(random), 2.0F * uniform(random));
      const vec3 target(uniform(random), uniform(random), uniform(random));
      RealtimeFrame frame(device(), scene, makeCamera("within", eye, target, 1.3F),
                          {.width = 320, .height = 240, .rasteriser = rasteriser});
      const Image id = frame.readGeometry("id");
      const Image depth = frame.readGeometry("depth");
      int holes = 0;
      for (int py = 0; py < 240; ++py)
        for (int px = 0; px < 320; ++px) holes += std::isfinite(depth.at(px, py)[0]) ? 0 : 1;
      EXPECT_EQ(holes, 0);
    }
}

TEST_F(RasterTest, FineMeshesAreForComputeAndCoarseOnesForHardware) {
  SceneData scene;
  test::addObject(scene, test::makeFloor(4.0), test::makeDiffuse(vec3(0.5F)));
  test::addObject(scene, makeSphere("ball", dvec3(0), 0.5, 200), test::makeDiffuse(vec3(0.5F)));
  gpu::CommandRecorder recorder(device());
  recorder.begin();
  const SceneBuffers buffers(device(), recorder, scene, 0.25F);
  recorder.submit();
  const auto split = [&](int width, int height, Rasteriser rasteriser) {
    const ViewRecord view =
        makeCameraView(makeCamera("eye", vec3(0, 1, 4), vec3(0), 0.6F), width, height, scene.bounds(), vec2(0.5F));
    return splitDraws(view, buffers.draws(), static_cast<std::uint32_t>(width) * static_cast<std::uint32_t>(height),
                      rasteriser);
  };
  EXPECT_EQ(split(640, 480, Rasteriser::kAuto).compute, std::vector<std::size_t>{1});
  EXPECT_EQ(split(640, 480, Rasteriser::kAuto).hardware, std::vector<std::size_t>{0});
  EXPECT_TRUE(split(64000, 48000, Rasteriser::kAuto).compute.empty());
  EXPECT_TRUE(split(640, 480, Rasteriser::kHardware).compute.empty());
  EXPECT_TRUE(split(640, 480, Rasteriser::kCompute).hardware.empty());
}

}  // namespace
}  // namespace nephroid
