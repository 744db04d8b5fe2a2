#include "renderers/scene/mesh_file.h"

#include "perception/base/names.h"
#include "renderers/scene/mesh_file_check.h"
#include "renderers/scene/mesh_repair.h"
#include "renderers/scene/mesh_subdivision.h"
#include "renderers/scene/value_reader.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace renderers::scene {
namespace {

constexpr int kMostSubdivided = 10000000;

MeshNormals read_normals(const base::Node& node) {
  const std::string& name = node.text("normals");
  if (name == "file") return MeshNormals::file;
  if (name == "smooth") return MeshNormals::smooth;
  if (name == "flat") return MeshNormals::flat;
  const std::vector<std::string> known{"file", "smooth", "flat"};
  throw base::InputError(node.place(), base::unknown_name("kind of normals", name, known));
}

std::string read_up(const base::Node& node) {
  const std::vector<std::string> known{"y", "z", "-z"};
  const std::string& name = node.text("up");
  if (std::ranges::find(known, name) != known.end()) return name;
  throw base::InputError(node.place(), base::unknown_name("up axis", name, known));
}

void check_format(const std::filesystem::path& path) {
  const std::vector<std::string> known{".obj", ".ply", ".3ds", ".gltf", ".glb"};
  const std::string extension = base::kebab_case(path.extension().string());
  if (std::ranges::find(known, extension) != known.end()) return;
  throw base::InputError(
      fmt::format("{}: {}", path.string(), base::unknown_name("mesh format", extension, known)));
}

glm::vec3 to_vec3(const aiVector3D& v) { return {v.x, v.y, v.z}; }

/// Appends an importer's mesh, placed in the file's space.
class MeshCollector {
 public:
  explicit MeshCollector(const aiScene& scene) : scene_(scene) {
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
      has_normals_ = has_normals_ && scene.mMeshes[i]->HasNormals();
      has_uvs_ = has_uvs_ && scene.mMeshes[i]->HasTextureCoords(0);
    }
    add_node(*scene.mRootNode, aiMatrix4x4());
  }

  Mesh take() { return std::move(mesh_); }
  std::size_t points_and_lines() const { return points_and_lines_; }

 private:
  void add_node(const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 to_file = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      add_mesh(*scene_.mMeshes[node.mMeshes[i]], to_file);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], to_file);
  }

  void add_mesh(const aiMesh& source, const aiMatrix4x4& to_file) {
    const auto first = static_cast<unsigned>(mesh_.positions.size());
    aiMatrix3x3 to_file_normal(to_file);
    const bool is_mirrored = to_file_normal.Determinant() < 0.0F;
    to_file_normal.Inverse().Transpose();
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
      mesh_.positions.push_back(to_vec3(to_file * source.mVertices[i]));
      if (has_normals_) mesh_.normals.push_back(to_vec3(to_file_normal * source.mNormals[i]));
      if (has_uvs_) {
        mesh_.uvs.emplace_back(source.mTextureCoords[0][i].x, source.mTextureCoords[0][i].y);
      }
    }
    for (unsigned i = 0; i < source.mNumFaces; ++i) {
      add_face(source.mFaces[i], first, is_mirrored);
    }
  }

  void add_face(const aiFace& face, unsigned first, bool is_mirrored) {
    if (face.mNumIndices != 3) {
      ++points_and_lines_;
      return;
    }
    glm::uvec3 triangle(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
    // A mirroring transform would turn the front to the back.
    if (is_mirrored) std::swap(triangle.y, triangle.z);
    mesh_.triangles.push_back(first + triangle);
  }

  const aiScene& scene_;
  bool has_normals_ = true;
  bool has_uvs_ = true;
  std::size_t points_and_lines_ = 0;
  Mesh mesh_;
};

/// The file's triangles through Assimp. @param promised  counts of the file, if it tells them
Mesh import(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  const auto promised = check_mesh_file(path, warnings);
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw base::InputError(
        fmt::format("{}: cannot be read as a mesh: {}", path.string(), importer.GetErrorString()));
  }
  if ((scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0) {
    throw base::InputError(fmt::format("{}: the mesh is incomplete", path.string()));
  }
  MeshCollector collector(*scene);
  Mesh mesh = collector.take();
  if (mesh.triangles.empty()) {
    throw base::InputError(fmt::format("{}: has no triangles", path.string()));
  }
  if (promised && promised->triangles > mesh.triangles.size() + collector.points_and_lines()) {
    throw base::InputError(fmt::format("{}: has {} triangles but only {} could be read",
                                       path.string(), promised->triangles, mesh.triangles.size()));
  }
  const std::string name = path.filename().string();
  if (promised && promised->unused_vertices > 0) {
    warnings.push_back(fmt::format("{}: {} vertices belong to no face; is the file complete?", name,
                                   promised->unused_vertices));
  }
  if (collector.points_and_lines() > 0) {
    warnings.push_back(
        fmt::format("{}: left out {} points and lines", name, collector.points_and_lines()));
  }
  return mesh;
}

/// Makes normals unit length; unusable ones come from the faces around their position.
void repair_normals(Mesh& mesh, const std::string& name, std::vector<std::string>& warnings) {
  Mesh smooth;
  std::size_t replaced = 0;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    const float length = glm::length(mesh.normals[i]);
    if (length > 0.0F && std::isfinite(length)) {
      mesh.normals[i] /= length;
      continue;
    }
    if (smooth.normals.empty()) {
      smooth = mesh;
      make_smooth_normals(smooth);
    }
    mesh.normals[i] = smooth.normals[i];
    ++replaced;
  }
  if (replaced > 0) {
    warnings.push_back(fmt::format(
        "{}: replaced {} normals without a direction by those of the faces", name, replaced));
  }
}

void fit_height(Mesh& mesh, float height_m, const std::string& file) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  glm::vec3 low(kInfinity);
  glm::vec3 high(-kInfinity);
  for (const glm::uvec3& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      low = glm::min(low, mesh.positions[t[i]]);
      high = glm::max(high, mesh.positions[t[i]]);
    }
  }
  if (!(high.y > low.y)) {
    throw base::InputError(fmt::format("{}: is flat in y; fit_height cannot scale it", file));
  }
  const glm::vec3 foot(0.5F * (low.x + high.x), low.y, 0.5F * (low.z + high.z));
  const float scale = height_m / (high.y - low.y);
  for (glm::vec3& position : mesh.positions) position = (position - foot) * scale;
}

void subdivide(Mesh& mesh, int faces, const std::string& file) {
  const auto wanted = static_cast<std::size_t>(faces);
  if (mesh.triangles.size() > wanted) {
    throw base::InputError(fmt::format("{}: has {} faces; subdivide_to {} must be at least that",
                                       file, mesh.triangles.size(), faces));
  }
  subdivide_to(mesh, wanted);
}

/// Turns every vector about x so that the `up` axis becomes +y.
void stand_up(std::vector<glm::vec3>& vectors, const std::string& up) {
  if (up == "y") return;
  const float sign = up == "z" ? 1.0F : -1.0F;
  for (glm::vec3& v : vectors) v = {v.x, sign * v.z, -sign * v.y};
}

}  // namespace

MeshFileOptions read_mesh_file_options(base::MapReader& reader) {
  MeshFileOptions options;
  if (const auto* node = reader.find("normals")) options.normals = read_normals(*node);
  if (const auto* node = reader.find("up")) options.up = read_up(*node);
  if (const auto* node = reader.find("fit_height")) {
    options.fit_height_m = read_positive(*node, "fit_height");
  }
  if (const auto* node = reader.find("subdivide_to")) {
    options.subdivide_to = read_count(*node, "subdivide_to", 1, kMostSubdivided);
  }
  return options;
}

Mesh read_mesh_file(const std::filesystem::path& path, const MeshFileOptions& options,
                    std::vector<std::string>& warnings) {
  check_format(path);
  const std::string name = path.filename().string();
  Mesh mesh = import(path, warnings);
  check_mesh(mesh, path.string());
  if (options.normals != MeshNormals::file) mesh.normals.clear();
  const std::size_t all = mesh.triangles.size();
  const std::size_t dropped = drop_zero_area_triangles(mesh);
  if (dropped > 0) {
    warnings.push_back(fmt::format("{}: dropped {} zero-area triangles of {}", name, dropped, all));
  }
  if (mesh.triangles.empty()) {
    throw base::InputError(fmt::format("{}: all {} triangles have zero area", path.string(), all));
  }
  repair_normals(mesh, name, warnings);
  if (options.normals == MeshNormals::smooth) make_smooth_normals(mesh);
  stand_up(mesh.positions, options.up);
  stand_up(mesh.normals, options.up);
  if (options.fit_height_m > 0.0F) fit_height(mesh, options.fit_height_m, path.string());
  if (options.subdivide_to > 0) subdivide(mesh, options.subdivide_to, path.string());
  return mesh;
}

}  // namespace renderers::scene
