#pragma once

#include "perception/base/document.h"
#include "renderers/scene/mesh_sequence.h"
#include "renderers/scene/scene.h"

#include <memory>
#include <string>
#include <vector>

/// Scenes' geometry made by code; the same settings always give the same triangles.
namespace renderers::scene {

/// One piece of what a generator makes, with the material it has if the scene names none.
struct GeneratedPart {
  std::string name;
  Mesh mesh;
  Material material;                             ///< without textures
  std::shared_ptr<const MeshSequence> sequence;  ///< null: `mesh` is that of every frame
};

/// Runs the generator that a `generator:` map names: {name, ...its settings}.
/// @throws base::InputError for an unknown generator or setting
std::vector<GeneratedPart> generate(const base::Node& node);

}  // namespace renderers::scene
