#include "scene/import/mesh_repair.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <unordered_map>

namespace nephroid {
namespace {

/// Beyond this (metres, or whatever the file measures in) the products of two lengths that areas and volumes need come
/// near the end of single precision.
constexpr float kMaxCoordinate = 1e18F;

template <class T>
void keepUsed(std::vector<T>& values, const std::vector<std::uint32_t>& new_index, std::size_t used_count) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < new_index.size(); ++i)
    if (new_index[i] != kNone) values[new_index[i]] = values[i];
  values.resize(used_count);
}

/// @return whether the vector was made unit
bool makeUnit(vec3& v) {
  // Scaled first: the square of a tiny or huge component would leave single precision.
  const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!isFinite(v) || !(largest > 0)) return false;
  const vec3 scaled = v / largest;
  v = scaled / length(scaled);
  return isFinite(v);
}

/// Normal of a triangle with the triangle's doubled area as its length.
vec3 areaNormal(const Mesh& mesh, uvec3 t) {
  return cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
}

std::size_t repairNormals(Mesh& mesh) {
  std::vector<std::size_t> bad;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i)
    if (!makeUnit(mesh.normals[i])) bad.push_back(i);
  if (bad.empty()) return 0;
  const std::vector<vec3> computed = computeVertexNormals(mesh);
  for (const std::size_t i : bad) mesh.normals[i] = computed[i];
  return bad.size();
}

std::size_t repairTangents(Mesh& mesh) {
  std::size_t bad = 0;
  for (vec4& tangent : mesh.tangents) {
    vec3 direction(tangent);
    if (!makeUnit(direction)) ++bad;
    tangent = vec4(direction, tangent.w < 0 ? -1.0F : 1.0F);
  }
  if (bad > 0) mesh.tangents.clear();
  return bad;
}

/// For every vertex the number of the first vertex at the same place.
std::vector<std::uint32_t> weldPositions(const Mesh& mesh) {
  struct Hash {
    std::size_t operator()(const vec3& p) const {
      std::size_t h = 0;
      for (int c = 0; c < 3; ++c) h = (h ^ std::bit_cast<std::uint32_t>(p[c] + 0.0F)) * 0x9E3779B97F4A7C15ULL;
      return h ^ (h >> 29U);
    }
  };
  std::unordered_map<vec3, std::uint32_t, Hash> first;
  first.reserve(mesh.positions.size());
  std::vector<std::uint32_t> welded(mesh.positions.size());
  for (std::uint32_t i = 0; i < welded.size(); ++i) welded[i] = first.try_emplace(mesh.positions[i], i).first->second;
  return welded;
}

/// Disjoint sets of triangle corners (corner c belongs to triangle c / 3).
class CornerGroups {
 public:
  explicit CornerGroups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t corner) {
    while (parent_[corner] != corner) {
      parent_[corner] = parent_[parent_[corner]];
      corner = parent_[corner];
    }
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// One side of a triangle, by the welded vertices at its ends, smaller first.
struct Side {
  std::uint32_t low, high;
  std::uint32_t corner_low, corner_high;
};

std::vector<Side> listSides(const Mesh& mesh, const std::vector<std::uint32_t>& welded) {
  std::vector<Side> sides;
  sides.reserve(mesh.triangles.size() * 3);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      Side side{welded[mesh.triangles[t][k]], welded[mesh.triangles[t][next]], 3 * t + static_cast<std::uint32_t>(k),
                3 * t + static_cast<std::uint32_t>(next)};
      if (side.low > side.high) std::swap(side.low, side.high), std::swap(side.corner_low, side.corner_high);
      sides.push_back(side);
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.corner_low) < std::tie(b.low, b.high, b.corner_low);
  });
  return sides;
}

/// Joins the corners of neighbours across every side that is no crease.
CornerGroups groupCorners(const Mesh& mesh, const std::vector<vec3>& face_normals, float crease_angle) {
  CornerGroups groups(mesh.triangles.size() * 3);
  const std::vector<Side> sides = listSides(mesh, weldPositions(mesh));
  const float min_cosine = std::cos(crease_angle);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Side& a = sides[i - 1];
    const Side& b = sides[i];
    if (a.low != b.low || a.high != b.high || a.low == a.high) continue;
    if (dot(face_normals[a.corner_low / 3], face_normals[b.corner_low / 3]) < min_cosine) continue;
    groups.join(a.corner_low, b.corner_low);
    groups.join(a.corner_high, b.corner_high);
  }
  return groups;
}

float cornerAngle(const Mesh& mesh, uvec3 t, int k) {
  vec3 a = mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]];
  vec3 b = mesh.positions[t[(k + 2) % 3]] - mesh.positions[t[k]];
  return makeUnit(a) && makeUnit(b) ? std::acos(std::clamp(dot(a, b), -1.0F, 1.0F)) : 0.0F;
}

/// Copies vertex `from` of `source` to the end of `target`, with `normal`.
void appendVertex(const Mesh& source, std::uint32_t from, vec3 normal, Mesh& target) {
  target.positions.push_back(source.positions[from]);
  target.normals.push_back(normal);
  for (int set = 0; set < 2; ++set)
    if (!source.texcoords[set].empty()) target.texcoords[set].push_back(source.texcoords[set][from]);
  if (!source.colors.empty()) target.colors.push_back(source.colors[from]);
}

}  // namespace

void dropUnusedVertices(Mesh& mesh) {
  std::vector<std::uint32_t> new_index(mesh.positions.size(), kNone);
  for (const uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) new_index[t[k]] = 0;
  std::uint32_t used = 0;
  for (std::uint32_t& index : new_index)
    if (index != kNone) index = used++;
  if (used == new_index.size()) return;
  keepUsed(mesh.positions, new_index, used);
  keepUsed(mesh.normals, new_index, used);
  keepUsed(mesh.tangents, new_index, used);
  keepUsed(mesh.texcoords[0], new_index, used);
  keepUsed(mesh.texcoords[1], new_index, used);
  keepUsed(mesh.colors, new_index, used);
  for (uvec3& t : mesh.triangles) t = {new_index[t.x], new_index[t.y], new_index[t.z]};
}

std::optional<std::size_t> findNonFinitePosition(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (!(std::abs(mesh.positions[i][c]) <= kMaxCoordinate)) return i;
  return std::nullopt;
}

RepairCounts repairAttributes(Mesh& mesh) {
  RepairCounts counts;
  counts.normals = repairNormals(mesh);
  counts.tangents = repairTangents(mesh);
  for (auto& texcoords : mesh.texcoords) {
    for (vec2& uv : texcoords) {
      if (std::isfinite(uv.x) && std::isfinite(uv.y)) continue;
      uv = vec2(0.0F);
      ++counts.texcoords;
    }
  }
  for (vec4& color : mesh.colors) {
    bool bad = false;
    for (int c = 0; c < 4; ++c) {
      if (std::isfinite(color[c]) && color[c] >= 0.0F) continue;
      color[c] = 0.0F;
      bad = true;
    }
    counts.colors += bad ? 1 : 0;
  }
  return counts;
}

std::vector<vec3> computeVertexNormals(const Mesh& mesh) {
  std::vector<vec3> normals(mesh.positions.size(), vec3(0.0F));
  for (const uvec3& t : mesh.triangles) {
    const vec3 normal = areaNormal(mesh, t);
    for (int k = 0; k < 3; ++k) normals[t[k]] += normal;
  }
  for (vec3& normal : normals)
    if (!makeUnit(normal)) normal = vec3(0, 1, 0);
  return normals;
}

void computeSmoothNormals(Mesh& mesh, float crease_angle) {
  std::vector<vec3> face_normals(mesh.triangles.size());
  for (std::size_t t = 0; t < face_normals.size(); ++t) {
    face_normals[t] = areaNormal(mesh, mesh.triangles[t]);
    if (!makeUnit(face_normals[t])) face_normals[t] = vec3(0.0F);
  }
  CornerGroups groups = groupCorners(mesh, face_normals, crease_angle);
  std::vector<vec3> sums(mesh.triangles.size() * 3, vec3(0.0F));
  for (std::uint32_t c = 0; c < sums.size(); ++c)
    sums[groups.find(c)] += cornerAngle(mesh, mesh.triangles[c / 3], static_cast<int>(c % 3)) * face_normals[c / 3];
  for (vec3& sum : sums)
    if (!makeUnit(sum)) sum = vec3(0, 1, 0);

  // A vertex is split where the corners that use it fall into several groups.
  Mesh split;
  std::unordered_map<std::uint64_t, std::uint32_t> new_index;
  new_index.reserve(mesh.positions.size());
  for (std::uint32_t c = 0; c < sums.size(); ++c) {
    std::uint32_t& vertex = mesh.triangles[c / 3][static_cast<int>(c % 3)];
    const std::uint32_t group = groups.find(c);
    const auto [entry, is_new] = new_index.try_emplace((std::uint64_t{vertex} << 32U) | group,
                                                       static_cast<std::uint32_t>(split.positions.size()));
    if (is_new) appendVertex(mesh, vertex, sums[group], split);
    vertex = entry->second;
  }
  split.triangles = std::move(mesh.triangles);
  split.name = std::move(mesh.name);
  split.material = mesh.material;
  mesh = std::move(split);
}

}  // namespace nephroid
