#include "trace/hero_wavelengths.h"

#include <algorithm>
#include <cmath>

#include "trace/bsdf.h"
#include "trace/walk.h"

namespace nephroid {
namespace {

Band rotate(float u, int steps) {
  const float turned = u + static_cast<float>(steps) / HeroWavelengths::kCount;
  return sampleWavelength(turned < 1.0F ? turned : turned - 1.0F);
}

/// Channels without light stay without.
vec3 divide(vec3 a, vec3 b) {
  vec3 ratio(0.0F);
  for (int c = 0; c < 3; ++c)
    if (b[c] > 0.0F) ratio[c] = a[c] / b[c];
  return ratio;
}

}  // namespace

void drawWavelength(PathState& state, const Encounter& encounter, const SpectralMode& mode, Sampler& sampler) {
  if (state.wavelength_nm != 0.0F || !isDispersive(encounter.boundary)) return;
  HeroWavelengths& hero = state.hero;
  hero.u = sampler.next1D();
  if (!mode.bands.empty()) {
    const auto count = static_cast<float>(mode.bands.size());
    const Band& band = mode.bands[std::min(static_cast<std::size_t>(hero.u * count), mode.bands.size() - 1)];
    state.wavelength_nm = band.wavelength_nm;
    hero.weight = band.weight * count;
    return;
  }
  state.wavelength_nm = sampleWavelength(hero.u).wavelength_nm;
  hero.open = true;
  hero.values.fill(vec3(1.0F));
  hero.pdfs.fill(1.0F);
}

void settleWavelength(PathState& state, const Encounter& encounter) {
  if (!state.hero.open || !isDispersive(encounter.boundary)) return;
  state.hero.open = false;
  state.hero.weight = sampleWavelength(state.hero.u).weight;
}

float HeroWavelengths::meanOverHero() const {
  float sum = 0.0F;
  for (int j = 0; j < kCount; ++j)
    if (pdfs[j] > 0.0F) sum += maxComponent(values[j]) / pdfs[j];
  return sum / kCount;
}

void followWavelengths(PathState& state, const Encounter& encounter, vec3 wo, float specular_alpha, bool transmitted,
                       bool by_chance) {
  HeroWavelengths& hero = state.hero;
  if (!hero.open || !isDispersive(encounter.boundary)) return;
  if (transmitted) {
    settleWavelength(state, encounter);
    return;
  }
  std::array<Bsdf::Mirroring, HeroWavelengths::kCount> mirrored;
  vec3 sum(0.0F);
  float pdf_sum = 0.0F;
  for (int j = 0; j < HeroWavelengths::kCount; ++j) {
    const Band band = rotate(hero.u, j);
    mirrored[j] = Bsdf(*encounter.material, encounter.point, wo, iorOf(encounter.boundary.from, band.wavelength_nm),
                       iorOf(encounter.boundary.to, band.wavelength_nm), specular_alpha)
                      .mirroring();
    hero.values[j] *= divide(mirrored[j].reflectance, mirrored[0].reflectance);
    if (by_chance) hero.pdfs[j] *= mirrored[j].probability / mirrored[0].probability;
    sum += band.weight * hero.values[j];
    pdf_sum += hero.pdfs[j];
  }
  hero.weight = sum / pdf_sum;
}

}  // namespace nephroid
