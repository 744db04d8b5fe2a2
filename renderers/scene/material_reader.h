#pragma once

#include "renderers/scene/keyframes.h"
#include "renderers/scene/scene.h"
#include "renderers/scene/scene_layers.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace renderers::scene {

/// What of a material may change over time.
struct MaterialColors {
  glm::vec3 albedo{0.0F};
  glm::vec3 emission{0.0F};
};

/// A material whose colours move.
struct MaterialTrack {
  std::size_t material = 0;  ///< index
  Track<MaterialColors> colors;
};

/// Materials and the textures they refer to by index.
struct MaterialTable {
  std::vector<Material> materials;  ///< without their animation
  std::vector<Texture> textures;
  std::vector<MaterialTrack> tracks;
};

/// Reads materials: {albedo, albedo_texture, phong: {albedo, exponent} or ggx:
/// {albedo, alpha}, emission, emission_texture, animation: {keys: [{frame, albedo, emission}]}}.
/// Missing: albedo 0, or 1 with a texture; emission likewise; in a key: those of the material.
/// @throws base::InputError for a reflectance outside [0, 1], albedo + that of the lobe above 1,
///   two lobes, negative emission
MaterialTable read_materials(const std::vector<NamedSource>& sources);

/// Both are mixed linearly.
MaterialColors mix_colors(const MaterialColors& a, const MaterialColors& b, float t);

/// Index of the material. @throws base::InputError with the nearest known name
int find_material(const MaterialTable& table, std::string_view name, const base::Place& place);

}  // namespace renderers::scene
