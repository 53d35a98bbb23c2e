// Deviation of a prism.
//
// In a plane across the edge, with apex angle A: light enters at i, runs inside at i' (sin i = n sin i'), meets the
// second face at e' = A − i' (the two normals enclose A) and leaves at e, sin e = n sin e'. It was turned by i − i' and
// then by e − e', both towards the base:
//
//   δ(i) = i + asin(n sin(A − asin(sin i / n))) − A.
//
// Light may run either way, so δ as a function of i has the same value at i and at e(i); being convex it is least where
// i = e, hence i' = e' = A/2 and
//
//   δ_min = 2 asin(n sin(A/2)) − A.
//
// The renderer's angle is measured, not asked for: the same beam is caught on the floor with the prism at two heights,
// and the way by which its centre moves per height is the cotangent of its elevation.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "closed_form/plane_picture.h"

namespace nephroid::closed_form {

struct PrismCase {
  double apex_deg = 60.0, ior = 1.5, abbe = 0.0;
  double incidence_deg = 48.6;
  double sun_elevation_deg = 30.0;
};

double prismDeviation(double apex, double incidence, double ior);
double prismMinimumDeviation(double apex, double ior);

/// A beam of 1 mm on the axis of a prism of 40 mm, `height` above the floor. The sun stands at −X. With the prism
/// turned by t from apex up, its lit face looks up by A/2 + t short of −X's opposite, that is, light meets it at t +
/// A/2 − elevation.
SceneData makePrismScene(const PrismCase& c, double height, double floor_size = 4.0);

/// The strip of floor on which the beam of a given elevation lands, give or take some degrees.
PlaneView prismView(double expected_elevation, double height, double width);

/// Centre of the light on the floor along X, m. Bands of wavelength may weigh negative in a channel, so each pixel
/// counts by what it has in all, whatever its sign.
double beamCentre(const PlanePicture& picture, int first_column, int last_column);

/// Lit stretches of the row, as [first, last) columns: each is a beam.
std::vector<std::pair<int, int>> findBeams(const PlanePicture& picture);

/// Deviation of each beam that the floor shows, rad, from the left. @param expected_elevation where to look
/// @return  nothing where the two heights show different numbers of beams
std::vector<double> measureDeviations(const PrismCase& c, double expected_elevation, const PlaneRenderer& render,
                                      const std::vector<std::string>& parameters = {});

/// White light through flint glass (V = 30) in the minimum of the d line, caught so far below that the slit and the
/// places where light leaves the prism, a few millimetres, are lost in a fan of metres: light of wavelength λ lands
/// where a line of its elevation does.
struct FanCase {
  double height = 30.0, width = 4.0;  ///< of the prism above the floor; of the strip of floor that is seen, m
  std::size_t bins = 64;

  PrismCase prism() const;
  SceneData scene() const;
  PlaneView view() const;
};
/// RGB by place along the floor, any scale: Σ over wavelengths of colour times what both faces let through.
std::vector<dvec3> fanIrradiance(const FanCase& c);
/// RGB along the floor, in equal bins over the view.
std::vector<dvec3> binColumns(const PlanePicture& picture, std::size_t bins);
/// Σ|E − E*| / Σ|E*| over bins and channels, both scaled to the same sum.
double relativeColourL1(const std::vector<dvec3>& measured, const std::vector<dvec3>& predicted);

}  // namespace nephroid::closed_form
