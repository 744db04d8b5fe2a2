#pragma once

#include "perception/base/hash.h"
#include "renderers/scene/material_reader.h"
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

/// An object with its movement: one key for an object at rest.
struct MovingObject {
  std::string name;
  HashedMesh mesh;
  int material = 0;
  std::vector<PoseKey> keys;
  bool is_animated = false;
};

/// Reads objects and loads their meshes, each file once.
///
/// {name, one of mesh | quad | polygons | box | sphere | disk | generator, material, transform,
/// animation}; `mesh` is {file, package, normals, up, fit_height}.
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
  /// @param prototype  name, movement and, if `has_material`, material of all parts
  void add_generated(const base::Node& node, const MovingObject& prototype, bool has_material);

  MaterialTable& table_;
  std::vector<std::string>& warnings_;
  std::vector<MovingObject> objects_;
  std::map<std::string, HashedMesh> files_;  ///< by path and options
};

}  // namespace renderers::scene
