#pragma once

#include "renderers/scene/scene.h"
#include "renderers/scene/scene_layers.h"

#include <string>
#include <string_view>
#include <vector>

namespace renderers::scene {

/// Materials and the textures they refer to by index.
struct MaterialTable {
  std::vector<Material> materials;
  std::vector<Texture> textures;
};

/// Reads materials: {albedo, albedo_texture, phong: {albedo, exponent}, emission,
/// emission_texture}. Missing: albedo 0, or 1 with a texture; emission likewise.
/// @throws base::InputError for a reflectance outside [0, 1], albedo + phong albedo above 1,
///   negative emission
MaterialTable read_materials(const std::vector<NamedSource>& sources);

/// Index of the material. @throws base::InputError with the nearest known name
int find_material(const MaterialTable& table, std::string_view name, const base::Place& place);

}  // namespace renderers::scene
