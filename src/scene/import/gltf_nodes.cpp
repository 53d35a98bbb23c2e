#include "scene/import/gltf_nodes.h"

#include <fmt/format.h>

#include <optional>

#include "scene/import/gltf_geometry.h"
#include "scene/import/gltf_materials.h"
#include "scene/import/gltf_value.h"

namespace nephroid::gltf {
namespace {

/// World coordinates beyond this are taken for a broken transform: see mesh_repair.cpp.
constexpr float kMaxEntry = 1e18F;
/// More placed meshes than this are refused: what a small hostile file could ask for with instancing.
constexpr std::size_t kMaxInstances = std::size_t{1} << 24;

bool isSane(const mat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!(std::abs(m[c][r]) <= kMaxEntry)) return false;
  return true;
}

/// Whether the map keeps solids solid: its determinant against the product of the lengths of its axes, which does not
/// depend on scale. 1e-6 is where single precision no longer tells the axes' plane from a volume.
bool isInvertible(const mat4& m) {
  const glm::dvec3 x(m[0]), y(m[1]), z(m[2]);
  const double lengths = glm::length(x) * glm::length(y) * glm::length(z);
  return lengths > 0 && std::abs(glm::dot(x, glm::cross(y, z))) > 1e-6 * lengths;
}

std::string placeOfNode(const Document& document, std::size_t node) {
  return placeOf("nodes", node, document.model.nodes[node].name);
}

vec3 toVec3(const std::vector<double>& values, vec3 fallback) {
  if (values.size() != 3) return fallback;
  return {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])};
}

quat readRotation(Document& document, const std::vector<double>& values, const std::string& place) {
  if (values.size() != 4) return {1, 0, 0, 0};
  const glm::dquat rotation(values[3], values[0], values[1], values[2]);
  const double length = glm::length(rotation);
  if (!(length > 0)) {
    document.warn(place, "rotation is a zero quaternion; not rotated");
    return {1, 0, 0, 0};
  }
  return quat(rotation / length);
}

mat4 readMatrix(const Document& document, const std::vector<double>& values, const std::string& place) {
  mat4 m;
  for (std::size_t i = 0; i < 16; ++i)
    m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = static_cast<float>(values[i]);
  if (m[0].w != 0 || m[1].w != 0 || m[2].w != 0 || m[3].w != 1)
    document.fail(place, "matrix has a last row other than 0 0 0 1; only affine transforms are possible");
  return m;
}

/// The parent of each node, −1 for roots.
std::vector<int> findParents(const Document& document) {
  const auto& nodes = document.model.nodes;
  std::vector<int> parents(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) {
      if (child < 0 || static_cast<std::size_t>(child) >= nodes.size())
        document.fail(placeOfNode(document, i),
                      fmt::format("child {} does not exist; the file has {} nodes", child, nodes.size()));
      int& parent = parents[static_cast<std::size_t>(child)];
      if (parent >= 0)
        document.fail(placeOfNode(document, static_cast<std::size_t>(child)),
                      fmt::format("has two parents, {} and {}; expected a tree", parent, i));
      parent = static_cast<int>(i);
    }
  }
  return parents;
}

/// Nodes from the roots down: each after its parent.
std::vector<std::size_t> sortParentsFirst(const Document& document, const std::vector<int>& parents) {
  const auto& nodes = document.model.nodes;
  std::vector<std::size_t> order;
  order.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (parents[i] < 0) order.push_back(i);
  for (std::size_t next = 0; next < order.size(); ++next)
    for (const int child : nodes[order[next]].children) order.push_back(static_cast<std::size_t>(child));
  if (order.size() < nodes.size()) document.fail("nodes", "some node is its own ancestor; expected a tree");
  return order;
}

/// The nodes that the default scene lists.
std::vector<bool> findSceneRoots(Document& document, const std::vector<int>& parents) {
  const tinygltf::Model& model = document.model;
  std::vector<bool> roots(model.nodes.size(), false);
  if (model.scenes.empty()) {
    if (!model.nodes.empty()) document.warn("scenes", "the file has no scene; all nodes are shown");
    for (std::size_t i = 0; i < roots.size(); ++i) roots[i] = parents[i] < 0;
    return roots;
  }
  const int index = model.defaultScene < 0 ? 0 : model.defaultScene;
  if (static_cast<std::size_t>(index) >= model.scenes.size())
    document.fail("scene", fmt::format("{} does not exist; the file has {} scenes", index, model.scenes.size()));
  if (model.scenes.size() > 1)
    document.warn("scenes", fmt::format("the file has {}; scene {} is shown", model.scenes.size(), index));
  for (const int node : model.scenes[static_cast<std::size_t>(index)].nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= roots.size())
      document.fail(placeOf("scenes", static_cast<std::size_t>(index)),
                    fmt::format("node {} does not exist; the file has {}", node, roots.size()));
    roots[static_cast<std::size_t>(node)] = true;
    if (parents[static_cast<std::size_t>(node)] >= 0)
      document.warn(placeOf("scenes", static_cast<std::size_t>(index)),
                    fmt::format("lists node {}, which is no root; shown under its parent", node));
  }
  return roots;
}

/// The transforms of EXT_mesh_gpu_instancing relative to the node; one identity if the node does not use it.
std::vector<mat4> readInstancing(Document& document, AccessorReader& reader, const tinygltf::Node& node,
                                 const std::string& node_place) {
  const tinygltf::Value& extension = getExtension(node.extensions, "EXT_mesh_gpu_instancing");
  if (!isPresent(extension)) return {mat4(1.0F)};
  const std::string place = node_place + ".EXT_mesh_gpu_instancing";
  const tinygltf::Value& attributes = getMember(extension, "attributes");
  std::vector<LocalTransform> locals;
  const auto forEach = [&](const char* name, const auto& read, const auto& use) {
    const int accessor = getInt(attributes, name, -1);
    if (accessor < 0) return;
    const auto values = read(accessor, place + "." + name);
    if (locals.empty()) locals.resize(values.size());
    if (locals.size() != values.size())
      document.fail(place, fmt::format("{} has {} elements, others have {}", name, values.size(), locals.size()));
    for (std::size_t i = 0; i < values.size(); ++i) use(locals[i], values[i]);
  };
  const auto read3 = [&](int accessor, const std::string& at) { return reader.readVec3(accessor, at); };
  const auto read4 = [&](int accessor, const std::string& at) { return reader.readVec4(accessor, at); };
  forEach("TRANSLATION", read3, [](LocalTransform& local, vec3 v) { local.translation = v; });
  forEach("SCALE", read3, [](LocalTransform& local, vec3 v) { local.scale = v; });
  forEach("ROTATION", read4, [](LocalTransform& local, vec4 v) {
    const float length = glm::length(v);
    if (length > 0) local.rotation = quat(v.w, v.x, v.y, v.z) / length;
  });
  std::vector<mat4> transforms;
  transforms.reserve(locals.size());
  for (const LocalTransform& local : locals) transforms.push_back(local.toMatrix());
  return transforms;
}

/// Meshes of the scene by glTF mesh, read when first needed: what no node shows is never looked at.
class MeshCache {
 public:
  MeshCache(Document& document, AccessorReader& reader, SceneData& scene)
      : document_(document), reader_(reader), scene_(scene), meshes_(document.model.meshes.size()) {}

  /// Indices into scene.meshes of the primitives of a glTF mesh.
  const std::vector<std::uint32_t>& get(std::size_t mesh) {
    if (!meshes_[mesh]) {
      meshes_[mesh].emplace();
      for (Mesh& part : readMesh(document_, reader_, mesh, [this](int material) { return findMaterial(material); })) {
        checkTexcoords(part);
        meshes_[mesh]->push_back(static_cast<std::uint32_t>(scene_.meshes.size()));
        scene_.meshes.push_back(std::move(part));
      }
    }
    return *meshes_[mesh];
  }

 private:
  std::uint32_t findMaterial(int material) {
    const std::size_t count = document_.model.materials.size();
    if (material >= 0) {
      if (static_cast<std::size_t>(material) >= count)
        document_.fail("meshes", fmt::format("a primitive has material {}, the file has {}", material, count));
      return static_cast<std::uint32_t>(material);
    }
    // glTF's default material stands after those of the file.
    if (scene_.materials.size() == count) scene_.materials.push_back(makeDefaultMaterial());
    return static_cast<std::uint32_t>(count);
  }

  /// Says where a texture has no coordinates to be looked up with.
  void checkTexcoords(const Mesh& mesh) {
    const Material& material = scene_.materials[mesh.material];
    for (const TextureRef* texture :
         {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
          &material.emission_texture, &material.transmission_texture, &material.specular_texture,
          &material.specular_color_texture})
      if (texture->valid() && mesh.texcoords[texture->texcoord].empty())
        document_.warn(fmt::format("mesh '{}'", mesh.name),
                       fmt::format("has no UV set {}, which material '{}' needs; (0, 0) is used", texture->texcoord,
                                   material.name));
  }

  Document& document_;
  AccessorReader& reader_;
  SceneData& scene_;
  std::vector<std::optional<std::vector<std::uint32_t>>> meshes_;
};

}  // namespace

std::vector<LocalTransform> readLocalTransforms(Document& document) {
  std::vector<LocalTransform> locals;
  locals.reserve(document.model.nodes.size());
  for (std::size_t i = 0; i < document.model.nodes.size(); ++i) {
    const tinygltf::Node& node = document.model.nodes[i];
    LocalTransform local;
    if (node.matrix.size() == 16) {
      local.matrix = readMatrix(document, node.matrix, placeOfNode(document, i));
    } else {
      local.translation = toVec3(node.translation, vec3(0));
      local.rotation = readRotation(document, node.rotation, placeOfNode(document, i));
      local.scale = toVec3(node.scale, vec3(1));
    }
    locals.push_back(local);
  }
  return locals;
}

NodeGraph buildNodeGraph(Document& document, const std::vector<LocalTransform>& locals) {
  const std::vector<int> parents = findParents(document);
  NodeGraph graph;
  graph.world_from_node.resize(parents.size());
  graph.in_scene = findSceneRoots(document, parents);
  for (const std::size_t node : sortParentsFirst(document, parents)) {
    mat4& world = graph.world_from_node[node];
    world = locals[node].toMatrix();
    if (parents[node] >= 0) {
      const auto parent = static_cast<std::size_t>(parents[node]);
      world = graph.world_from_node[parent] * world;
      if (graph.in_scene[parent]) graph.in_scene[node] = true;
    }
    if (!isSane(world)) document.fail(placeOfNode(document, node), "its transform is not finite or absurdly large");
  }
  return graph;
}

void placeMeshes(Document& document, AccessorReader& reader, const NodeGraph& graph, SceneData& scene) {
  MeshCache cache(document, reader, scene);
  const auto& nodes = document.model.nodes;
  auto next_object = static_cast<std::uint32_t>(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!graph.in_scene[i] || nodes[i].mesh < 0) continue;
    const std::string place = placeOfNode(document, i);
    if (static_cast<std::size_t>(nodes[i].mesh) >= document.model.meshes.size())
      document.fail(
          place, fmt::format("mesh {} does not exist; the file has {}", nodes[i].mesh, document.model.meshes.size()));
    if (nodes[i].skin >= 0) document.warn(place, "its skin is ignored; the rest pose is shown");
    const std::vector<std::uint32_t>& parts = cache.get(static_cast<std::size_t>(nodes[i].mesh));
    const std::vector<mat4> transforms = readInstancing(document, reader, nodes[i], place);
    const bool is_instanced = nodes[i].extensions.contains("EXT_mesh_gpu_instancing");
    if (transforms.size() * parts.size() > kMaxInstances - scene.instances.size())
      document.fail(place, fmt::format("more than {} placed meshes in all", kMaxInstances));
    for (std::size_t t = 0; t < transforms.size(); ++t) {
      Instance instance;
      instance.name = nodes[i].name.empty() ? placeOf("nodes", i) : cleanName(nodes[i].name);
      if (is_instanced) instance.name += fmt::format("#{}", t);
      instance.world_from_object = graph.world_from_node[i] * transforms[t];
      instance.object = is_instanced ? next_object++ : static_cast<std::uint32_t>(i);
      if (!isSane(instance.world_from_object))
        document.fail(place, "an instance's transform is not finite or absurdly large");
      if (!isInvertible(instance.world_from_object)) {
        document.warn(place, "is flattened by its scale and not shown");
        continue;
      }
      for (const std::uint32_t mesh : parts) {
        instance.mesh = mesh;
        scene.instances.push_back(instance);
      }
    }
  }
}

}  // namespace nephroid::gltf
