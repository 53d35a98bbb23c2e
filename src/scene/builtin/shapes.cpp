#include "scene/builtin/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/assert.h"

namespace nephroid {
namespace {

constexpr double kTau = 6.283185307179586476925;

std::uint32_t addVertex(Mesh& mesh, dvec3 position, dvec3 normal) {
  // Negative zero would keep equal positions from welding where they are compared by their bits.
  mesh.positions.push_back(vec3(position) + vec3(0.0F));
  mesh.normals.push_back(vec3(normal));
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

/// A quadrilateral a, b, c, d counter-clockwise seen from outside; corners may coincide in pairs (at a pole).
void addQuad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  if (a != b && b != c && c != a) mesh.triangles.emplace_back(a, b, c);
  if (a != c && c != d && d != a) mesh.triangles.emplace_back(a, c, d);
}

/// A flat quadrilateral, counter-clockwise seen from outside, cut into cells; corners are interpolated so that the
/// edge points of neighbouring faces agree to the last bit.
void addFlatQuad(Mesh& mesh, dvec3 a, dvec3 b, dvec3 c, dvec3 d, int cells_ab = 1, int cells_ad = 1) {
  const dvec3 normal = glm::normalize(glm::cross(b - a, d - a));
  const auto between = [](dvec3 p, dvec3 q, int i, int n) {
    if (i == 0) return p;
    if (i == n) return q;
    return (p * static_cast<double>(n - i) + q * static_cast<double>(i)) / static_cast<double>(n);
  };
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (int j = 0; j <= cells_ad; ++j)
    for (int i = 0; i <= cells_ab; ++i)
      addVertex(mesh, between(between(a, b, i, cells_ab), between(d, c, i, cells_ab), j, cells_ad), normal);
  const auto row = static_cast<std::uint32_t>(cells_ab + 1);
  for (int j = 0; j < cells_ad; ++j)
    for (int i = 0; i < cells_ab; ++i) {
      const std::uint32_t v = base + static_cast<std::uint32_t>(j) * row + static_cast<std::uint32_t>(i);
      addQuad(mesh, v, v + 1, v + 1 + row, v + row);
    }
}

struct Turn {
  double sine, cosine;
};

std::vector<Turn> makeTurns(int segments) {
  std::vector<Turn> turns(static_cast<std::size_t>(segments));
  for (int i = 0; i < segments; ++i) {
    const double angle = kTau * i / segments;
    turns[static_cast<std::size_t>(i)] = {std::sin(angle), std::cos(angle)};
  }
  return turns;
}

/// One ring of vertices: `count` of them, or a single one (a pole) that stands for all.
struct Ring {
  std::uint32_t first = 0;
  bool pole = false;
  std::uint32_t at(std::uint32_t i) const { return pole ? first : first + i; }
};

void joinRings(Mesh& mesh, Ring from, Ring to, int segments) {
  const auto count = static_cast<std::uint32_t>(segments);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    addQuad(mesh, from.at(i), from.at(next), to.at(next), to.at(i));
  }
}

/// Starts a piece of profile at `position`: continues the last one where position and normal agree.
void beginPiece(std::vector<ProfilePoint>& profile, dvec2 position, dvec2 normal) {
  constexpr double kSameNormal = 1.0 - 1e-9;
  if (!profile.empty() && glm::dot(profile.back().normal, normal) > kSameNormal) {
    const double scale = std::max({std::abs(position.x), std::abs(position.y), 1e-300});
    if (glm::distance(profile.back().position, position) <= 1e-12 * scale) return;
  }
  profile.push_back({position, normal, true});
}

}  // namespace

dvec2 profileNormal(dvec2 tangent) { return glm::normalize(dvec2(tangent.y, -tangent.x)); }

dvec2 Bezier::at(double t) const {
  if (t == 0.0) return p0;
  if (t == 1.0) return p3;
  const double s = 1.0 - t;
  return s * s * s * p0 + 3.0 * s * s * t * p1 + 3.0 * s * t * t * p2 + t * t * t * p3;
}

dvec2 Bezier::tangentAt(double t) const {
  const double s = 1.0 - t;
  return 3.0 * (s * s * (p1 - p0) + 2.0 * s * t * (p2 - p1) + t * t * (p3 - p2));
}

ProfilePoint Bezier::offsetAt(double t, double offset) const {
  const dvec2 normal = profileNormal(tangentAt(t));
  return {at(t) + offset * normal, normal, false};
}

void appendCurve(std::vector<ProfilePoint>& profile, const std::function<ProfilePoint(double t)>& point, double t0,
                 double t1, int steps) {
  NEPHROID_ASSERT_GE(steps, 1);
  const ProfilePoint first = point(t0);
  beginPiece(profile, first.position, first.normal);
  for (int i = 1; i <= steps; ++i) {
    ProfilePoint next = point(i == steps ? t1 : t0 + (t1 - t0) * i / steps);
    next.starts_new = false;
    profile.push_back(next);
  }
}

void appendBezier(std::vector<ProfilePoint>& profile, const Bezier& curve, int steps) {
  appendCurve(
      profile, [&](double t) { return curve.offsetAt(t, 0.0); }, 0.0, 1.0, steps);
}

void appendLine(std::vector<ProfilePoint>& profile, dvec2 from, dvec2 to) {
  const dvec2 normal = profileNormal(to - from);
  beginPiece(profile, from, normal);
  profile.push_back({to, normal, false});
}

Mesh makeRevolution(std::string name, std::span<const ProfilePoint> profile, int segments) {
  NEPHROID_ASSERT_GE(segments, 3);
  Mesh mesh;
  mesh.name = std::move(name);
  const std::vector<Turn> turns = makeTurns(segments);
  Ring previous;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const ProfilePoint& point = profile[i];
    const double r = point.position.x;
    Ring ring{static_cast<std::uint32_t>(mesh.positions.size()), r == 0.0};
    if (ring.pole) {
      // A flat or rounded end; its normal is along the axis.
      addVertex(mesh, {0, point.position.y, 0}, {0, point.normal.y < 0 ? -1 : 1, 0});
    } else {
      for (const Turn& turn : turns)
        addVertex(mesh, {r * turn.sine, point.position.y, r * turn.cosine},
                  {point.normal.x * turn.sine, point.normal.y, point.normal.x * turn.cosine});
    }
    if (i > 0 && !point.starts_new) joinRings(mesh, previous, ring, segments);
    previous = ring;
  }
  return mesh;
}

Mesh makeSphere(std::string name, dvec3 centre, double radius, int segments) {
  return makePolarSurface(std::move(name), std::max(segments / 2, 2), segments, [&](double u, double v) {
    const double angle = 0.5 * kTau * u;
    const double sine = u == 0.0 || u == 1.0 ? 0.0 : std::sin(angle);
    const dvec3 normal(sine * std::sin(v), -std::cos(angle), sine * std::cos(v));
    return SurfaceSample{centre + radius * normal, normal};
  });
}

Mesh makeBox(std::string name, dvec3 lower, dvec3 upper, int segments) {
  Mesh mesh;
  mesh.name = std::move(name);
  const auto corner = [&](int x, int y, int z) {
    return dvec3(x != 0 ? upper.x : lower.x, y != 0 ? upper.y : lower.y, z != 0 ? upper.z : lower.z);
  };
  const auto face = [&](dvec3 a, dvec3 b, dvec3 c, dvec3 d) { addFlatQuad(mesh, a, b, c, d, segments, segments); };
  face(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
  face(corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1), corner(0, 1, 0));
  face(corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1), corner(1, 1, 0));
  face(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
  face(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
  face(corner(0, 0, 0), corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0));
  return mesh;
}

Mesh makePrism(std::string name, std::span<const dvec2> polygon, double z0, double z1, int segments) {
  NEPHROID_ASSERT_GE(polygon.size(), std::size_t{3});
  Mesh mesh;
  mesh.name = std::move(name);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    addFlatQuad(mesh, {p, z0}, {q, z0}, {q, z1}, {p, z1}, 1, segments);
  }
  for (const bool front : {true, false}) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const dvec2 p : polygon) addVertex(mesh, {p, front ? z1 : z0}, {0, 0, front ? 1 : -1});
    for (std::uint32_t i = 2; i < polygon.size(); ++i) {
      if (front)
        mesh.triangles.emplace_back(base, base + i - 1, base + i);
      else
        mesh.triangles.emplace_back(base, base + i, base + i - 1);
    }
  }
  return mesh;
}

Mesh makeCurvedWall(std::string name, std::span<const CurvePoint> front, std::span<const CurvePoint> back, double y0,
                    double y1) {
  NEPHROID_ASSERT_GE(front.size(), std::size_t{2});
  NEPHROID_ASSERT_EQ(front.size(), back.size());
  Mesh mesh;
  mesh.name = std::move(name);
  const auto place = [](const CurvePoint& p, double y) { return dvec3(p.position.x, y, p.position.y); };
  const auto sheet = [&](std::span<const CurvePoint> curve, bool towards_viewer) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const CurvePoint& p : curve)
      for (const double y : {y0, y1}) addVertex(mesh, place(p, y), {p.normal.x, 0, p.normal.y});
    for (std::uint32_t i = 0; i + 1 < curve.size(); ++i) {
      const std::uint32_t v = base + 2 * i;
      if (towards_viewer)
        addQuad(mesh, v, v + 2, v + 3, v + 1);
      else
        addQuad(mesh, v, v + 1, v + 3, v + 2);
    }
  };
  sheet(front, true);
  sheet(back, false);
  for (std::size_t i = 0; i + 1 < front.size(); ++i) {
    addFlatQuad(mesh, place(front[i], y1), place(front[i + 1], y1), place(back[i + 1], y1), place(back[i], y1));
    addFlatQuad(mesh, place(front[i], y0), place(back[i], y0), place(back[i + 1], y0), place(front[i + 1], y0));
  }
  const CurvePoint &right_front = front.back(), &right_back = back.back();
  addFlatQuad(mesh, place(right_front, y0), place(right_back, y0), place(right_back, y1), place(right_front, y1));
  addFlatQuad(mesh, place(front[0], y0), place(front[0], y1), place(back[0], y1), place(back[0], y0));
  return mesh;
}

Mesh makeRectangle(std::string name, dvec3 centre, dvec3 u, dvec3 v) {
  Mesh mesh;
  mesh.name = std::move(name);
  addFlatQuad(mesh, centre - u - v, centre + u - v, centre + u + v, centre - u + v);
  return mesh;
}

Mesh makeDisc(std::string name, dvec3 centre, double radius, int segments) {
  const std::array<ProfilePoint, 2> profile{{{{radius, centre.y}, {0, 1}, true}, {{0, centre.y}, {0, 1}, false}}};
  Mesh mesh = makeRevolution(std::move(name), profile, segments);
  for (vec3& position : mesh.positions) position += vec3(static_cast<float>(centre.x), 0, static_cast<float>(centre.z));
  return mesh;
}

Mesh makeHeightField(std::string name, double size_x, double size_z, int cells_x, int cells_z,
                     const std::function<HeightSample(double x, double z)>& height) {
  NEPHROID_ASSERT_GE(std::min(cells_x, cells_z), 1);
  Mesh mesh;
  mesh.name = std::move(name);
  const auto row = static_cast<std::uint32_t>(cells_x + 1);
  mesh.positions.reserve(row * static_cast<std::size_t>(cells_z + 1));
  mesh.normals.reserve(mesh.positions.capacity());
  for (int j = 0; j <= cells_z; ++j)
    for (int i = 0; i <= cells_x; ++i) {
      const double x = size_x * (static_cast<double>(i) / cells_x - 0.5);
      const double z = size_z * (static_cast<double>(j) / cells_z - 0.5);
      const HeightSample sample = height(x, z);
      addVertex(mesh, {x, sample.y, z}, glm::normalize(dvec3(-sample.dy_dx, 1, -sample.dy_dz)));
    }
  mesh.triangles.reserve(2 * static_cast<std::size_t>(cells_x) * static_cast<std::size_t>(cells_z));
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(cells_z); ++j)
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(cells_x); ++i) {
      const std::uint32_t v = j * row + i;
      addQuad(mesh, v, v + row, v + row + 1, v + 1);
    }
  return mesh;
}

Mesh makeBasin(std::string name, double size_x, double size_z, double floor_y, double rim_y, double wall) {
  Mesh mesh;
  mesh.name = std::move(name);
  const double ix = 0.5 * size_x, iz = 0.5 * size_z, ox = ix + wall, oz = iz + wall, base_y = floor_y - wall;
  // Corners counter-clockwise seen from above, so that (i, i + 1) walks each side with the inside on its left.
  const std::array<dvec2, 4> sides{{{-1, 1}, {1, 1}, {1, -1}, {-1, -1}}};
  const auto inner = [&](std::size_t i, double y) { return dvec3(sides[i % 4].x * ix, y, sides[i % 4].y * iz); };
  const auto outer = [&](std::size_t i, double y) { return dvec3(sides[i % 4].x * ox, y, sides[i % 4].y * oz); };
  for (std::size_t i = 0; i < 4; ++i) {
    addFlatQuad(mesh, inner(i + 1, floor_y), inner(i, floor_y), inner(i, rim_y), inner(i + 1, rim_y));
    addFlatQuad(mesh, outer(i, base_y), outer(i + 1, base_y), outer(i + 1, rim_y), outer(i, rim_y));
    // Mitred rim: no vertex of one side falls inside an edge of another.
    addFlatQuad(mesh, outer(i, rim_y), outer(i + 1, rim_y), inner(i + 1, rim_y), inner(i, rim_y));
  }
  addFlatQuad(mesh, inner(0, floor_y), inner(1, floor_y), inner(2, floor_y), inner(3, floor_y));
  addFlatQuad(mesh, outer(3, base_y), outer(2, base_y), outer(1, base_y), outer(0, base_y));
  return mesh;
}

Mesh makeBentRod(std::string name, dvec3 centre, double arc_radius, double tube_radius, double angle0, double angle1,
                 int segments) {
  Mesh mesh;
  mesh.name = std::move(name);
  const int around = std::max(segments / 4, 8), along = std::max(segments / 2, 8);
  const std::vector<Turn> turns = makeTurns(around);
  const auto addRing = [&](double angle, int cap) {
    const Ring ring{static_cast<std::uint32_t>(mesh.positions.size()), false};
    const dvec3 radial(std::cos(angle), std::sin(angle), 0), tangent(-std::sin(angle), std::cos(angle), 0);
    for (const Turn& turn : turns) {
      const dvec3 normal = turn.cosine * radial - turn.sine * dvec3(0, 0, 1);
      addVertex(mesh, centre + arc_radius * radial + tube_radius * normal,
                cap == 0 ? normal : tangent * static_cast<double>(cap));
    }
    return ring;
  };
  const auto addCentre = [&](double angle, int cap) {
    const dvec3 radial(std::cos(angle), std::sin(angle), 0), tangent(-std::sin(angle), std::cos(angle), 0);
    return Ring{addVertex(mesh, centre + arc_radius * radial, tangent * static_cast<double>(cap)), true};
  };
  const Ring start = addCentre(angle0, -1);
  joinRings(mesh, start, addRing(angle0, -1), around);
  Ring previous = addRing(angle0, 0);
  for (int i = 1; i <= along; ++i) {
    const Ring next = addRing(angle0 + (angle1 - angle0) * i / along, 0);
    joinRings(mesh, previous, next, around);
    previous = next;
  }
  const Ring last = addRing(angle0 + (angle1 - angle0) * along / along, 1);
  joinRings(mesh, last, addCentre(angle1, 1), around);
  return mesh;
}

Mesh makePolarSurface(std::string name, int rows, int segments,
                      const std::function<SurfaceSample(double u, double v)>& surface) {
  NEPHROID_ASSERT_GE(rows, 2);
  NEPHROID_ASSERT_GE(segments, 3);
  Mesh mesh;
  mesh.name = std::move(name);
  Ring previous;
  for (int i = 0; i <= rows; ++i) {
    const Ring ring{static_cast<std::uint32_t>(mesh.positions.size()), i == 0 || i == rows};
    const double u = static_cast<double>(i) / rows;
    for (int j = 0; j < (ring.pole ? 1 : segments); ++j) {
      const SurfaceSample sample = surface(u, kTau * j / segments);
      addVertex(mesh, sample.position, sample.normal);
    }
    if (i > 0) joinRings(mesh, previous, ring, segments);
    previous = ring;
  }
  return mesh;
}

}  // namespace nephroid
