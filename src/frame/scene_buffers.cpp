#include "frame/scene_buffers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/optics/fresnel_average.h"
#include "core/optics/photon.shared.h"
#include "core/optics/surface.shared.h"
#include "core/parallel.h"
#include "frame/passes.h"
#include "frame/table.h"
#include "nephroid/error.h"
#include "scene/mesh_topology.h"

namespace nephroid {
namespace {

vec4 row(const mat4& m, int r) { return {m[0][r], m[1][r], m[2][r], m[3][r]}; }

/// May light or sight pass straight through some of it?
bool isPassable(const Material& m) {
  if (m.alpha_mode != AlphaMode::kOpaque) return true;
  if (!m.transmits() || m.isSolidDielectric()) return false;
  const float roughness = std::clamp(m.roughness, 0.0F, 1.0F);
  return roughness * roughness < kDeltaAlpha || m.metallic_roughness_texture.valid();
}

float longestEdgeOf(const Mesh& mesh) {
  float squared = 0.0F;
  for (const uvec3& t : mesh.triangles) {
    const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    squared = std::max({squared, dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
  }
  return std::sqrt(squared);
}

/// A bound for how many times longer a transform makes things, exact for turning and scaling: no eigenvalue of a matrix
/// is beyond the largest sum of a row.
float stretchOf(const mat4& m) {
  const mat3 squared = glm::transpose(mat3(m)) * mat3(m);
  float largest = 0.0F;
  for (int i = 0; i < 3; ++i)
    largest = std::max(largest, std::abs(squared[i].x) + std::abs(squared[i].y) + std::abs(squared[i].z));
  return std::sqrt(largest);
}

/// Images that materials refer to, one behind the other.
class TexelTables {
 public:
  explicit TexelTables(const std::vector<TextureImage>& images) : images_(images), first_(images.size(), kNowhere) {}

  /// @return  index of the record, kNowhere if there is no texture
  std::uint32_t add(const TextureRef& reference) {
    if (!reference.valid()) return kNowhere;
    const DecodedImage& image = images_[reference.image].image;
    if (first_[reference.image] == kNowhere)
      first_[reference.image] = std::visit([&](const auto& i) { return append(i); }, image);
    TextureRecord record{};
    record.first_texel = first_[reference.image];
    std::visit(
        [&](const auto& i) {
          record.width = static_cast<std::uint32_t>(i.width), record.height = static_cast<std::uint32_t>(i.height);
        },
        image);
    record.flags = (std::holds_alternative<Image>(image) ? kTextureIsFloat : 0U) |
                   (reference.nearest ? kTextureIsNearest : 0U) | (reference.texcoord == 1 ? kTextureSecondSet : 0U) |
                   static_cast<std::uint32_t>(reference.wrap_u) << kTextureWrapU |
                   static_cast<std::uint32_t>(reference.wrap_v) << kTextureWrapV;
    const mat3 rows = glm::transpose(reference.uv_from_texcoord);
    record.row_u = rows[0];
    record.row_v = rows[1];
    records_.push_back(record);
    return static_cast<std::uint32_t>(records_.size() - 1);
  }

  const std::vector<TextureRecord>& records() const { return records_; }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  const std::vector<vec4>& floats() const { return floats_; }

 private:
  /// Texels are numbered in 32 bits, and tables have fewer anyway.
  static std::uint32_t numberOf(std::size_t texel) {
    if (texel > std::numeric_limits<std::uint32_t>::max()) throw ResourceError("the textures have too many texels");
    return static_cast<std::uint32_t>(texel);
  }
  std::uint32_t append(const ByteImage& image) {
    const std::uint32_t first = numberOf(bytes_.size() / 4);
    bytes_.insert(bytes_.end(), image.pixels.begin(), image.pixels.end());
    return first;
  }
  std::uint32_t append(const Image& image) {
    const std::uint32_t first = numberOf(floats_.size());
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        floats_.emplace_back(image.rgb(x, y), image.channels == 4 ? image.at(x, y)[3] : 1.0F);
    return first;
  }

  const std::vector<TextureImage>& images_;
  std::vector<std::uint32_t> first_;  ///< texel, by image
  std::vector<TextureRecord> records_;
  std::vector<std::uint8_t> bytes_;
  std::vector<vec4> floats_;
};

bool hasTextures(const Material& m) {
  const TextureRef* references[] = {&m.base_color_texture,    &m.metallic_roughness_texture, &m.normal_texture,
                                    &m.emission_texture,      &m.transmission_texture,       &m.specular_texture,
                                    &m.specular_color_texture};
  return std::ranges::any_of(references, [](const TextureRef* reference) { return reference->valid(); });
}

MaterialRecord describeMaterial(const Material& m, TexelTables& texels, float specular_alpha) {
  MaterialRecord record{};
  record.base = m.base_color;
  record.emission = m.emission;
  record.metallic = m.metallic;
  record.specular_tint = m.specular_factor * m.specular_color;
  record.roughness = m.roughness;
  record.transmission = m.transmission;
  record.ior = m.ior;
  record.average_fresnel = averageFresnelDielectric(m.ior);
  if (m.conductor_ior) {
    record.conductor_ior = *m.conductor_ior;
    record.conductor_k = m.conductor_k;
    record.flags |= kMaterialHasConductor;
  }
  if (m.isSolidDielectric()) record.flags |= kMaterialIsSolid;
  if (m.double_sided) record.flags |= kMaterialDoubleSided;
  if (m.alpha_mode == AlphaMode::kMask) record.flags |= kMaterialIsMask;
  if (m.alpha_mode == AlphaMode::kBlend) record.flags |= kMaterialIsBlend;
  if (isSpecular(m, specular_alpha)) record.flags |= kMaterialIsSpecular;
  if (hasTextures(m)) record.flags |= kMaterialVaries;
  record.alpha_cutoff = m.alpha_cutoff;
  record.normal_scale = m.normal_scale;
  record.base_texture = texels.add(m.base_color_texture);
  record.metallic_roughness_texture = texels.add(m.metallic_roughness_texture);
  record.normal_texture = texels.add(m.normal_texture);
  record.emission_texture = texels.add(m.emission_texture);
  record.transmission_texture = texels.add(m.transmission_texture);
  record.specular_texture = texels.add(m.specular_texture);
  record.specular_color_texture = texels.add(m.specular_color_texture);
  record.priority = m.priority;
  record.sigma_a = m.sigmaA();
  record.dispersion = m.dispersion;
  return record;
}

/// What lobes of class D a material may have: textures multiply factors that are largest without them, but may leave
/// parts of a metal or of glass that are neither.
void addTraits(SceneTraits& traits, const Material& m, float specular_alpha) {
  const float roughness = std::clamp(m.roughness, 0.0F, 1.0F), alpha = roughness * roughness;
  const bool varies = m.metallic_roughness_texture.valid() || m.transmission_texture.valid();
  const bool has_base = varies || (m.metallic < 1.0F && m.transmission < 1.0F);
  const bool has_interface = alpha >= specular_alpha;
  const bool has_gloss = varies || (glossOf(alpha, std::clamp(m.transmission, 0.0F, 1.0F)) > 0.0F && m.metallic < 1.0F);
  // Gloss takes from the base what it reflects, also where its own lobe is class S.
  traits.gloss = traits.gloss || (has_gloss && (has_base || has_interface));
  traits.metal = traits.metal || (m.metallic > 0.0F && (has_base || has_interface));
  traits.conductors = traits.conductors || m.conductor_ior.has_value();
  traits.passable = traits.passable || isPassable(m);

  SpecularTraits& s = traits.specular;
  s.metal = s.metal || m.metallic > 0.0F;
  s.transmits = s.transmits || m.transmits();
  s.media = s.media || (m.isSolidDielectric() && m.sigmaA() != vec3(0.0F));
  s.disperses = s.disperses || (m.isSolidDielectric() && m.dispersion > 0.0F);
  if (!isSpecular(m, specular_alpha)) return;
  s.present = true;
  s.rough = s.rough || m.metallic_roughness_texture.valid() || alpha >= kDeltaAlpha;
}

/// One value of each corner of each triangle; `floats` of them, padded to whole texels for all three together.
template <class Value>
std::uint32_t appendAttribute(std::vector<vec4>& table, const Mesh& mesh, const std::vector<Value>& values) {
  if (values.empty()) return kNowhere;
  const auto first = static_cast<std::uint32_t>(table.size());
  for (const uvec3& t : mesh.triangles) {
    if constexpr (std::is_same_v<Value, vec2>) {
      table.emplace_back(values[t.x], values[t.y]);
      table.emplace_back(values[t.z], vec2(0.0F));
    } else {
      table.insert(table.end(), {values[t.x], values[t.y], values[t.z]});
    }
  }
  return first;
}

/// Which attributes of a mesh some texture asks for.
struct WantedAttributes {
  bool texcoords[2] = {false, false}, tangents = false;
};

WantedAttributes inspectTextures(const Material& m) {
  WantedAttributes wanted;
  for (const TextureRef* reference :
       {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.emission_texture,
        &m.transmission_texture, &m.specular_texture, &m.specular_color_texture})
    if (reference->valid()) wanted.texcoords[reference->texcoord == 1 ? 1 : 0] = true;
  wanted.tangents = m.normal_texture.valid();
  return wanted;
}

std::uint32_t packNormal(const Mesh& mesh, std::uint32_t vertex) {
  if (mesh.normals.empty()) return 0;
  const vec3 n = mesh.normals[vertex];
  return isFinite(n) && dot(n, n) > 0.0F ? packUnitVector(n) : 0;
}

}  // namespace

bool isSpecular(const Material& m, float specular_alpha) {
  const float roughness = std::clamp(m.roughness, 0.0F, 1.0F);
  const bool fine = roughness * roughness < specular_alpha || m.metallic_roughness_texture.valid();
  const bool varnished = m.specular_factor > 0.0F && m.ior != 1.0F;
  return fine && (m.metallic > 0.0F || m.transmits() || varnished);
}

std::vector<gpu::Constant> SceneTraits::constants() const {
  return {{0, metal}, {1, gloss}, {2, conductors}, {3, textures}, {4, passable}};
}

std::vector<gpu::Constant> SceneTraits::pathConstants() const {
  return {{0, specular.metal},
          {1, true},
          {2, conductors},
          {3, textures},
          {4, passable},
          {8, specular.rough},
          {9, specular.transmits},
          {10, specular.media},
          {11, specular.disperses},
          {19, metal || gloss}};
}

SceneBuffers::SceneBuffers(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene,
                           float specular_alpha)
    : sampler_(device, {.filter = VK_FILTER_NEAREST}, "tables"), classes_(classifyMaterials(scene, specular_alpha)) {
  for (const Material& material : scene.materials) addTraits(traits_, material, specular_alpha);
  uploadMeshes(device, recorder, scene);
  updateInstances(device, recorder, scene);
  uploadMaterials(device, recorder, scene, specular_alpha);
}

void SceneBuffers::uploadMeshes(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene) {
  places_.resize(scene.meshes.size());
  std::size_t vertices = 0, triangles = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    places_[i].first_vertex = static_cast<std::uint32_t>(vertices);
    places_[i].first_triangle = static_cast<std::uint32_t>(triangles);
    vertices += scene.meshes[i].positions.size();
    triangles += scene.meshes[i].triangles.size();
  }
  std::vector<vec3> positions(vertices);
  std::vector<uvec3> indices(triangles);
  std::vector<TriangleRecord> records(triangles);
  std::vector<vec4> attributes;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    std::copy(mesh.positions.begin(), mesh.positions.end(), positions.begin() + places_[i].first_vertex);
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), indices.begin() + places_[i].first_triangle);
    TriangleRecord* first = records.data() + places_[i].first_triangle;
    parallelFor(mesh.triangles.size(), [&](std::size_t k) {
      const uvec3 t = mesh.triangles[k];
      first[k] = {mesh.positions[t.x],   packNormal(mesh, t.x), mesh.positions[t.y],
                  packNormal(mesh, t.y), mesh.positions[t.z],   packNormal(mesh, t.z)};
    });
    places_[i].longest_edge = longestEdgeOf(mesh);
    const WantedAttributes wanted = inspectTextures(scene.materials[mesh.material]);
    for (int set = 0; set < 2; ++set)
      if (wanted.texcoords[set]) places_[i].texcoords[set] = appendAttribute(attributes, mesh, mesh.texcoords[set]);
    places_[i].colors = appendAttribute(attributes, mesh, mesh.colors);
    if (wanted.tangents) places_[i].tangents = appendAttribute(attributes, mesh, mesh.tangents);
    traits_.textures = traits_.textures || wanted.texcoords[0] || wanted.texcoords[1] || !mesh.colors.empty();
  }
  positions_ = gpu::makeBuffer<vec3>(device, recorder, positions, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "positions");
  indices_ = gpu::makeBuffer<uvec3>(device, recorder, indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "indices");
  triangles_ = makeTable<TriangleRecord>(device, recorder, records, "triangles");
  attributes_ = makeTable<vec4>(device, recorder, attributes, "attributes");
  uploadNeighbours(device, recorder, scene, triangles);
}

void SceneBuffers::uploadNeighbours(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene,
                                    std::size_t triangles) {
  static_assert(kNoNeighbour == kNowhere);
  std::vector<glm::uvec4> records;
  const bool wanted = std::ranges::any_of(classes_, &Classification::is_generator);
  if (wanted) records.resize(triangles, glm::uvec4(kNowhere));
  if (wanted)
    parallelFor(places_.size(), [&](std::size_t i) {
      const std::vector<uvec3> found = findNeighbours(scene.meshes[i]);
      bool is_closed = !found.empty();
      for (std::size_t k = 0; k < found.size(); ++k) {
        records[places_[i].first_triangle + k] = glm::uvec4(found[k], 0);
        is_closed = is_closed && found[k].x != kNowhere && found[k].y != kNowhere && found[k].z != kNowhere;
      }
      places_[i].is_closed = is_closed;
    });
  neighbours_ = makeTable<glm::uvec4>(device, recorder, records, "neighbours");
}

void SceneBuffers::updateInstances(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene) {
  draws_.clear();
  std::vector<InstanceRecord> instances;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> solids;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    const MeshPlace& place = places_[instance.mesh];
    const mat4& m = instance.world_from_object;
    InstanceRecord record{
        .row_x = row(m, 0),
        .row_y = row(m, 1),
        .row_z = row(m, 2),
        .first_triangle = place.first_triangle,
        .material = mesh.material,
        .solid = solids.try_emplace({instance.object, mesh.material}, static_cast<std::uint32_t>(solids.size()))
                     .first->second,
        .texcoords_0 = place.texcoords[0],
        .texcoords_1 = place.texcoords[1],
        .colors = place.colors,
        .tangents = place.tangents};
    const bool passable = isPassable(scene.materialOf(instance));
    if (glm::determinant(mat3(m)) < 0.0F) record.flags |= kInstanceMirrored;
    if (!mesh.normals.empty()) record.flags |= kInstanceHasNormals;
    if (passable) record.flags |= kInstancePassable;
    const bool generates = instance.casts && classes_[mesh.material].is_generator;
    if (generates) record.flags |= kInstanceGenerates;
    if (place.is_closed) record.flags |= kInstanceClosed;
    if (classes_[mesh.material].is_receiver) record.flags |= kInstanceReceives;
    if (classes_[mesh.material].is_receiver || scene.materialOf(instance).emits()) record.flags |= kInstanceIsLit;
    instances.push_back(record);
    if (mesh.triangles.empty()) continue;
    Bounds bounds;
    for (const vec3& p : mesh.positions) bounds.add(transformPoint(m, p));
    draws_.push_back({.instance = static_cast<std::uint32_t>(i),
                      .index_count = static_cast<std::uint32_t>(3 * mesh.triangles.size()),
                      .first_index = 3 * place.first_triangle,
                      .vertex_offset = static_cast<std::int32_t>(place.first_vertex),
                      .passable = passable,
                      .generates = generates,
                      .receives = classes_[mesh.material].is_receiver,
                      .closed = place.is_closed,
                      .bounds = bounds,
                      .longest_edge = place.longest_edge * stretchOf(m)});
  }
  instances_ = makeTable<InstanceRecord>(device, recorder, instances, "instances");
}

void SceneBuffers::uploadMaterials(gpu::Device& device, gpu::CommandRecorder& recorder, const SceneData& scene,
                                   float specular_alpha) {
  TexelTables texels(scene.images);
  std::vector<MaterialRecord> records;
  for (const Material& material : scene.materials)
    records.push_back(describeMaterial(material, texels, specular_alpha));
  materials_ = makeTable<MaterialRecord>(device, recorder, records, "materials");
  textures_ = makeTable<TextureRecord>(device, recorder, texels.records(), "textures");
  byte_texels_ = makeTexelTable(device, recorder, VK_FORMAT_R8G8B8A8_UNORM, std::as_bytes(std::span(texels.bytes())),
                                "texels of textures");
  float_texels_ = makeTexelTable(device, recorder, VK_FORMAT_R32G32B32A32_SFLOAT,
                                 std::as_bytes(std::span(texels.floats())), "texels of float textures");
}

std::vector<gpu::Binding> SceneBuffers::bindings(std::initializer_list<VkDescriptorType> types) {
  std::vector<gpu::Binding> all;
  for (std::uint32_t i = 0; i < kBindings; ++i) all.push_back({i, kTexels});
  for (const VkDescriptorType type : types) all.push_back({static_cast<std::uint32_t>(all.size()), type});
  return all;
}

std::vector<gpu::Bound> SceneBuffers::bound(std::initializer_list<gpu::Bound> more) const {
  std::vector<gpu::Bound> all{{0, triangles_}, {1, instances_},   {2, materials_},   {3, attributes_},
                              {4, textures_},  {5, byte_texels_}, {6, float_texels_}};
  all.insert(all.end(), more);
  return all;
}

std::vector<gpu::Use> SceneBuffers::uses(gpu::Access access, std::initializer_list<gpu::Use> more) const {
  std::vector<gpu::Use> all{{triangles_, access}, {instances_, access},   {materials_, access},   {attributes_, access},
                            {textures_, access},  {byte_texels_, access}, {float_texels_, access}};
  all.insert(all.end(), more);
  return all;
}

}  // namespace nephroid
