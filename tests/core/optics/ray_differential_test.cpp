#include "core/optics/ray_differential.shared.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/math.h"
#include "core/optics/refraction.shared.h"

namespace nephroid {
namespace {

// The same events in double precision, for finite differences: a ray is a function of the emission parameters (x, y).
struct Ray {
  dvec3 p, d;
};
using RayFunction = std::function<Ray(double, double)>;

constexpr double kStep = 1e-5;

RayDifferential differentiate(const RayFunction& ray) {
  const auto central = [&](double x, double y, dvec3 Ray::*part) {
    return vec3((ray(x, y).*part - ray(-x, -y).*part) / (2 * kStep));
  };
  return {central(kStep, 0, &Ray::p), central(0, kStep, &Ray::p), central(kStep, 0, &Ray::d),
          central(0, kStep, &Ray::d), true};
}

void expectNear(const vec3& a, const vec3& b, float tolerance) {
  EXPECT_LT(length(a - b), tolerance * (1.0F + length(b)))
      << "(" << a.x << ", " << a.y << ", " << a.z << ") and (" << b.x << ", " << b.y << ", " << b.z << ")";
}
void expectNear(const RayDifferential& a, const RayDifferential& b, float tolerance = 2e-5F) {
  expectNear(a.dp_dx, b.dp_dx, tolerance);
  expectNear(a.dp_dy, b.dp_dy, tolerance);
  expectNear(a.dd_dx, b.dd_dx, tolerance);
  expectNear(a.dd_dy, b.dd_dy, tolerance);
}

/// A pencil that diverges from a small patch: both position and direction change with x and y.
Ray emit(double x, double y) {
  const dvec3 axis(0.3, -1.0, 0.2), right(1.0, 0.3, 0.0), up(0.0, 0.2, 1.0);
  return {dvec3(0.1 * x, 2.0, 0.2 * y), glm::normalize(axis + 0.4 * x * right + 0.3 * y * up)};
}

constexpr std::array<dvec3, 3> kCorners{dvec3(-2, 0.1, -1.5), dvec3(3, -0.2, -1), dvec3(0.5, 0.3, 4)};
const std::array<dvec3, 3> kNormals{glm::normalize(dvec3(-0.2, 1, 0.1)), glm::normalize(dvec3(0.3, 1, -0.1)),
                                    glm::normalize(dvec3(0.1, 1, 0.4))};

dvec3 computeFaceNormal() { return glm::normalize(glm::cross(kCorners[2] - kCorners[0], kCorners[1] - kCorners[0])); }

Ray transfer(Ray ray, dvec3 on_plane, dvec3 n) {
  ray.p += ray.d * (glm::dot(on_plane - ray.p, n) / glm::dot(ray.d, n));
  return ray;
}

dvec3 computeBarycentrics(dvec3 p) {
  const dvec3 n = glm::cross(kCorners[1] - kCorners[0], kCorners[2] - kCorners[0]);
  const double area = glm::dot(n, n);
  return {glm::dot(glm::cross(kCorners[2] - kCorners[1], p - kCorners[1]), n) / area,
          glm::dot(glm::cross(kCorners[0] - kCorners[2], p - kCorners[2]), n) / area,
          glm::dot(glm::cross(kCorners[1] - kCorners[0], p - kCorners[0]), n) / area};
}

dvec3 computeShadingNormal(dvec3 p) {
  const dvec3 b = computeBarycentrics(p);
  return glm::normalize(b.x * kNormals[0] + b.y * kNormals[1] + b.z * kNormals[2]);
}

Ray reflect(Ray ray) {
  const dvec3 n = computeShadingNormal(ray.p);
  ray.d -= 2 * glm::dot(ray.d, n) * n;
  return ray;
}

Ray refract(Ray ray, double ior_ratio) {
  ray.d = glm::refract(ray.d, computeShadingNormal(ray.p), ior_ratio);
  return ray;
}

Ray hitTriangle(double x, double y) { return transfer(emit(x, y), kCorners[0], computeFaceNormal()); }

NormalDifferential differentiateNormal(const RayDifferential& r, dvec3 p) {
  return triangleNormalDifferential(r, vec3(kCorners[0]), vec3(kCorners[1]), vec3(kCorners[2]), vec3(kNormals[0]),
                                    vec3(kNormals[1]), vec3(kNormals[2]), vec3(computeBarycentrics(p)));
}

TEST(RayDifferential, TransferMatchesFiniteDifferences) {
  const Ray start = emit(0, 0), end = hitTriangle(0, 0);
  const float t = static_cast<float>(glm::length(end.p - start.p));
  const auto r = transferDifferential(differentiate(emit), vec3(start.d), t, vec3(computeFaceNormal()));
  EXPECT_TRUE(r.valid);
  expectNear(r, differentiate(hitTriangle));
}

TEST(RayDifferential, TransferStaysInThePlaneOfTheSurface) {
  const Ray start = emit(0, 0), end = hitTriangle(0, 0);
  const float t = static_cast<float>(glm::length(end.p - start.p));
  const vec3 n(computeFaceNormal());
  const auto r = transferDifferential(differentiate(emit), vec3(start.d), t, n);
  EXPECT_NEAR(dot(r.dp_dx, n), 0.0F, 1e-6F);
  EXPECT_NEAR(dot(r.dp_dy, n), 0.0F, 1e-6F);
  // With the shading normal instead, as the thesis allows, the footprint leaves the surface.
  const vec3 shading(computeShadingNormal(end.p));
  EXPECT_GT(std::abs(dot(transferDifferential(differentiate(emit), vec3(start.d), t, shading).dp_dx, n)), 1e-2F);
}

TEST(RayDifferential, TransferDoesNotDependOnTheNormalsSignAndLength) {
  const vec3 dir(emit(0, 0).d), n(computeFaceNormal());
  expectNear(transferDifferential(differentiate(emit), dir, 2, n),
             transferDifferential(differentiate(emit), dir, 2, -3.0F * n), 1e-6F);
}

TEST(RayDifferential, TransferAlongThePlaneIsNotValid) {
  EXPECT_FALSE(transferDifferential(differentiate(emit), vec3(1, 0, 0), 2, vec3(0, 1, 0)).valid);
}

TEST(RayDifferential, TriangleNormalMatchesFiniteDifferences) {
  const auto r = differentiate(hitTriangle);
  const auto dn = differentiateNormal(r, hitTriangle(0, 0).p);
  const auto normalAt = [](double x, double y) {
    const Ray ray = hitTriangle(x, y);
    return Ray{computeShadingNormal(ray.p), ray.d};
  };
  const auto expected = differentiate(normalAt);
  expectNear(dn.dn_dx, expected.dp_dx, 2e-5F);
  expectNear(dn.dn_dy, expected.dp_dy, 2e-5F);
}

TEST(RayDifferential, ReflectionMatchesFiniteDifferences) {
  const Ray hit = hitTriangle(0, 0);
  const auto r = differentiate(hitTriangle);
  const vec3 n(computeShadingNormal(hit.p));
  const auto dn = differentiateNormal(r, hit.p);
  const auto expected = differentiate([](double x, double y) { return reflect(hitTriangle(x, y)); });
  expectNear(reflectDifferential(r, vec3(hit.d), n, dn), expected);
  expectNear(reflectDifferential(r, vec3(hit.d), -n, {-dn.dn_dx, -dn.dn_dy}), expected);
}

TEST(RayDifferential, RefractionMatchesFiniteDifferences) {
  const Ray hit = hitTriangle(0, 0);
  const auto r = differentiate(hitTriangle);
  for (const double ratio : {1 / 1.5, 0.999, 1.0, 1.2}) {
    const auto refracted = refractDifferential(r, vec3(hit.d), vec3(computeShadingNormal(hit.p)),
                                               differentiateNormal(r, hit.p), static_cast<float>(ratio));
    EXPECT_TRUE(refracted.valid);
    expectNear(refracted, differentiate([&](double x, double y) { return refract(hitTriangle(x, y), ratio); }));
  }
}

TEST(RayDifferential, RefractionAtIndexRatioOneChangesNothing) {
  const Ray hit = hitTriangle(0, 0);
  const auto r = differentiate(hitTriangle);
  const auto n = vec3(computeShadingNormal(hit.p));
  expectNear(refractDifferential(r, vec3(hit.d), n, differentiateNormal(r, hit.p), 1.0F), r, 1e-6F);
}

TEST(RayDifferential, RefractionBeyondTheCriticalAngleIsNotValid) {
  const vec3 n(0, 1, 0);
  const auto at = [&](float sine) {
    return refractDifferential(differentiate(emit), vec3(sine, -std::sqrt(1 - sine * sine), 0), n, {vec3(0), vec3(0)},
                               1.5F);
  };
  EXPECT_FALSE(at(0.667F).valid);
  EXPECT_TRUE(at(0.666F).valid);
}

TEST(RayDifferential, PropagatesThroughAWholePath) {
  // Emission, refraction into the triangle's far side, flight to a tilted floor.
  const dvec3 floor_point(0, -3, 0), floor_normal = glm::normalize(dvec3(0.1, 1, -0.2));
  const auto path = [&](double x, double y) {
    return transfer(refract(hitTriangle(x, y), 1 / 1.5), floor_point, floor_normal);
  };
  const Ray start = emit(0, 0), hit = hitTriangle(0, 0), inside = refract(hit, 1 / 1.5), end = path(0, 0);
  auto r = differentiate(emit);
  r = transferDifferential(r, vec3(start.d), static_cast<float>(glm::length(hit.p - start.p)),
                           vec3(computeFaceNormal()));
  r = refractDifferential(r, vec3(hit.d), vec3(computeShadingNormal(hit.p)), differentiateNormal(r, hit.p), 1 / 1.5F);
  r = transferDifferential(r, vec3(inside.d), static_cast<float>(glm::length(end.p - hit.p)), vec3(floor_normal));
  expectNear(r, differentiate(path));
}

TEST(RayDifferential, DegenerateTriangleGivesNoChange) {
  const vec3 p(1, 2, 3), n(0, 1, 0);
  EXPECT_EQ(differentiateTriangleNormal(p, p, p, n, n, n, vec3(1, 0, 0), vec3(1, 0, 0)), vec3(0));
}

}  // namespace
}  // namespace nephroid
