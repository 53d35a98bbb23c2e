// What the wavelengths of a path weigh, against integrals over the spectrum.
#include "trace/hero_wavelengths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "closed_form/optics.h"
#include "core/optics/dispersion.shared.h"
#include "support/tiny_scenes.h"
#include "trace/trace_scene.h"
#include "trace/walk.h"

namespace nephroid {
namespace {

/// A pane of flint with a wide spectrum, seen along rays at any angle.
class HeroWavelengthsTest : public testing::Test {
 protected:
  HeroWavelengthsTest() : scene_(makeScene()), trace_(scene_), materials_(trace_) {}

  static SceneData makeScene() {
    Material flint = test::makeGlass(1.7F);
    flint.dispersion = 2.0F;
    SceneData scene;
    test::addObject(scene, makeBox("box", dvec3(-1, -1, -1), dvec3(1, 0, 1)), flint);
    return scene;
  }

  /// From above, or from within.
  Encounter meet(double angle, bool from_inside) {
    PathState state;
    const auto x = static_cast<float>(std::sin(angle)), y = static_cast<float>(std::cos(angle));
    state.ray = from_inside ? Ray{vec3(-0.5F * x, -0.5F * y, 0.0F), vec3(x, y, 0.0F)}
                            : Ray{vec3(-0.5F * x, 0.5F * y, 0.0F), vec3(x, -y, 0.0F)};
    if (from_inside) {
      EXPECT_TRUE(crossInterface(state.interior, trace_.solidOf(0), scene_.materials[0], true));
    }
    wo_ = -state.ray.dir;
    Sampler sampler(1, 2, 3);
    Walker(trace_, materials_).advance(state, sampler, encounter_);
    return encounter_;
  }

  /// Textbook reflectance of the face at a wavelength.
  double reflectanceAt(float wavelength_nm, double angle, bool from_inside) const {
    const auto ior = static_cast<double>(dispersiveIor(1.7F, 2.0F, wavelength_nm));
    return closed_form::fresnelReflectance(std::cos(angle), from_inside ? ior : 1.0, from_inside ? 1.0 : ior);
  }

  SceneData scene_;
  TraceScene trace_;
  MaterialTable materials_;
  Encounter encounter_;
  vec3 wo_;
};

constexpr int kSteps = 4000;  // numbers of the hero, evenly spaced: a quadrature

/// A state that drew `u`, as a sampler would have given it.
PathState openAt(float u) {
  PathState state;
  state.wavelength_nm = sampleWavelength(u).wavelength_nm;
  state.hero.open = true;
  state.hero.u = u;
  state.hero.values.fill(vec3(1.0F));
  state.hero.pdfs.fill(1.0F);
  return state;
}

TEST_F(HeroWavelengthsTest, MirroredLightHasTheColourOfAllWavelengths) {
  // A path that is mirrored twice, at angles where reflectance depends on wavelength: a twentieth, from within beyond
  // the critical angle of blue but not of red. A hero of wavelength λ goes this way with probability R₁(λ)·R₂(λ) and
  // then weighs W, so ∫ R₁R₂·W du must be the light's colour ∫ R₁R₂·w du.
  for (const bool from_inside : {false, true}) {
    const double angles[2] = {from_inside ? 0.62 : 1.2, from_inside ? 0.5 : 0.3};
    dvec3 estimated(0.0), expected(0.0), squares(0.0);
    for (int i = 0; i < kSteps; ++i) {
      const float u = (static_cast<float>(i) + 0.5F) / kSteps;
      PathState state = openAt(u);
      double p = 1.0;
      for (const double angle : angles) {
        const Encounter encounter = meet(angle, from_inside);
        followWavelengths(state, encounter, wo_, 0.25F, false);
        p *= reflectanceAt(state.wavelength_nm, angle, from_inside);
      }
      ASSERT_TRUE(state.hero.open);
      estimated += p * dvec3(state.hero.weight) / double{kSteps};
      squares += p * dvec3(state.hero.weight * state.hero.weight) / double{kSteps};
      expected += p * dvec3(sampleWavelength(u).weight) / double{kSteps};
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(estimated[c], expected[c], 2e-4 * expected[c]) << "from inside: " << from_inside;
      // With its own colour alone a path's second moment is three to five times the squared mean; p itself varies.
      if (!from_inside) {
        EXPECT_LT(squares[c], 1.25 * expected[c]) << c;
      }
    }
  }
}

TEST_F(HeroWavelengthsTest, MirroringThatIsFollowedForCertainHasTheMeanOfAllWavelengths) {
  // A path that takes this way for certain carries R(λ), whichever wavelength is the hero: with W it is ¼ Σ R_j·w_j.
  const double angle = 1.2;
  for (float u = 0.01F; u < 1.0F; u += 0.07F) {
    PathState state = openAt(u);
    const Encounter encounter = meet(angle, false);
    followWavelengths(state, encounter, wo_, 0.25F, false, false);
    const dvec3 carried = reflectanceAt(state.wavelength_nm, angle, false) * dvec3(state.hero.weight);
    dvec3 expected(0.0);
    for (int j = 0; j < HeroWavelengths::kCount; ++j) {
      const float turned = u + static_cast<float>(j) / HeroWavelengths::kCount;
      const Band band = sampleWavelength(turned < 1.0F ? turned : turned - 1.0F);
      expected +=
          reflectanceAt(band.wavelength_nm, angle, false) * dvec3(band.weight) / double{HeroWavelengths::kCount};
    }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(carried[c], expected[c], 1e-5) << u;
  }
}

TEST_F(HeroWavelengthsTest, WhatWavelengthsCarryOnAverageDependsOnNoHero) {
  // After one mirroring for certain a wavelength carries R(λ), after one by chance as much as before.
  const double angle = 1.2;
  std::vector<double> carried;
  for (int hero = 0; hero < HeroWavelengths::kCount; ++hero) {
    PathState state = openAt((0.1F + static_cast<float>(hero)) / HeroWavelengths::kCount);
    const Encounter first = meet(angle, false);
    followWavelengths(state, first, wo_, 0.25F, false, false);
    const Encounter second = meet(0.3, false);
    followWavelengths(state, second, wo_, 0.25F, false, true);
    carried.push_back(reflectanceAt(state.wavelength_nm, angle, false) *
                      static_cast<double>(state.hero.meanOverHero()));
  }
  double mean = 0.0;
  for (int j = 0; j < HeroWavelengths::kCount; ++j)
    mean += reflectanceAt(openAt((0.1F + static_cast<float>(j)) / HeroWavelengths::kCount).wavelength_nm, angle, false);
  mean /= HeroWavelengths::kCount;
  for (const double c : carried) EXPECT_NEAR(c, mean, 1e-5 * mean);
}

TEST_F(HeroWavelengthsTest, LightThatIsBentHasTheHerosColour) {
  const Encounter encounter = meet(0.5, false);
  Sampler sampler(5, 6, 7);
  PathState state;
  drawWavelength(state, encounter, {}, sampler);
  ASSERT_TRUE(state.hero.open);
  EXPECT_EQ(state.hero.weight, vec3(1.0F));
  const float u = state.hero.u;
  followWavelengths(state, encounter, wo_, 0.25F, true);
  EXPECT_FALSE(state.hero.open);
  EXPECT_EQ(state.hero.weight, sampleWavelength(u).weight);
  EXPECT_EQ(state.wavelength_nm, sampleWavelength(u).wavelength_nm);
  drawWavelength(state, encounter, {}, sampler);
  EXPECT_EQ(state.hero.u, u);  // one hero for the whole path
}

TEST_F(HeroWavelengthsTest, BandsAreAloneFromTheStart) {
  const Encounter encounter = meet(0.5, false);
  Sampler sampler(5, 6, 7);
  PathState state;
  drawWavelength(state, encounter, {makeBands(3)}, sampler);
  EXPECT_FALSE(state.hero.open);
  EXPECT_NE(state.hero.weight, vec3(1.0F));
}

}  // namespace
}  // namespace nephroid
