// Triangle meshes of the shapes that the built-in scenes are made of.
//
// Vertices lie on the exact surface (computed in double precision), normals are those of the exact surface, sharp edges
// have one vertex per side. Solids are closed (vertices of neighbouring faces coincide bit for bit) and wound
// counter-clockwise seen from outside. All lengths in metres, angles in radians.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scene/scene_data.h"

namespace nephroid {

/// One point of the curve that is turned about +Y, walked so that the solid lies to the left in the (r, y) plane:
/// along the bottom outwards, up the outside, over the top towards the axis, down the inside.
struct ProfilePoint {
  dvec2 position{0};        ///< (distance from the axis >= 0, y)
  dvec2 normal{0};          ///< unit, out of the solid, in (r, y)
  bool starts_new = false;  ///< no surface between the previous point and this one: the other side of a sharp edge
};

/// The unit normal of a profile that runs along `tangent` (any length but 0).
dvec2 profileNormal(dvec2 tangent);

/// A cubic Bézier curve in (r, y).
struct Bezier {
  dvec2 p0{0}, p1{0}, p2{0}, p3{0};
  dvec2 at(double t) const;
  dvec2 tangentAt(double t) const;  ///< not normalised
  /// The point at distance `offset` to the right of the curve (along its profile normal), with that normal.
  ProfilePoint offsetAt(double t, double offset) const;
};

/// Appends `point(t)` for t from `t0` to `t1` in `steps` >= 1 pieces. If the profile already ends in the first point
/// with the same normal the surface goes on smoothly, else a sharp edge begins.
void appendCurve(std::vector<ProfilePoint>& profile, const std::function<ProfilePoint(double t)>& point, double t0,
                 double t1, int steps);
void appendBezier(std::vector<ProfilePoint>& profile, const Bezier& curve, int steps);
/// Ditto, a straight piece.
void appendLine(std::vector<ProfilePoint>& profile, dvec2 from, dvec2 to);

/// The surface of revolution of `profile`, `segments` >= 3 facets around. Points with r = 0 become one vertex.
Mesh makeRevolution(std::string name, std::span<const ProfilePoint> profile, int segments);

/// A sphere about `centre`, `segments` facets around and half as many from pole to pole.
Mesh makeSphere(std::string name, dvec3 centre, double radius, int segments);

/// A box, each face cut into `segments`² squares.
Mesh makeBox(std::string name, dvec3 lower, dvec3 upper, int segments = 1);

/// A convex polygon in the xy plane (counter-clockwise seen from +Z, `polygon.size()` >= 3), extruded from z0 to z1 >
/// z0 in `segments` pieces; flat faces.
Mesh makePrism(std::string name, std::span<const dvec2> polygon, double z0, double z1, int segments = 1);

/// A point of a polyline in the (x, z) plane with the unit normal of the smooth curve that it samples.
struct CurvePoint {
  dvec2 position{0};  ///< (x, z)
  dvec2 normal{0};    ///< unit, out of the solid
};

/// The upright solid between two curves of equal length (>= 2) that run towards +x with `front` on the +z side, from y0
/// to y1 > y0: smooth front and back, flat top, bottom and ends.
Mesh makeCurvedWall(std::string name, std::span<const CurvePoint> front, std::span<const CurvePoint> back, double y0,
                    double y1);

/// A parallelogram about `centre` spanned by the half edges `u` and `v`; its normal is along u × v. Open.
Mesh makeRectangle(std::string name, dvec3 centre, dvec3 u, dvec3 v);

/// A horizontal disc of `segments` facets at `centre`, normal +Y. Open.
Mesh makeDisc(std::string name, dvec3 centre, double radius, int segments);

/// Height of a surface above a point of the plane and its slopes.
struct HeightSample {
  double y = 0, dy_dx = 0, dy_dz = 0;
};

/// The surface y = height(x, z) over |x| <= size_x/2, |z| <= size_z/2 as cells_x × cells_z squares; normal up. Open.
Mesh makeHeightField(std::string name, double size_x, double size_z, int cells_x, int cells_z,
                     const std::function<HeightSample(double x, double z)>& height);

/// An open box with walls: the inside measures size_x × size_z, from y = floor_y to y = rim_y; walls and bottom are
/// `wall` thick. A closed solid.
Mesh makeBasin(std::string name, double size_x, double size_z, double floor_y, double rim_y, double wall);

/// A bent rod in the xy plane: a tube of `tube_radius` along the arc of `arc_radius` about `centre` from angle0 to
/// angle1 > angle0 (from +x towards +y), with flat ends. A closed solid.
Mesh makeBentRod(std::string name, dvec3 centre, double arc_radius, double tube_radius, double angle0, double angle1,
                 int segments);

/// A point of a closed surface and its outward normal.
struct SurfaceSample {
  dvec3 position{0}, normal{0};
};

/// A closed surface with two poles, sampled at u in [0, 1] from pole to pole (`rows` >= 2 pieces) and v in [0, 2π)
/// (`segments` >= 3 pieces). At the poles u = 0 and u = 1 the sample must not depend on v. ∂v × ∂u must point outwards.
Mesh makePolarSurface(std::string name, int rows, int segments,
                      const std::function<SurfaceSample(double u, double v)>& surface);

}  // namespace nephroid
