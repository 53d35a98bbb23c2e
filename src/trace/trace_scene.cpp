#include "trace/trace_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/parallel.h"
#include "nephroid/error.h"
#include "scene/texture.h"

namespace nephroid {
namespace {

/// Relative bound of the rounding of an interpolated position: three products and two sums of coordinates (about
/// 4 ulp), the affine transform of an instance (4 more) and Embree's intersection in single precision. 2^-19 is 16 ulp:
/// large enough that a new ray does not meet its own surface, small against any thickness that is modelled.
constexpr float kPositionErrorScale = 0x1p-19F;

/// Rays start a hair off zero: on a plane through the world's origin coordinates are exact, the offset is zero, and
/// Embree counts a hit at distance zero. No length: any positive number serves.
constexpr float kRayStart = 1e-30F;

/// Fewer rays than this are traced one by one: a packet costs about as much as so many.
constexpr std::size_t kSmallestPacket = 3;

/// Cosine of the widest angle between rays that count as running together. Wider ones part on the way, and then
/// Embree's coherent traversal takes twice the time of its other one.
constexpr float kCoherentCosine = 0.9F;

void setLane(RTCRay8& rays, std::size_t lane, const Ray& ray) {
  rays.org_x[lane] = ray.origin.x, rays.org_y[lane] = ray.origin.y, rays.org_z[lane] = ray.origin.z;
  rays.dir_x[lane] = ray.dir.x, rays.dir_y[lane] = ray.dir.y, rays.dir_z[lane] = ray.dir.z;
  rays.tnear[lane] = kRayStart, rays.tfar[lane] = ray.t_max;
  rays.time[lane] = 0.0F, rays.mask[lane] = ~0U, rays.id[lane] = 0, rays.flags[lane] = 0;
}

void onEmbreeError(void* /*user*/, RTCError code, const char* text) {
  // Embree calls this from inside its API; the state is read back by checkEmbree. Only memory failures can be the
  // world's fault here, and they must not pass silently.
  if (code == RTC_ERROR_OUT_OF_MEMORY)
    throw ResourceError(fmt::format("out of memory while building the acceleration structure ({})", text ? text : ""));
}

void checkEmbree(RTCDevice device, const char* what) {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_NONE) return;
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw ResourceError(fmt::format("out of memory while {}", what));
  throw InternalError(fmt::format("Embree error {} while {}", static_cast<int>(code), what));
}

vec3 unitOrZero(vec3 v) {
  const float squared = dot(v, v);
  return squared > 0.0F ? v * (1.0F / std::sqrt(squared)) : vec3(0.0F);
}

/// Only the error across the surface matters: along it, the point is still on the surface.
/// @param magnitude  of the numbers that the position was computed from
float boundPositionError(vec3 normal, vec3 magnitude) { return kPositionErrorScale * dot(glm::abs(normal), magnitude); }

/// The triangles of a mesh, placed by `placed` (the identity for meshes that are instanced).
HugePageVector<PackedTriangle> packTriangles(const Mesh& mesh, const mat4& placed) {
  // Of each vertex once: some six triangles share it.
  std::vector<vec3> positions(mesh.positions.size());
  std::ranges::transform(mesh.positions, positions.begin(), [&](vec3 p) { return transformPoint(placed, p); });
  const mat3 normal_from_object = glm::transpose(glm::inverse(mat3(placed)));
  std::vector<std::uint64_t> normals(mesh.normals.size());
  std::ranges::transform(mesh.normals, normals.begin(),
                         [&](vec3 n) { return PackedTriangle::packNormal(normalize(normal_from_object * n)); });
  HugePageVector<PackedTriangle> packed(mesh.triangles.size());
  for (std::size_t t = 0; t < packed.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[t][k];
      packed[t].corners[k] = positions[vertex];
      packed[t].normals[k] = normals.empty() ? 0 : normals[vertex];
    }
    const vec3* c = packed[t].corners;
    const vec3 normal = unitOrZero(cross(c[1] - c[0], c[2] - c[0]));
    const vec3 magnitude = glm::max(glm::max(glm::abs(c[0]), glm::abs(c[1])), glm::abs(c[2]));
    // Without area a triangle has no normal: `surfaceAt` takes any.
    packed[t].position_error = boundPositionError(normal != vec3(0.0F) ? normal : vec3(1.0F), magnitude);
  }
  return packed;
}

}  // namespace

std::uint64_t PackedTriangle::packNormal(vec3 n) {
  if (!isFinite(n)) n = vec3(0, 0, 1);
  std::uint64_t packed = 0;
  for (int k = 0; k < 3; ++k) {
    const auto steps = static_cast<std::int64_t>(std::lround(static_cast<double>(n[k]) * ((1 << 20) - 1)));
    packed |= static_cast<std::uint64_t>(steps + (1 << 20)) << (21 * k);
  }
  return packed;
}

TraceScene::TraceScene(const SceneData& scene) : scene_(scene) {
  buildPlaced();
  buildEmbree();
}

TraceScene::~TraceScene() = default;

void TraceScene::buildPlaced() {
  std::vector<int> uses(scene_.meshes.size(), 0);
  for (const Instance& instance : scene_.instances) ++uses[instance.mesh];
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> solids;
  placed_.resize(scene_.instances.size());
  packed_.resize(scene_.meshes.size());
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const Instance& instance = scene_.instances[i];
    const Mesh& mesh = scene_.meshes[instance.mesh];
    Placed& placed = placed_[i];
    placed.mesh = &mesh;
    placed.material_index = mesh.material;
    placed.material = &scene_.materials[mesh.material];
    placed.triangles = mesh.triangles;
    placed.world_from_object = instance.world_from_object;
    placed.normal_from_object = glm::transpose(glm::inverse(mat3(instance.world_from_object)));
    placed.mirrored = glm::determinant(mat3(instance.world_from_object)) < 0.0F;
    placed.baked = uses[instance.mesh] == 1;
    placed.solid =
        solids.try_emplace({instance.object, mesh.material}, static_cast<std::uint32_t>(solids.size())).first->second;
    placed.smooth = !mesh.normals.empty();
    if (packed_[instance.mesh].empty())
      packed_[instance.mesh] = packTriangles(mesh, placed.baked ? instance.world_from_object : mat4(1.0F));
    placed.packed = packed_[instance.mesh].data();
    for (const vec3& p : mesh.positions) bounds_.add(transformPoint(instance.world_from_object, p));
  }
}

RTCGeometry TraceScene::makeTriangles(const Placed& placed) {
  const Mesh& mesh = *placed.mesh;
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  // Embree reads 16 bytes at each vertex, so the last of a shared 12-byte array would be read past its end: copy.
  auto* vertices =
      static_cast<vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3),
                                                 std::max<std::size_t>(mesh.positions.size(), 1)));
  auto* indices =
      static_cast<uvec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(uvec3),
                                                  std::max<std::size_t>(placed.triangles.size(), 1)));
  if (!vertices || !indices) throw ResourceError("out of memory while copying triangles to the acceleration structure");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    vertices[i] = placed.baked ? transformPoint(placed.world_from_object, mesh.positions[i]) : mesh.positions[i];
  std::copy(placed.triangles.begin(), placed.triangles.end(), indices);
  if (mesh.positions.empty()) vertices[0] = vec3(0.0F);
  if (placed.triangles.empty()) indices[0] = uvec3(0);
  rtcCommitGeometry(geometry);
  return geometry;
}

void TraceScene::buildEmbree() {
  device_ = EmbreeDevice(rtcNewDevice(kEmbreeConfig));
  if (!device_.get()) throw InternalError("Embree cannot create a device");
  rtcSetDeviceErrorFunction(device_.get(), onEmbreeError, nullptr);
  top_ = EmbreeScene(rtcNewScene(device_.get()));
  // Watertight edges: a photon that slips between two triangles of a lens would be a leak of light.
  rtcSetSceneFlags(top_.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(top_.get(), RTC_BUILD_QUALITY_HIGH);
  mesh_scenes_.resize(scene_.meshes.size());
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const Placed& placed = placed_[i];
    EmbreeGeometry geometry;
    if (placed.baked) {
      geometry = EmbreeGeometry(makeTriangles(placed));
    } else {
      EmbreeScene& shared = mesh_scenes_[scene_.instances[i].mesh];
      if (!shared.get()) {
        shared = EmbreeScene(rtcNewScene(device_.get()));
        rtcSetSceneFlags(shared.get(), RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(shared.get(), RTC_BUILD_QUALITY_HIGH);
        const EmbreeGeometry triangles(makeTriangles(placed));
        rtcAttachGeometry(shared.get(), triangles.get());
        rtcCommitScene(shared.get());
      }
      geometry = EmbreeGeometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE));
      rtcSetGeometryInstancedScene(geometry.get(), shared.get());
      rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &placed.world_from_object[0][0]);
      rtcCommitGeometry(geometry.get());
    }
    const unsigned id = rtcAttachGeometry(top_.get(), geometry.get());
    if (id >= instance_of_geometry_.size()) instance_of_geometry_.resize(id + 1, kNone);
    instance_of_geometry_[id] = static_cast<std::uint32_t>(i);
  }
  rtcCommitScene(top_.get());
  checkEmbree(device_.get(), "building the acceleration structure");
}

bool TraceScene::intersect(const Ray& ray, RayHit& hit, bool coherent) const {
  if (recorder_) [[unlikely]]
    recorder_->push_back(ray);
  RTCRayHit query;
  query.ray.org_x = ray.origin.x, query.ray.org_y = ray.origin.y, query.ray.org_z = ray.origin.z;
  query.ray.dir_x = ray.dir.x, query.ray.dir_y = ray.dir.y, query.ray.dir_z = ray.dir.z;
  query.ray.tnear = kRayStart, query.ray.tfar = ray.t_max;
  query.ray.time = 0.0F, query.ray.mask = ~0U, query.ray.id = 0, query.ray.flags = 0;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersectClosest(top_.get(), query, coherent);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit = describeHit(query.ray.tfar, query.hit.geomID, query.hit.instID[0], query.hit.primID, query.hit.u, query.hit.v);
  return true;
}

RayHit TraceScene::describeHit(float t, unsigned geometry, unsigned top_geometry, unsigned triangle, float u,
                               float v) const {
  const unsigned top_id = top_geometry != RTC_INVALID_GEOMETRY_ID ? top_geometry : geometry;
  return {t, instance_of_geometry_[top_id], triangle, u, v};
}

void TraceScene::intersectPacket(std::span<const Ray* const> rays, RayHit* hits) const {
  if (rays.size() < kSmallestPacket) {
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!intersect(*rays[i], hits[i], true)) hits[i].instance = kNone;
    return;
  }
  alignas(32) int valid[kPacketSize];
  RTCRayHit8 query;
  float least_cosine = 1.0F;
  for (std::size_t i = 0; i < kPacketSize; ++i) {
    valid[i] = i < rays.size() ? -1 : 0;
    // Lanes that are not valid repeat the last ray, so that no arithmetic meets uninitialised numbers.
    const Ray& ray = *rays[std::min(i, rays.size() - 1)];
    setLane(query.ray, i, ray);
    least_cosine = std::min(least_cosine, dot(ray.dir, rays[0]->dir));
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    if (recorder_ && valid[i]) [[unlikely]]
      recorder_->push_back(ray);
  }
  intersectClosest8(valid, top_.get(), query, least_cosine > kCoherentCosine);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits[i].instance = kNone;
    if (query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    hits[i] = describeHit(query.ray.tfar[i], query.hit.geomID[i], query.hit.instID[0][i], query.hit.primID[i],
                          query.hit.u[i], query.hit.v[i]);
    // `surfaceAt` will want it, and by then it is here.
    __builtin_prefetch(&placed_[hits[i].instance].packed[hits[i].triangle]);
  }
}

std::uint32_t TraceScene::occludedPacket(std::span<const Ray> rays) const {
  alignas(32) int valid[kPacketSize];
  RTCRay8 query;
  float least_cosine = 1.0F;
  for (std::size_t i = 0; i < kPacketSize; ++i) {
    valid[i] = i < rays.size() ? -1 : 0;
    const Ray& ray = rays[std::min(i, rays.size() - 1)];
    setLane(query, i, ray);
    least_cosine = std::min(least_cosine, dot(ray.dir, rays[0].dir));
    if (recorder_ && valid[i]) [[unlikely]]
      recorder_->push_back(ray);
  }
  intersectAny8(valid, top_.get(), query, least_cosine > kCoherentCosine);
  std::uint32_t blocked = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) blocked |= static_cast<std::uint32_t>(query.tfar[i] < 0.0F) << i;
  return blocked;
}

bool TraceScene::occluded(const Ray& ray) const {
  if (recorder_) [[unlikely]]
    recorder_->push_back(ray);
  RTCRay query;
  query.org_x = ray.origin.x, query.org_y = ray.origin.y, query.org_z = ray.origin.z;
  query.dir_x = ray.dir.x, query.dir_y = ray.dir.y, query.dir_z = ray.dir.z;
  query.tnear = kRayStart, query.tfar = ray.t_max;
  query.time = 0.0F, query.mask = ~0U, query.id = 0, query.flags = 0;
  return intersectAny(top_.get(), query);
}

void TraceScene::describeSurface(const Ray& ray, const RayHit& hit, SurfacePoint& point) const {
  const Placed& placed = placed_[hit.instance];
  const PackedTriangle& packed = placed.packed[hit.triangle];
  const vec3 a = packed.corners[0], b = packed.corners[1], c = packed.corners[2];
  point.instance = hit.instance, point.triangle = hit.triangle, point.u = hit.u, point.v = hit.v;
  vec3 normal = cross(b - a, c - a);
  point.position = a + hit.u * (b - a) + hit.v * (c - a);
  if (!placed.baked) {
    point.position = transformPoint(placed.world_from_object, point.position);
    normal = placed.normal_from_object * normal;
  }
  normal = unitOrZero(normal);
  // A triangle without area has no normal; any that faces the ray keeps the arithmetic finite.
  point.normal_geometric = normal != vec3(0.0F) ? normal : -ray.dir;
  // The inverse transpose of a mirrored transform already turns object normals outward; world-space winding is
  // reversed.
  if (placed.mirrored && placed.baked) point.normal_geometric = -point.normal_geometric;
  point.position_error = packed.position_error;
  if (!placed.baked) {
    const mat4& m = placed.world_from_object;
    const mat3 absolute(glm::abs(vec3(m[0])), glm::abs(vec3(m[1])), glm::abs(vec3(m[2])));
    const vec3 magnitude = absolute * glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c)) + glm::abs(vec3(m[3]));
    point.position_error = boundPositionError(point.normal_geometric, magnitude);
  }
  point.normal_shading = point.normal_geometric;
  if (placed.smooth) {
    vec3 interpolated = (1.0F - hit.u - hit.v) * PackedTriangle::unpackNormal(packed.normals[0]) +
                        hit.u * PackedTriangle::unpackNormal(packed.normals[1]) +
                        hit.v * PackedTriangle::unpackNormal(packed.normals[2]);
    if (!placed.baked) interpolated = placed.normal_from_object * interpolated;
    const float squared = dot(interpolated, interpolated);
    if (squared > 0.0F) interpolated *= 1.0F / std::sqrt(squared);
    if (dot(interpolated, point.normal_geometric) > 0.0F) point.normal_shading = interpolated;
  }
  if (placed.material->normal_texture.valid())
    point.normal_shading = perturbNormal(placed, point, point.normal_shading);
}

NormalGradient TraceScene::normalGradientAt(const SurfacePoint& point) const {
  const Placed& placed = placed_[point.instance];
  NormalGradient g;
  if (!placed.smooth) return g;
  const PackedTriangle& packed = placed.packed[point.triangle];
  vec3 edge_u = packed.corners[1] - packed.corners[0], edge_v = packed.corners[2] - packed.corners[0];
  vec3 normals[3];
  for (int k = 0; k < 3; ++k) normals[k] = PackedTriangle::unpackNormal(packed.normals[k]);
  if (!placed.baked) {
    edge_u = mat3(placed.world_from_object) * edge_u, edge_v = mat3(placed.world_from_object) * edge_v;
    for (vec3& n : normals) n = placed.normal_from_object * n;
  }
  // Gradients of u and v are dual to the edges: gradient_u·edge_u = 1, gradient_u·edge_v = 0.
  const float uu = dot(edge_u, edge_u), uv = dot(edge_u, edge_v), vv = dot(edge_v, edge_v);
  const float determinant = uu * vv - uv * uv;
  const vec3 sum = (1.0F - point.u - point.v) * normals[0] + point.u * normals[1] + point.v * normals[2];
  const float squared = dot(sum, sum);
  if (determinant <= 0.0F || squared <= 0.0F) return g;
  g.gradient_u = (vv * edge_u - uv * edge_v) / determinant, g.gradient_v = (uu * edge_v - uv * edge_u) / determinant;
  const float inverse_length = 1.0F / std::sqrt(squared);
  g.normal = sum * inverse_length;
  const auto turn = [&](vec3 change) { return (change - g.normal * dot(g.normal, change)) * inverse_length; };
  g.turn_u = turn(normals[1] - normals[0]), g.turn_v = turn(normals[2] - normals[0]);
  return g;
}

vec3 TraceScene::perturbNormal(const Placed& placed, const SurfacePoint& point, vec3 normal) const {
  const TextureRef& reference = placed.material->normal_texture;
  const Mesh& mesh = *placed.mesh;
  const uvec3& triangle = placed.triangles[point.triangle];
  vec3 tangent(0), bitangent(0);
  if (!mesh.tangents.empty() && reference.texcoord == 0) {
    const vec4 t = (1.0F - point.u - point.v) * mesh.tangents[triangle.x] + point.u * mesh.tangents[triangle.y] +
                   point.v * mesh.tangents[triangle.z];
    tangent = transformVector(placed.world_from_object, vec3(t));
    tangent -= dot(tangent, normal) * normal;
    const float handedness = (placed.mirrored ? -1.0F : 1.0F) * (t.w < 0.0F ? -1.0F : 1.0F);
    bitangent = handedness * cross(normal, tangent);
  } else {
    // From the derivative of the position by the texture coordinates of this triangle.
    const auto& uvs = mesh.texcoords[reference.texcoord];
    if (uvs.empty()) return normal;
    vec3 corners[3];
    for (int k = 0; k < 3; ++k) {
      corners[k] = placed.packed[point.triangle].corners[k];
      if (!placed.baked) corners[k] = transformPoint(placed.world_from_object, corners[k]);
    }
    const vec2 du = uvs[triangle.y] - uvs[triangle.x], dv = uvs[triangle.z] - uvs[triangle.x];
    const float determinant = du.x * dv.y - du.y * dv.x;
    if (determinant == 0.0F) return normal;
    const vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    tangent = (dv.y * e1 - du.y * e2) / determinant;
    // glTF's V runs down the image while tangent space's Y runs up it: the bitangent is against V.
    bitangent = -(du.x * e2 - dv.x * e1) / determinant;
    tangent -= dot(tangent, normal) * normal;
    bitangent -= dot(bitangent, normal) * normal;
  }
  if (dot(tangent, tangent) == 0.0F || dot(bitangent, bitangent) == 0.0F) return normal;
  const vec2 uv = texcoordAt(point.instance, point.triangle, point.u, point.v, reference.texcoord);
  const vec4 texel = sampleTexture(scene_.images[reference.image], reference, uv, false);
  const vec2 slope = placed.material->normal_scale * (2.0F * vec2(texel) - 1.0F);
  const vec3 perturbed = normalize(slope.x * normalize(tangent) + slope.y * normalize(bitangent) +
                                   std::max(2.0F * texel.z - 1.0F, 1e-3F) * normal);
  return dot(perturbed, point.normal_geometric) > 0.0F ? perturbed : normal;
}

vec2 TraceScene::texcoordAt(std::uint32_t instance, std::uint32_t triangle, float u, float v, int set) const {
  const Placed& placed = placed_[instance];
  const auto& uvs = placed.mesh->texcoords[set];
  if (uvs.empty()) return vec2(0.0F);
  const uvec3& t = placed.triangles[triangle];
  return (1.0F - u - v) * uvs[t.x] + u * uvs[t.y] + v * uvs[t.z];
}

vec4 TraceScene::colorAt(std::uint32_t instance, std::uint32_t triangle, float u, float v) const {
  const Placed& placed = placed_[instance];
  const auto& colors = placed.mesh->colors;
  if (colors.empty()) return vec4(1.0F);
  const uvec3& t = placed.triangles[triangle];
  return (1.0F - u - v) * colors[t.x] + u * colors[t.y] + v * colors[t.z];
}

void TraceScene::triangleCorners(std::uint32_t instance, std::uint32_t triangle, vec3 corners[3]) const {
  const Placed& placed = placed_[instance];
  for (int k = 0; k < 3; ++k) {
    corners[k] = placed.packed[triangle].corners[k];
    if (!placed.baked) corners[k] = transformPoint(placed.world_from_object, corners[k]);
  }
  if (placed.mirrored) std::swap(corners[1], corners[2]);
}

}  // namespace nephroid
