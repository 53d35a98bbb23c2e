#include "frame/view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "frame/cube.shared.h"
#include "trace/camera_model.h"

namespace nephroid {
namespace {

Camera makeTestCamera(float ortho_height) {
  return makeCamera("test", vec3(0.4F, 1.1F, 2.0F), vec3(-0.1F, 0.2F, 0.0F), 0.7F, ortho_height);
}

Bounds makeBounds() {
  Bounds bounds;
  bounds.add(vec3(-1));
  bounds.add(vec3(1));
  return bounds;
}

vec4 toClip(const ViewRecord& view, vec3 point) {
  const vec4 p(point, 1.0F);
  return {dot(view.clip_row_x, p), dot(view.clip_row_y, p), dot(view.clip_row_z, p), dot(view.clip_row_w, p)};
}

/// Where a view shows a point, in pixels from the upper left corner.
vec2 toPixels(const ViewRecord& view, vec3 point, int width, int height) {
  const vec4 clip = toClip(view, point);
  return (vec2(clip.x, clip.y) / clip.w * 0.5F + 0.5F) * vec2(static_cast<float>(width), static_cast<float>(height));
}

TEST(View, ShowsPointsWhereTheCamerasRaysPass) {
  constexpr int kWidth = 64, kHeight = 48;
  for (const float ortho_height : {0.0F, 1.5F}) {
    const Camera camera = makeTestCamera(ortho_height);
    const CameraModel model(camera, kWidth, kHeight);
    const ViewRecord view = makeCameraView(camera, kWidth, kHeight, makeBounds(), vec2(0.5F));
    for (const vec2 film : {vec2(0.0F), vec2(13.25F, 40.5F), vec2(63.0F, 1.0F)}) {
      const Ray ray = model.rayThrough(film);
      for (const float t : {0.9F, 2.0F, 3.3F}) {
        const vec2 seen = toPixels(view, ray.origin + t * ray.dir, kWidth, kHeight);
        EXPECT_NEAR(seen.x, film.x, 1e-3F);
        EXPECT_NEAR(seen.y, film.y, 1e-3F);
      }
    }
  }
}

TEST(View, MovesThePlaceOfASampleToThePixelsCentre) {
  const Camera camera = makeTestCamera(0.0F);
  const CameraModel model(camera, 64, 48);
  const vec2 offset(0.1F, 0.8F);
  const ViewRecord view = makeCameraView(camera, 64, 48, makeBounds(), offset);
  const Ray ray = model.rayThrough(vec2(20.0F, 30.0F) + offset);
  const vec2 seen = toPixels(view, ray.origin + 2.0F * ray.dir, 64, 48);
  EXPECT_NEAR(seen.x, 20.5F, 1e-3F);
  EXPECT_NEAR(seen.y, 30.5F, 1e-3F);
}

TEST(View, ACubeShowsEveryDirectionOnceAndWhereShadersLook) {
  const vec3 eye(0.3F, -0.2F, 0.1F);
  for (int k = 0; k < 1000; ++k) {
    // Spread over all directions; lengths differ.
    const float height = 1.0F - (2.0F * static_cast<float>(k) + 1.0F) / 1000.0F,
                turn = 2.39996F * static_cast<float>(k);
    const float beside = std::sqrt(1.0F - height * height), far = 0.5F + 0.01F * static_cast<float>(k % 7);
    const vec3 v = far * vec3(beside * std::cos(turn), height, beside * std::sin(turn));
    const CubePlace place = placeOnCube(v);
    ASSERT_LT(place.face, 6U);
    const vec4 clip = toClip(makeCubeView(eye, static_cast<int>(place.face), makeBounds()), eye + v);
    EXPECT_NEAR(place.x, clip.x, 1e-6F) << "face " << place.face;
    EXPECT_NEAR(place.y, clip.y, 1e-6F) << "face " << place.face;
    EXPECT_NEAR(place.depth, clip.w, 1e-6F) << "face " << place.face;
    EXPECT_LE(std::max(std::abs(place.x), std::abs(place.y)), place.depth);
  }
}

TEST(View, KeepsAllBoundsBetweenItsEnds) {
  const Bounds bounds = makeBounds();
  const Camera camera = makeTestCamera(0.0F);
  for (const ViewRecord& view :
       {makeCameraView(camera, 64, 48, bounds, vec2(0.5F)), makeParallelView(normalize(vec3(1, -2, 0.5F)), bounds)})
    for (int corner = 0; corner < 8; ++corner) {
      const vec4 clip =
          toClip(view, vec3((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1));
      EXPECT_GE(clip.z, 0.0F);
      EXPECT_LE(clip.z, clip.w);
    }
}

TEST(View, SixViewsOfACubeShowEveryDirectionOnce) {
  Bounds bounds;
  bounds.add(vec3(-3));
  bounds.add(vec3(3));
  const vec3 eye(0.2F, -0.1F, 0.3F);
  for (const vec3 dir : {vec3(1, 0.2F, -0.3F), vec3(-1, 0.9F, 0.5F), vec3(0.1F, 1, 0), vec3(0.3F, -1, 0.2F),
                         vec3(0.5F, 0.5F, 1), vec3(0.2F, 0.1F, -1)}) {
    int shown = 0;
    for (int face = 0; face < 6; ++face) {
      const vec4 clip = toClip(makeCubeView(eye, face, bounds), eye + 0.7F * dir);
      if (clip.w > 0.0F && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w) ++shown;
    }
    EXPECT_EQ(shown, 1);
  }
}

TEST(View, LeavesOutOnlyWhatItCannotShow) {
  const ViewRecord view = makeCubeView(vec3(0), 0, makeBounds());  // along +x
  const auto shows = [&](vec3 centre) {
    Bounds box;
    box.add(centre - 0.1F);
    box.add(centre + 0.1F);
    return mayShow(view, box);
  };
  EXPECT_TRUE(shows(vec3(1, 0, 0)));
  EXPECT_TRUE(shows(vec3(0.05F, 0, 0)));  // about the eye
  EXPECT_TRUE(shows(vec3(1, 1.05F, 0)));  // across the edge
  EXPECT_FALSE(shows(vec3(-1, 0, 0)));
  EXPECT_FALSE(shows(vec3(0.5F, 1, 0)));
}

TEST(View, AnEmptySceneHasViewsToo) {
  const ViewRecord view = makeParallelView(vec3(0, -1, 0), Bounds());
  EXPECT_TRUE(isFinite(view.eye));
  EXPECT_TRUE(isFinite(makeCubeView(vec3(0), 0, Bounds()).eye));
}

}  // namespace
}  // namespace nephroid
