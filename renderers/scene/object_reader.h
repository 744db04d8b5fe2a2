#pragma once

#include "perception/base/hash.h"
#include "renderers/scene/generators/generator_list.h"
#include "renderers/scene/keyframes.h"
#include "renderers/scene/material_reader.h"
#include "renderers/scene/mesh_sequence.h"
#include "renderers/scene/pose.h"
#include "renderers/scene/scene.h"
#include "renderers/scene/scene_layers.h"

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace renderers::scene {

/// A mesh and the hash of its content.
struct HashedMesh {
  std::shared_ptr<const Mesh> mesh;
  base::Hash hash;
};

HashedMesh hashed(Mesh mesh);

/// An object with its movement.
struct MovingObject {
  std::string name;
  HashedMesh mesh;                               ///< of every frame, unless there is a sequence
  std::shared_ptr<const MeshSequence> sequence;  ///< null: the mesh does not change
  int material = 0;
  Track<Pose> pose;

  bool is_animated() const { return sequence != nullptr || pose.is_animated; }
  int last_frame() const;
  /// The mesh itself where it does not change, else a new one.
  HashedMesh mesh_at(int frame) const;
};

/// What an object's map says beside its shape and movement; null: nothing.
struct ObjectLook {
  const base::Node* material = nullptr;
  const base::Node* materials = nullptr;  ///< of a generator's parts
  const base::Node* deform = nullptr;
};

/// Reads objects and loads their meshes, each file once.
///
/// {name, one of mesh | quad | polygons | box | sphere | disk | generator, material, deform,
/// transform, animation}; `mesh` is {file, package, normals, up, fit_height, subdivide_to}. A
/// generator's object
/// may have materials: {part: material}.
class ObjectReader {
 public:
  /// @param table     generators may add materials and textures
  /// @param warnings  gets a line for everything left out of a mesh
  ObjectReader(MaterialTable& table, std::vector<std::string>& warnings);

  /// @throws base::InputError for unknown keys, no or several shapes, an unknown material, ...
  void read(const NamedSource& source);
  std::vector<MovingObject> take_objects() { return std::move(objects_); }

 private:
  HashedMesh read_shape(const base::Node& node, const std::string& shape,
                        const NamedSource& source);
  HashedMesh read_mesh(const base::Node& node, const NamedSource& source);
  /// @param prototype  name and movement of all parts
  void add_generated(const base::Node& node, const MovingObject& prototype, const ObjectLook& look);
  /// The material of a part: by name, the object's, or the generator's own, which is added.
  int material_of(GeneratedPart& part, const ObjectLook& look, const std::string& object_name);

  MaterialTable& table_;
  std::vector<std::string>& warnings_;
  std::vector<MovingObject> objects_;
  std::map<std::string, HashedMesh> files_;  ///< by path and options
};

}  // namespace renderers::scene
