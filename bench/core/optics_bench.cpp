// The optics that C++ and GLSL share: what every event of every path computes.
#include <benchmark/benchmark.h>

#include "core/optics/absorption.shared.h"
#include "core/optics/dispersion.shared.h"
#include "core/optics/fresnel.shared.h"
#include "core/optics/microfacet.shared.h"
#include "core/optics/photon.shared.h"
#include "core/optics/ray_differential.shared.h"
#include "core/optics/refraction.shared.h"
#include "support/inputs.h"

namespace nephroid::bench {
namespace {

/// From air into glass, and from glass into air, where some of it is beyond the critical angle.
constexpr float kIntoGlass = 1.0F / 1.5F, kOutOfGlass = 1.5F;
constexpr vec3 kNormal(0, 0, 1);

/// Calls `function(dir)` with unit vectors of the hemisphere about +Z.
template <class Function>
void overHemisphere(benchmark::State& state, const Function& function) {
  Cycle<vec3> dirs(makeHemisphereDirs());
  for (auto _ : state) {
    auto result = function(dirs.next());
    benchmark::DoNotOptimize(result);
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(overHemisphere, fresnel_dielectric, [](vec3 w) {
  return fresnelDielectric(w.z, kIntoGlass);
})->Name("Optics/fresnelDielectric");
BENCHMARK_CAPTURE(overHemisphere, fresnel_schlick, [](vec3 w) {
  return fresnelSchlick(w.z, vec3(0.9F, 0.6F, 0.3F));
})->Name("Optics/fresnelSchlick");
BENCHMARK_CAPTURE(overHemisphere, fresnel_conductor, [](vec3 w) {
  return fresnelConductor(w.z, vec3(0.2F, 0.9F, 1.1F), vec3(3.9F, 2.4F, 2.2F));
})->Name("Optics/fresnelConductor");
BENCHMARK_CAPTURE(overHemisphere, reflect, [](vec3 w) { return reflectDir(-w, kNormal); })->Name("Optics/reflectDir");
BENCHMARK_CAPTURE(overHemisphere, refract_in, [](vec3 w) {
  return refractDir(-w, kNormal, kIntoGlass);
})->Name("Optics/refractDir/into_glass");
BENCHMARK_CAPTURE(overHemisphere, refract_out, [](vec3 w) {
  return refractDir(-w, kNormal, kOutOfGlass);
})->Name("Optics/refractDir/out_of_glass");
BENCHMARK_CAPTURE(overHemisphere, dispersion, [](vec3 w) {
  return dispersiveIor(1.5F, 0.3F, 400.0F + 300.0F * w.z);
})->Name("Optics/dispersiveIor");
BENCHMARK_CAPTURE(overHemisphere, transmittance, [](vec3 w) {
  return transmittance(vec3(0.1F, 0.5F, 2.0F), w.z);
})->Name("Optics/transmittance");
BENCHMARK_CAPTURE(overHemisphere, refract_differential, [](vec3 w) {
  const RayDifferential r{vec3(1e-3F, 0, 0), vec3(0, 1e-3F, 0), vec3(1e-4F, 0, 0), vec3(0, 1e-4F, 0), true};
  const NormalDifferential dn{vec3(1e-3F, 0, 0), vec3(0, 1e-3F, 0)};
  return refractDifferential(r, -w, kNormal, dn, kIntoGlass);
})->Name("Optics/refractDifferential");
BENCHMARK_CAPTURE(overHemisphere, footprint, [](vec3 w) {
  return setPhotonFootprint(Photon{}, vec3(w.x, 0.1F, 0), vec3(0, w.y, 0), kNormal);
})->Name("Optics/setPhotonFootprint");

/// Microfacet functions of two directions, at a width in the middle of what glass and metal have.
template <class Function>
void overFacets(benchmark::State& state, const Function& function) {
  Cycle<vec3> dirs(makeHemisphereDirs());
  Cycle<vec2> points(makeSquarePoints());
  for (auto _ : state) {
    auto result = function(dirs.next(), points.next(), 0.2F);
    benchmark::DoNotOptimize(result);
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(overFacets, sample, [](vec3 wo, vec2 u, float alpha) {
  return sampleGgxVndf(wo, alpha, u);
})->Name("Ggx/sample");
BENCHMARK_CAPTURE(overFacets, pdf, [](vec3 wo, vec2 u, float alpha) {
  return pdfGgxVndf(wo, vec3(0.6F * u.x, 0.0F, 0.8F), alpha);
})->Name("Ggx/pdf");
BENCHMARK_CAPTURE(overFacets, masking, [](vec3 wo, vec2 u, float alpha) {
  return ggxG2(vec3(0.6F * u.x, 0.0F, 0.8F), wo, alpha);
})->Name("Ggx/masking");

}  // namespace
}  // namespace nephroid::bench
