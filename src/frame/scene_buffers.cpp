#include "frame/scene_buffers.h"

#include <algorithm>
#include <cmath>

#include "core/optics/fresnel_average.h"
#include "scene/classify.h"

namespace nephroid {
namespace {

vec4 row(const mat4& m, int r) { return {m[0][r], m[1][r], m[2][r], m[3][r]}; }

bool isPane(const Material& material) { return material.transmits() && !material.isSolidDielectric(); }

/// @see MaterialTable::resolve, which does the same where textures vary.
MaterialRecord describeMaterial(const Material& material) {
  MaterialRecord record{};
  const float roughness = std::clamp(material.roughness, 0.0F, 1.0F);
  record.base = glm::clamp(vec3(material.base_color), 0.0F, 1.0F);
  record.metallic = std::clamp(material.metallic, 0.0F, 1.0F);
  record.specular_tint = glm::clamp(material.specular_factor * material.specular_color, 0.0F, 1.0F);
  record.alpha = roughness * roughness;
  record.emission = material.emission;
  record.transmission = std::clamp(material.transmission, 0.0F, 1.0F);
  record.gloss = glossOf(record.alpha, record.transmission);
  if (record.alpha < kDeltaAlpha) record.alpha = 0.0F;
  record.ior = material.ior;
  record.average_fresnel = averageFresnelDielectric(material.ior);
  if (material.conductor_ior) {
    record.conductor_ior = *material.conductor_ior;
    record.conductor_k = material.conductor_k;
    record.flags |= kMaterialHasConductor;
  }
  if (isPane(material)) record.flags |= kMaterialIsPane;
  if (material.isSolidDielectric()) record.flags |= kMaterialIsSolid;
  if (material.double_sided) record.flags |= kMaterialDoubleSided;
  return record;
}

/// All meshes behind each other.
struct Tables {
  std::vector<vec3> positions, normals;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> first_vertex, first_index;  ///< by mesh
};

Tables joinMeshes(const std::vector<Mesh>& meshes) {
  Tables tables;
  std::size_t vertices = 0, triangles = 0;
  for (const Mesh& mesh : meshes) vertices += mesh.positions.size(), triangles += mesh.triangles.size();
  tables.positions.reserve(vertices);
  tables.normals.reserve(vertices);
  tables.indices.reserve(3 * triangles);
  for (const Mesh& mesh : meshes) {
    tables.first_vertex.push_back(static_cast<std::uint32_t>(tables.positions.size()));
    tables.first_index.push_back(static_cast<std::uint32_t>(tables.indices.size()));
    tables.positions.insert(tables.positions.end(), mesh.positions.begin(), mesh.positions.end());
    tables.normals.insert(tables.normals.end(), mesh.normals.begin(), mesh.normals.end());
    tables.normals.resize(tables.positions.size());
    for (const uvec3& t : mesh.triangles) tables.indices.insert(tables.indices.end(), {t.x, t.y, t.z});
  }
  return tables;
}

}  // namespace

std::vector<gpu::Binding> sceneBindings() {
  std::vector<gpu::Binding> bindings;
  for (std::uint32_t i = 0; i < 5; ++i) bindings.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  return bindings;
}

SceneBuffers::SceneBuffers(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene) {
  const Tables tables = joinMeshes(scene.meshes);
  std::vector<InstanceRecord> instances;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const mat4& m = instance.world_from_object;
    InstanceRecord record{.row_x = row(m, 0),
                          .row_y = row(m, 1),
                          .row_z = row(m, 2),
                          .first_vertex = tables.first_vertex[instance.mesh],
                          .first_index = tables.first_index[instance.mesh],
                          .material = mesh.material};
    if (glm::determinant(mat3(m)) < 0.0F) record.flags |= kInstanceMirrored;
    if (!mesh.normals.empty()) record.flags |= kInstanceHasNormals;
    instances.push_back(record);
    if (mesh.triangles.empty()) continue;
    Bounds bounds;
    for (const vec3& p : mesh.positions) bounds.add(transformPoint(m, p));
    draws_.push_back({.instance = static_cast<std::uint32_t>(i),
                      .index_count = static_cast<std::uint32_t>(3 * mesh.triangles.size()),
                      .first_index = record.first_index,
                      .vertex_offset = static_cast<std::int32_t>(record.first_vertex),
                      .bounds = bounds});
  }
  for (const Material& material : scene.materials) material_records_.push_back(describeMaterial(material));

  constexpr VkBufferUsageFlags kTable = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  instances_ = gpu::makeBuffer<InstanceRecord>(device, recorder, instances, kTable, "instances");
  materials_ = gpu::makeBuffer<MaterialRecord>(device, recorder, material_records_, kTable, "materials");
  positions_ = gpu::makeBuffer<vec3>(device, recorder, tables.positions, kTable | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                                     "positions");
  normals_ = gpu::makeBuffer<vec3>(device, recorder, tables.normals, kTable, "normals");
  indices_ = gpu::makeBuffer<std::uint32_t>(device, recorder, tables.indices, kTable | VK_BUFFER_USAGE_INDEX_BUFFER_BIT,
                                            "indices");
}

SceneBuffers::Receivers SceneBuffers::inspectReceivers(float specular_alpha) const {
  Receivers receivers;
  for (const MaterialRecord& m : material_records_) {
    const bool has_base = m.metallic < 1.0F && m.transmission < 1.0F, has_interface = m.alpha >= specular_alpha;
    // Gloss takes from the base what it reflects, also where its own lobe is class S.
    receivers.gloss = receivers.gloss || (m.gloss > 0.0F && m.metallic < 1.0F && (has_base || has_interface));
    receivers.metal = receivers.metal || (m.metallic > 0.0F && (has_base || has_interface));
    receivers.conductors = receivers.conductors || (m.flags & kMaterialHasConductor) != 0;
  }
  return receivers;
}

std::vector<gpu::Bound> SceneBuffers::bound() const {
  return {{0, instances_}, {1, materials_}, {2, positions_}, {3, normals_}, {4, indices_}};
}

std::vector<gpu::Use> SceneBuffers::uses(gpu::Access access) const {
  return {{instances_, access}, {materials_, access}, {positions_, access}, {normals_, access}, {indices_, access}};
}

}  // namespace nephroid
