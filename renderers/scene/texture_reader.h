#pragma once

#include "perception/base/document.h"
#include "renderers/scene/scene.h"

#include <filesystem>
#include <string>

namespace renderers::scene {

/// Reads a texture: {file, package} (display-encoded files are decoded) or a pattern,
/// {checker: {a, b, tiles}}, {stripes: {a, b, count}}, {noise: {a, b, cells, seed}}. Tiles, stripes
/// and cells count along one side of the pattern; even numbers repeat without a seam.
/// @param name    of the texture in the scene
/// @param folder  where relative paths start
/// @throws base::InputError for unknown keys, unreadable files, values that are negative or not
///   finite
Texture read_texture(const base::Node& node, const std::string& name,
                     const std::filesystem::path& folder);

/// R, G, B, scene_linear of an image file. @throws base::InputError at the place for an unreadable
/// file, a pixel that is negative or not finite
perception::Image read_linear_image(const std::filesystem::path& path, const base::Place& place);

/// Largest value of each channel.
glm::vec3 largest_values(const perception::Image& image);

}  // namespace renderers::scene
