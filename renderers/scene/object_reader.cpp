#include "renderers/scene/object_reader.h"

#include "perception/base/names.h"
#include "renderers/scene/deformation.h"
#include "renderers/scene/file_locator.h"
#include "renderers/scene/mesh_file.h"
#include "renderers/scene/mesh_repair.h"
#include "renderers/scene/primitives.h"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
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

/// Every key of {part: material} must be a part.
void check_part_names(const base::Node& materials, const std::vector<GeneratedPart>& parts) {
  if (!materials.is_map()) {
    throw base::InputError(materials.place(), "materials must be a map {part: material}");
  }
  std::vector<std::string> known;
  for (const GeneratedPart& part : parts) known.push_back(part.name);
  for (const auto& [name, value] : materials.entries()) {
    const auto is_named = [&](const std::string& part) { return base::is_same_name(part, name); };
    if (std::ranges::any_of(known, is_named)) continue;
    throw base::InputError(materials.key_place(name), base::unknown_name("part", name, known));
  }
}

/// A generated mesh that is deformed: every frame's triangles, then the deformation.
class DeformedSequence : public MeshSequence {
 public:
  DeformedSequence(std::shared_ptr<const MeshSequence> source,
                   std::vector<Deformation> deformations)
      : source_(std::move(source)), deformations_(std::move(deformations)) {}

  Mesh at_frame(int frame) const override {
    return deform(source_->at_frame(frame), deformations_, frame);
  }
  int last_frame() const override {
    return std::max(source_->last_frame(), last_frame_of(deformations_));
  }

 private:
  std::shared_ptr<const MeshSequence> source_;
  std::vector<Deformation> deformations_;
};

/// Deforms an object's mesh: once, if nothing of it moves.
void add_deformation(MovingObject& object, const base::Node& node) {
  std::vector<Deformation> deformations = read_deformations(node);
  if (object.sequence != nullptr) {
    object.sequence =
        std::make_shared<const DeformedSequence>(object.sequence, std::move(deformations));
    return;
  }
  const auto deformed = std::make_shared<const DeformedMesh>(object.mesh.mesh, deformations);
  if (deformed->is_animated()) {
    object.sequence = deformed;
  } else {
    object.mesh = hashed(deformed->at_frame(0));
  }
}

}  // namespace

HashedMesh hashed(Mesh mesh) {
  const base::Hash hash = hash_of(mesh);
  return {std::make_shared<const Mesh>(std::move(mesh)), hash};
}

int MovingObject::last_frame() const {
  const int moved = pose.last_frame();
  return sequence == nullptr ? moved : std::max(moved, sequence->last_frame());
}

HashedMesh MovingObject::mesh_at(int frame) const {
  return sequence == nullptr ? mesh : hashed(sequence->at_frame(frame));
}

ObjectReader::ObjectReader(MaterialTable& table, std::vector<std::string>& warnings)
    : table_(table), warnings_(warnings) {}

void ObjectReader::read(const NamedSource& source) {
  base::MapReader reader(*source.source.node, fmt::format("object \"{}\"", source.name));
  reader.required_text("name");
  const std::string shape = shape_key(reader);
  const bool is_generated = shape == "generator";
  MovingObject object;
  object.name = source.name;
  const base::Node* transform = reader.find("transform");
  object.pose =
      read_track(reader, transform == nullptr ? Pose{} : read_transform(*transform), read_pose);
  ObjectLook look;
  look.material = is_generated ? reader.find("material") : &reader.require("material");
  if (is_generated) look.materials = reader.find("materials");
  look.deform = reader.find("deform");
  reader.finish();
  if (is_generated) {
    add_generated(*reader.find(shape), object, look);
    return;
  }
  object.material = find_material(table_, look.material->text("material"), look.material->place());
  object.mesh = read_shape(*reader.find(shape), shape, source);
  if (look.deform != nullptr) add_deformation(object, *look.deform);
  objects_.push_back(std::move(object));
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
  const std::string key = fmt::format("{}|{}|{}|{}|{}", std::filesystem::canonical(path).string(),
                                      static_cast<int>(options.normals), options.up,
                                      options.fit_height_m, options.subdivide_to);
  const auto known = files_.find(key);
  if (known != files_.end()) return known->second;
  try {
    return files_[key] = hashed(read_mesh_file(path, options, warnings_));
  } catch (const base::InputError& error) {
    throw base::InputError(node.place(), error.what());
  }
}

void ObjectReader::add_generated(const base::Node& node, const MovingObject& prototype,
                                 const ObjectLook& look) {
  std::vector<GeneratedPart> parts = generate(node);
  if (look.materials != nullptr) check_part_names(*look.materials, parts);
  for (GeneratedPart& part : parts) {
    MovingObject object = prototype;
    object.name = fmt::format("{}.{}", prototype.name, part.name);
    object.material = material_of(part, look, object.name);
    if (part.sequence != nullptr) {
      object.sequence = std::move(part.sequence);
    } else {
      drop_and_warn(part.mesh, object.name, node.place(), warnings_);
      object.mesh = hashed(std::move(part.mesh));
    }
    if (look.deform != nullptr) add_deformation(object, *look.deform);
    objects_.push_back(std::move(object));
  }
}

int ObjectReader::material_of(GeneratedPart& part, const ObjectLook& look,
                              const std::string& object_name) {
  const base::Node* named = look.materials == nullptr ? nullptr : look.materials->find(part.name);
  if (named == nullptr) named = look.material;
  if (named != nullptr) return find_material(table_, named->text("material"), named->place());
  part.material.name = object_name;
  table_.materials.push_back(std::move(part.material));
  return static_cast<int>(table_.materials.size()) - 1;
}

}  // namespace renderers::scene
