// Where estimates are summed: one plane of doubles per layer, in an order that does not depend on threads.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"
#include "core/math.h"
#include "techniques/reference/eye_passes.h"
#include "techniques/technique.h"

namespace nephroid {

/// The radiance sums of one estimator; absent layers cost nothing.
class FilmPlane {
 public:
  FilmPlane() = default;
  FilmPlane(int width, int height) : values_(static_cast<std::size_t>(width) * height * 3, 0.0) {}
  bool active() const { return !values_.empty(); }
  void add(std::size_t pixel, vec3 value) {
    double* p = values_.data() + 3 * pixel;
    p[0] += value.x, p[1] += value.y, p[2] += value.z;
  }
  dvec3 at(std::size_t pixel) const { return {values_[3 * pixel], values_[3 * pixel + 1], values_[3 * pixel + 2]}; }
  /// All of it, RGB by pixel.
  std::span<double> values() { return values_; }
  void set(std::size_t pixel, dvec3 value) {
    double* p = values_.data() + 3 * pixel;
    p[0] = value.x, p[1] = value.y, p[2] = value.z;
  }

 private:
  std::vector<double> values_;
};

/// Which layers were asked for, as flags, and what follows for the estimators. The error of a layer and its bias
/// need the layer.
struct LayerNeeds {
  explicit LayerNeeds(const std::vector<std::string>& layers);
  bool emission, direct, caustic, specular, indirect, specular_caustic, irradiance, irradiance_caustic, beauty;
  bool caustic_bias, specular_caustic_bias;
  bool geometry;  ///< any of albedo, normal, position, depth, id
  /// The same without caustics, seen directly or through specular surfaces, on their own.
  LayerNeeds withoutCaustics() const {
    LayerNeeds rest = *this;
    rest.caustic = rest.irradiance_caustic = rest.specular_caustic = false;
    rest.caustic_bias = rest.specular_caustic_bias = false;
    return rest;
  }
  bool anyIrradiance() const { return irradiance || irradiance_caustic; }
  /// Must paths from the eye go on after a first diffuse event?
  bool beyondDiffuse() const { return indirect || irradiance; }
  /// Must paths from the eye follow a first specular event?
  bool throughSpecular() const { return specular || specular_caustic || specular_caustic_bias; }
  /// What paths from the eye must be traced for.
  /// @param caustics_from_eye  those that are seen directly as well
  bool eyeTraced(bool caustics_from_eye) const {
    const bool caustics_too = caustics_from_eye && (caustic || irradiance_caustic);
    return emission || direct || indirect || irradiance || throughSpecular() || caustics_too;
  }
  /// What photons must be traced for.
  bool lightTraced() const { return caustic || indirect || irradiance || irradiance_caustic; }
};

/// Sums of the estimators, and the pictures they make.
struct Film {
  Film(int width, int height, const LayerNeeds& needs);
  int width, height;
  // From the eye, to be divided by the samples per pixel.
  FilmPlane emission, direct, caustic_from_eye, specular, indirect_from_eye, specular_caustic, caustic_bias,
      specular_caustic_bias, irradiance_from_eye, irradiance_caustic_from_eye;
  // From the lights, to be divided by the number of batches.
  FilmPlane caustic, indirect, irradiance, irradiance_caustic;

  /// Every plane, in a fixed order.
  template <class Visit>
  void visitPlanes(const Visit& visit) {
    for (FilmPlane* plane : {&emission, &direct, &caustic_from_eye, &specular, &indirect_from_eye, &specular_caustic,
                             &caustic_bias, &specular_caustic_bias, &irradiance_from_eye, &irradiance_caustic_from_eye,
                             &caustic, &indirect, &irradiance, &irradiance_caustic})
      visit(*plane);
  }
};

/// The sums that make one layer; a null or inactive plane adds nothing.
struct LayerPlanes {
  const FilmPlane* from_eye;
  const FilmPlane* from_lights;
};
/// What sums of a film are divided by.
struct FilmCounts {
  const EyePasses& passes;
  std::uint64_t batches = 0;  ///< of photons
};
/// From sums to the picture of one layer that is sampled.
Image developLayer(const Film& film, std::string_view layer, const FilmCounts& counts);

/// Of a layer that is sampled, or of all that `beauty` is the sum of, in the order of layerInfos(); none for geometry.
std::vector<LayerPlanes> planesOf(const Film& film, std::string_view layer);

}  // namespace nephroid
