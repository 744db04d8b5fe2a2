#include "renderers/scene/object_reader.h"

#include "renderers/scene/file_locator.h"
#include "renderers/scene/generators/generator_list.h"
#include "renderers/scene/mesh_file.h"
#include "renderers/scene/mesh_repair.h"
#include "renderers/scene/primitives.h"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <span>
#include <utility>

namespace renderers::scene {
namespace {

struct Primitive {
  const char* key;
  Mesh (*read)(const base::Node& node);
};

constexpr Primitive kPrimitives[] = {{"quad", read_quad},
                                     {"polygons", read_polygons},
                                     {"box", read_box},
                                     {"sphere", read_sphere},
                                     {"disk", read_disk}};

template <typename Vector>
void add_values(base::Hasher& hasher, const std::vector<Vector>& values) {
  const auto count = values.size() * static_cast<std::size_t>(Vector::length());
  const float* first = values.empty() ? nullptr : glm::value_ptr(values.front());
  hasher.add(std::span<const float>(first, count));
}

base::Hash hash_of(const Mesh& mesh) {
  base::Hasher hasher;
  add_values(hasher, mesh.positions);
  add_values(hasher, mesh.normals);
  add_values(hasher, mesh.uvs);
  hasher.add(static_cast<std::int64_t>(mesh.triangles.size()));
  hasher.add_bytes(std::as_bytes(std::span(mesh.triangles)));
  return hasher.finish();
}

HashedMesh hashed(Mesh mesh) {
  const base::Hash hash = hash_of(mesh);
  return {std::make_shared<const Mesh>(std::move(mesh)), hash};
}

void append_key(std::string& list, const char* key) {
  if (!list.empty()) list += ", ";
  list += key;
}

/// The one key of the map that says what shape the object has.
std::string shape_key(base::MapReader& reader) {
  std::string known;
  std::string found;
  const auto look_for = [&](const char* key) {
    append_key(known, key);
    if (reader.find(key) != nullptr) append_key(found, key);
  };
  look_for("mesh");
  for (const Primitive& primitive : kPrimitives) look_for(primitive.key);
  look_for("generator");
  if (found.empty() || found.find(',') != std::string::npos) {
    throw base::InputError(reader.node().place(),
                           fmt::format("{} has {}; it needs exactly one of: {}", reader.what(),
                                       found.empty() ? "no shape" : "the shapes " + found, known));
  }
  return found;
}

/// Removes triangles without area and says so.
void drop_and_warn(Mesh& mesh, const std::string& name, const base::Place& place,
                   std::vector<std::string>& warnings) {
  const std::size_t all = mesh.triangles.size();
  const std::size_t dropped = drop_zero_area_triangles(mesh);
  if (mesh.triangles.empty()) {
    throw base::InputError(
        place, fmt::format("object \"{}\": all {} triangles have zero area", name, all));
  }
  if (dropped == 0) return;
  warnings.push_back(
      fmt::format("object \"{}\": dropped {} zero-area triangles of {}", name, dropped, all));
}

}  // namespace

ObjectReader::ObjectReader(MaterialTable& table, std::vector<std::string>& warnings)
    : table_(table), warnings_(warnings) {}

void ObjectReader::read(const NamedSource& source) {
  base::MapReader reader(*source.source.node, fmt::format("object \"{}\"", source.name));
  reader.required_text("name");
  const std::string shape = shape_key(reader);
  MovingObject object;
  object.name = source.name;
  const base::Node* transform = reader.find("transform");
  const Pose rest = transform == nullptr ? Pose{} : read_transform(*transform);
  const base::Node* animation = reader.find("animation");
  object.is_animated = animation != nullptr;
  object.keys =
      object.is_animated ? read_animation(*animation, rest) : std::vector<PoseKey>{{0, rest}};
  const base::Node* material =
      shape == "generator" ? reader.find("material") : &reader.require("material");
  reader.finish();
  if (material != nullptr) {
    object.material = find_material(table_, material->text("material"), material->place());
  }
  if (shape == "generator") {
    add_generated(*reader.find(shape), object, material != nullptr);
  } else {
    object.mesh = read_shape(*reader.find(shape), shape, source);
    objects_.push_back(std::move(object));
  }
}

HashedMesh ObjectReader::read_shape(const base::Node& node, const std::string& shape,
                                    const NamedSource& source) {
  if (shape == "mesh") return read_mesh(node, source);
  for (const Primitive& primitive : kPrimitives) {
    if (shape != primitive.key) continue;
    Mesh mesh = primitive.read(node);
    drop_and_warn(mesh, source.name, node.place(), warnings_);
    return hashed(std::move(mesh));
  }
  return {};
}

HashedMesh ObjectReader::read_mesh(const base::Node& node, const NamedSource& source) {
  base::MapReader reader(node, "mesh");
  const std::filesystem::path path = read_file_reference(reader, source.source.folder);
  const MeshFileOptions options = read_mesh_file_options(reader);
  reader.finish();
  const std::string key =
      fmt::format("{}|{}|{}|{}", std::filesystem::canonical(path).string(),
                  static_cast<int>(options.normals), options.up, options.fit_height_m);
  const auto known = files_.find(key);
  if (known != files_.end()) return known->second;
  try {
    return files_[key] = hashed(read_mesh_file(path, options, warnings_));
  } catch (const base::InputError& error) {
    throw base::InputError(node.place(), error.what());
  }
}

void ObjectReader::add_generated(const base::Node& node, const MovingObject& prototype,
                                 bool has_material) {
  for (GeneratedPart& part : generate(node)) {
    MovingObject object = prototype;
    object.name = fmt::format("{}.{}", prototype.name, part.name);
    if (!has_material) {
      part.material.name = object.name;
      object.material = static_cast<int>(table_.materials.size());
      table_.materials.push_back(std::move(part.material));
    }
    drop_and_warn(part.mesh, object.name, node.place(), warnings_);
    object.mesh = hashed(std::move(part.mesh));
    objects_.push_back(std::move(object));
  }
}

}  // namespace renderers::scene
