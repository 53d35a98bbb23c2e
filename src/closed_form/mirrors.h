// Curved mirrors: the paraboloid, which has a focus, and the sphere, which has none.
//
// Paraboloid y = r²/(4f), light along −y. At r the normal is tilted by β, tan β = r/(2f), so the reflected ray is
// turned by 2β from +y towards the axis, and tan 2β = 2 tan β/(1 − tan² β) = r/(f − r²/(4f)): it passes through (0, f),
// for every r. All the light that the mirror takes up, less what the metal absorbs, is on a receiver of any size about
// the focus:
//
//   Φ = ∫ E⊥ ρ(cos β) dA⊥,   cos β = 1/√(1 + r²/(4f²)).
//
// Sphere of radius R about the origin, concave upwards, its lowest point at −R. At h the normal is tilted by α, sin α =
// h/R, the reflected ray makes 2α with +y. In the triangle of centre, mirror point and crossing the base angles are
// both α and the base is R, so it crosses the axis at the distance R/(2 cos α) below the centre:
//
//   s(h) = R − R/(2 cos α)  above the lowest point, R/2 for h → 0 (the paraxial focus), less farther out.
//
// On a plane at the height p above the lowest point the ring h lands at r(h) = (s − p) tan 2α (negative: beyond the
// axis).
#pragma once

#include <cstddef>
#include <vector>

#include "closed_form/plane_picture.h"

namespace nephroid::closed_form {

struct ParaboloidCase {
  double focal_length = 1.0, reflectance = 0.8;
  double x0 = 0.2, x1 = 1.2, half_z = 0.5;  ///< an off-axis rectangle, so that the receiver shades nothing of it
  double receiver = 0.02;                   ///< side of the square receiver about the focus
};

double paraboloidFlux(const ParaboloidCase& c);

SceneData makeParaboloidScene(const ParaboloidCase& c, int cells);

/// The receiver's lower face.
PlaneView receiverView(double height, double width, int pixels);

struct SphericalMirrorCase {
  double radius = 1.0, h0 = 0.03, h1 = 0.5;  ///< the zone from h0 to h1 about the axis
  double plane = 0.5;                        ///< of the receiver, above the lowest point
  double receiver_radius = 0.03;
};

double sphericalCrossing(double radius, double h);
double sphericalLanding(const SphericalMirrorCase& c, double h);

/// E / E⊥ in rings on the receiver, which shades the mirror's middle.
std::vector<double> sphericalIrradiance(const SphericalMirrorCase& c, std::size_t bins);

/// A perfect mirror: the zone of the sphere about (0, R, 0), facing up, and a round receiver above it.
SceneData makeSphericalMirrorScene(const SphericalMirrorCase& c, int rows, int segments);

/// Where the light of a narrow zone at h crosses the axis of a mirror of radius 1, above its lowest point: a straight
/// line through its mean radii on two planes before the crossing.
double measureCrossing(double h, const PlaneRenderer& render);

}  // namespace nephroid::closed_form
