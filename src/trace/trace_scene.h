// The scene as rays see it: Embree's acceleration structure over triangles and instances, and what a hit means.
//
// Meshes that are placed once are baked into world space (one level less to traverse, and hit points interpolated
// from world-space vertices, which is the most accurate way to get them); meshes placed several times are instanced.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/huge_pages.h"
#include "core/math.h"
#include "scene/scene_data.h"
#include "trace/embree.h"

namespace nephroid {

struct Ray {
  vec3 origin;
  vec3 dir;  ///< unit, along the travel of whatever the ray carries
  float t_max = kInfinity;
};

/// What a hit needs of one triangle, in one cache line: photons land everywhere, and fetching corners through indices
/// would cost seven lines.
struct alignas(64) PackedTriangle {
  std::uint64_t normals[3];  ///< by packNormal; all 0 where the mesh has none
  vec3 corners[3];
  float position_error;  ///< SurfacePoint::position_error in the space of the corners

  /// A unit vector in 3 × 21 bits, error below 1e-6; never 0.
  static std::uint64_t packNormal(vec3 n);
  static vec3 unpackNormal(std::uint64_t packed) {
    const auto channel = [](std::uint64_t bits) {
      return static_cast<float>(static_cast<std::int32_t>(bits & 0x1FFFFFU) - (1 << 20)) *
             (1.0F / static_cast<float>((1 << 20) - 1));
    };
    return {channel(packed), channel(packed >> 21), channel(packed >> 42)};
  }
};
static_assert(sizeof(PackedTriangle) == 64);

/// Where a ray meets a triangle.
struct RayHit {
  float t = 0;
  std::uint32_t instance = kNone;  ///< index into SceneData::instances
  std::uint32_t triangle = 0;      ///< index into the mesh's triangles
  float u = 0, v = 0;              ///< barycentric weights of the second and third vertex
};

/// The geometry of a hit, world space.
struct SurfacePoint {
  vec3 position;
  vec3 normal_geometric;  ///< unit, out of the solid (counter-clockwise winding; mirrored instances corrected)
  vec3 normal_shading;    ///< unit, interpolated and normal-mapped, in the hemisphere of `normal_geometric`
  float position_error;   ///< bound of the position's rounding error, m: the distance by which new rays must start off
  std::uint32_t instance, triangle;
  float u, v;
};

/// How the interpolated normal turns from point to point of a triangle, world space.
struct NormalGradient {
  vec3 normal{0.0F};                        ///< the interpolated one, unit; zero where the triangle is flat
  vec3 gradient_u{0.0F}, gradient_v{0.0F};  ///< of the barycentric weights, 1/m, in the plane
  vec3 turn_u{0.0F}, turn_v{0.0F};          ///< change of the unit normal by weight, perpendicular to it
  /// Change of the normal along a change `dp` of the point, in the plane, m.
  vec3 along(vec3 dp) const { return dot(gradient_u, dp) * turn_u + dot(gradient_v, dp) * turn_v; }
};

/// Immutable after construction; all methods are safe to call from any thread.
/// Keeps a reference to `scene`, which must outlive it and not change.
class TraceScene {
 public:
  /// @throws InputError if nothing can be traced, ResourceError if memory runs out
  explicit TraceScene(const SceneData& scene);
  ~TraceScene();
  TraceScene(const TraceScene&) = delete;
  TraceScene& operator=(const TraceScene&) = delete;

  /// Nearest triangle. @param coherent  a hint: neighbouring calls trace similar rays
  bool intersect(const Ray& ray, RayHit& hit, bool coherent = false) const;
  /// Is there any triangle between the origin and t_max? Cheaper than `intersect`.
  bool occluded(const Ray& ray) const;

  /// Rays that are traced together: cheaper than one by one if they start and run alike.
  static constexpr std::size_t kPacketSize = 8;
  /// Nearest triangles; `hits[i].instance` is kNone for a miss. @param rays  1 to kPacketSize of them
  void intersectPacket(std::span<const Ray* const> rays, RayHit* hits) const;
  /// @return  bit i: is there any triangle on ray i? @param rays  1 to kPacketSize of them
  std::uint32_t occludedPacket(std::span<const Ray> rays) const;

  SurfacePoint surfaceAt(const Ray& ray, const RayHit& hit) const {
    SurfacePoint point;
    describeSurface(ray, hit, point);
    return point;
  }
  /// The same, written to where it is wanted.
  void describeSurface(const Ray& ray, const RayHit& hit, SurfacePoint& point) const;
  /// What bends a bundle of rays besides their directions. Normal maps are left out.
  NormalGradient normalGradientAt(const SurfacePoint& point) const;
  /// Texture coordinates of set 0 or 1; zero where the mesh has none.
  vec2 texcoordAt(std::uint32_t instance, std::uint32_t triangle, float u, float v, int set) const;
  vec4 colorAt(std::uint32_t instance, std::uint32_t triangle, float u, float v) const;
  /// World-space corners of a triangle, wound so that their normal points out of the solid.
  void triangleCorners(std::uint32_t instance, std::uint32_t triangle, vec3 corners[3]) const;
  std::uint32_t triangleCountOf(std::uint32_t instance) const {
    return static_cast<std::uint32_t>(placed_[instance].triangles.size());
  }

  const SceneData& scene() const { return scene_; }
  const Material& materialOf(std::uint32_t instance) const { return *placed_[instance].material; }
  std::uint32_t materialIndexOf(std::uint32_t instance) const { return placed_[instance].material_index; }
  /// Instances of one node with one material bound the same solid.
  std::uint32_t solidOf(std::uint32_t instance) const { return placed_[instance].solid; }
  const Bounds& bounds() const { return bounds_; }
  bool empty() const { return bounds_.empty(); }
  RTCScene embreeScene() const { return top_.get(); }
  /// Notes every ray that is traced from now on; null ends it. For measuring only, from one thread at a time.
  void setRecorder(std::vector<Ray>* recorder) { recorder_ = recorder; }

 private:
  /// One instance, ready to be looked up from a hit.
  struct Placed {
    std::span<const uvec3> triangles;
    const PackedTriangle* packed = nullptr;  ///< by triangle; world space if baked, else object space
    bool smooth = false;                     ///< has normals
    const Mesh* mesh = nullptr;
    const Material* material = nullptr;
    std::uint32_t material_index = 0;
    std::uint32_t solid = 0;
    bool baked = true;
    bool mirrored = false;  ///< determinant < 0: the winding is reversed in world space
    mat4 world_from_object{1.0F};
    mat3 normal_from_object{1.0F};
  };
  void buildPlaced();
  void buildEmbree();
  RTCGeometry makeTriangles(const Placed& placed);
  RayHit describeHit(float t, unsigned geometry, unsigned top_geometry, unsigned triangle, float u, float v) const;
  vec3 perturbNormal(const Placed& placed, const SurfacePoint& point, vec3 normal) const;

  const SceneData& scene_;
  std::vector<Placed> placed_;
  std::vector<HugePageVector<PackedTriangle>> packed_;  ///< by mesh index
  Bounds bounds_;
  EmbreeDevice device_;
  std::vector<EmbreeScene> mesh_scenes_;  ///< by mesh index, for instanced meshes
  EmbreeScene top_;
  std::vector<std::uint32_t> instance_of_geometry_;  ///< by geomID of the top scene
  std::vector<Ray>* recorder_ = nullptr;
};

/// A point just off a surface: the start of a ray that leaves towards `dir`.
///
/// The offset is along the geometric normal by the bound of the position's rounding error, hence free of absolute
/// lengths: the same scene at another scale offsets at that scale.
inline vec3 offsetOrigin(const SurfacePoint& point, vec3 dir) {
  const float side = dot(point.normal_geometric, dir) >= 0.0F ? point.position_error : -point.position_error;
  return point.position + side * point.normal_geometric;
}

}  // namespace nephroid
