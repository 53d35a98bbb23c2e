// Meshes without a scene: PLY, OBJ and STL through Assimp, glTF through our own importer, merged into one.
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <memory>
#include <span>

#include "core/file.h"
#include "nephroid/error.h"
#include "scene/import/import.h"
#include "scene/import/mesh_repair.h"
#include "scene/import/ply_check.h"
#include "scene/import/text.h"

namespace nephroid {
namespace {

/// Triangles that meet at more than this keep an edge between them.
constexpr float kCreaseAngle = radians(60.0F);

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view problem) {
  throw InputError(fmt::format("{}: {}", cleanPath(path), problem));
}

std::string lowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension.empty() ? extension : extension.substr(1);
}

/// Serves the bytes of one mesh and nothing else: what it names beside itself (OBJ material libraries and their
/// textures) is not wanted.
///
/// Assimp's own ReadFileFromMemory is of no use here. It serves the mesh under any extension, and where a material
/// library is missing Assimp's OBJ reader asks for one named as the mesh: it then reads the mesh as materials, and
/// writes through a null pointer at a value that no "newmtl" precedes.
class OneFile : public Assimp::IOSystem {
 public:
  /// @param bytes  outlive this
  OneFile(std::span<const std::byte> bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}
  bool Exists(const char* name) const override { return name == name_; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override {
    if (!Exists(name)) return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::span<const std::byte> bytes_;
  std::string name_;
};

/// Leaves only the loader of `extension`: Assimp would otherwise try its fifty others on contents that it recognises.
void keepOnlyLoader(Assimp::Importer& importer, const std::string& extension) {
  const Assimp::BaseImporter* wanted = importer.GetImporter(importer.GetImporterIndex(extension.c_str()));
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* loader = importer.GetImporter(i);
    if (loader == wanted) continue;
    importer.UnregisterLoader(loader);
    delete loader;  // unregistering hands the loader to the caller
  }
}

mat4 toMat4(const aiMatrix4x4& m) {
  return {vec4(m.a1, m.b1, m.c1, m.d1), vec4(m.a2, m.b2, m.c2, m.d2), vec4(m.a3, m.b3, m.c3, m.d3),
          vec4(m.a4, m.b4, m.c4, m.d4)};
}

Mesh convertMesh(const aiMesh& source, const std::filesystem::path& path) {
  Mesh mesh;
  const auto toVec3 = [](const aiVector3D& v) { return vec3(v.x, v.y, v.z); };
  for (unsigned i = 0; i < source.mNumVertices; ++i) mesh.positions.push_back(toVec3(source.mVertices[i]));
  if (source.HasNormals())
    for (unsigned i = 0; i < source.mNumVertices; ++i) mesh.normals.push_back(toVec3(source.mNormals[i]));
  for (unsigned set = 0; set < 2; ++set)
    if (source.HasTextureCoords(set))
      for (unsigned i = 0; i < source.mNumVertices; ++i)
        mesh.texcoords[set].emplace_back(source.mTextureCoords[set][i].x, 1 - source.mTextureCoords[set][i].y);
  if (source.HasVertexColors(0))
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
      const aiColor4D& color = source.mColors[0][i];
      mesh.colors.emplace_back(color.r, color.g, color.b, color.a);
    }
  for (unsigned i = 0; i < source.mNumFaces; ++i) {
    const aiFace& face = source.mFaces[i];
    if (face.mNumIndices != 3) continue;
    for (unsigned k = 0; k < 3; ++k)
      if (face.mIndices[k] >= source.mNumVertices)
        fail(path, fmt::format("face {}: index {} is not below {} vertices", i, face.mIndices[k], source.mNumVertices));
    mesh.triangles.emplace_back(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
  }
  return mesh;
}

template <class T>
void appendOrFill(std::vector<T>& target, std::size_t target_count, const std::vector<T>& source,
                  std::size_t source_count, T fill) {
  if (target.empty() && source.empty()) return;
  target.resize(target_count, fill);
  target.insert(target.end(), source.begin(), source.end());
  target.resize(target_count + source_count, fill);
}

/// Appends `part`, transformed; a mirroring transform swaps two corners of each triangle, so that it still looks
/// outward.
void append(Mesh& target, const Mesh& part, const mat4& transform) {
  const std::size_t before = target.positions.size(), count = part.positions.size();
  const mat3 linear(transform);
  const float determinant = glm::determinant(linear);
  // Cofactors turn normals as the inverse transpose does, also where there is no inverse.
  const mat3 cofactors(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
  const float sign = determinant < 0 ? -1.0F : 1.0F;
  std::vector<vec3> normals;
  for (const vec3& n : part.normals) normals.push_back(sign * (cofactors * n));
  appendOrFill(target.normals, before, normals, count, vec3(0));
  for (int set = 0; set < 2; ++set) appendOrFill(target.texcoords[set], before, part.texcoords[set], count, vec2(0));
  appendOrFill(target.colors, before, part.colors, count, vec4(1));
  for (const vec3& p : part.positions) target.positions.push_back(transformPoint(transform, p));
  const auto offset = static_cast<std::uint32_t>(before);
  for (uvec3 t : part.triangles) {
    if (determinant < 0) std::swap(t.y, t.z);
    target.triangles.push_back(t + offset);
  }
}

/// A mesh and where it goes.
struct PlacedMesh {
  Mesh mesh;
  mat4 transform{1.0F};
};

/// One mesh of all parts, with normals: the file's, or smooth ones where it has none.
Mesh merge(std::vector<PlacedMesh> parts, const std::filesystem::path& path) {
  std::size_t vertex_count = 0;
  for (const PlacedMesh& part : parts) vertex_count += part.mesh.positions.size();
  if (vertex_count >= kNone) fail(path, fmt::format("{} vertices are more than 32-bit indices reach", vertex_count));
  const bool some_normals =
      std::any_of(parts.begin(), parts.end(), [](const PlacedMesh& part) { return !part.mesh.normals.empty(); });
  Mesh merged;
  for (PlacedMesh& part : parts) {
    if (const auto bad = findNonFinitePosition(part.mesh)) fail(path, fmt::format("vertex {} is not finite", *bad));
    // Where no part has normals they are computed after merging, across the parts.
    if (some_normals && part.mesh.normals.empty()) computeSmoothNormals(part.mesh, kCreaseAngle);
    append(merged, part.mesh, part.transform);
  }
  dropUnusedVertices(merged);
  if (merged.triangles.empty()) fail(path, "has no triangles");
  if (const auto bad = findNonFinitePosition(merged)) fail(path, fmt::format("vertex {} is not finite", *bad));
  if (merged.normals.empty()) computeSmoothNormals(merged, kCreaseAngle);
  repairAttributes(merged);
  merged.name = cleanPath(path.stem());
  return merged;
}

/// All meshes with their nodes' transforms, without recursion: nodes may nest as deep as they like.
std::vector<PlacedMesh> collectParts(const aiScene& scene, const std::filesystem::path& path) {
  std::vector<PlacedMesh> parts;
  std::vector<std::pair<const aiNode*, mat4>> todo;
  if (scene.mRootNode != nullptr) todo.emplace_back(scene.mRootNode, mat4(1.0F));
  while (!todo.empty()) {
    const auto [node, parent] = todo.back();
    todo.pop_back();
    const mat4 transform = parent * toMat4(node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; ++i)
      if (node->mMeshes[i] < scene.mNumMeshes)
        parts.push_back({convertMesh(*scene.mMeshes[node->mMeshes[i]], path), transform});
    for (unsigned i = 0; i < node->mNumChildren; ++i) todo.emplace_back(node->mChildren[i], transform);
  }
  return parts;
}

/// Assimp's later steps, its own validation among them, trust the indices that its readers took from the file.
void checkIndices(const aiScene& scene, const std::filesystem::path& path) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k)
        if (mesh.mFaces[f].mIndices[k] >= mesh.mNumVertices)
          fail(path, fmt::format("face {}: index {} is not below {} vertices", f, mesh.mFaces[f].mIndices[k],
                                 mesh.mNumVertices));
  }
}

Mesh importWithAssimp(const std::filesystem::path& path, const std::string& extension) {
  std::vector<std::byte> bytes = readFile(path, std::uint64_t{2} << 30);
  if (bytes.empty()) fail(path, "is empty");
  if (extension == "ply") bytes = checkPly(std::move(bytes), path);
  Assimp::Importer importer;
  // The line break makes it a name that no line of an OBJ file can spell.
  const std::string name = "mesh\n." + extension;
  importer.SetIOHandler(new OneFile(bytes, name));  // the importer owns it
  keepOnlyLoader(importer, extension);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const auto check = [&](const aiScene* scene) {
    if (scene == nullptr)
      fail(path, fmt::format("cannot be read as {} ({})", extension, cleanName(importer.GetErrorString())));
    return scene;
  };
  checkIndices(*check(importer.ReadFile(name, 0)), path);
  const aiScene* scene = check(importer.ApplyPostProcessing(aiProcess_ValidateDataStructure | aiProcess_Triangulate |
                                                            aiProcess_SortByPType | aiProcess_JoinIdenticalVertices));
  return merge(collectParts(*scene, path), path);
}

Mesh importFromGltf(const std::filesystem::path& path) {
  SceneData scene = importGltf(path, 0.0F);
  std::vector<PlacedMesh> parts;
  for (const Instance& instance : scene.instances)
    parts.push_back({scene.meshes[instance.mesh], instance.world_from_object});
  return merge(std::move(parts), path);
}

}  // namespace

Mesh importMesh(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  try {
    if (extension == "glb" || extension == "gltf") return importFromGltf(path);
    if (extension == "ply" || extension == "obj" || extension == "stl") return importWithAssimp(path, extension);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw ResourceError(cleanPath(path) + ": not enough memory to load it");
  } catch (const std::exception& error) {
    fail(path, fmt::format("cannot be read as {} ({})", extension, cleanName(error.what())));
  }
  fail(path, fmt::format("'.{}' is no mesh format that is read; expected .ply, .obj, .stl, .glb or .gltf",
                         cleanName(extension)));
}

}  // namespace nephroid
