#pragma once

#include <cstddef>
#include <memory>

#include "renderers/opengl/buffer.h"
#include "renderers/opengl/context.h"
#include "renderers/opengl/shader_source.h"
#include "renderers/opengl/texture.h"
#include "renderers/shadow_maps/hemisphere_maps.h"

namespace renderers::clustered_visibility {

/// What a chain of levels is made of.
struct MapLevels {
  const opengl::Texture& first;
  const opengl::Texture* second = nullptr;  ///< of the same shape; nullptr: there is none
  /// What a texel holds (shaders/depth_series.glsl): WEIGHTED, DEPTH, MOMENTS or none, TERMS,
  /// GROUPS
  opengl::Defines defines;
};

/// Layers of maps: their distances, what they belong to, and room for levels before rounding.
struct MapInput {
  const shadow_maps::HemisphereMaps& distances;
  const opengl::Buffer& area_lights;  ///< AreaLight, one a layer
  const opengl::Buffer& sums;         ///< of `level_sum_bytes`, at least
};

/// Unrounded levels of a map of `size_px` squared and `layers` texture layers.
std::size_t level_sum_bytes(int size_px, int layers);

/// Makes all levels, each the mean of the level below before that was rounded.
void make_levels(opengl::Context& context, const MapLevels& levels, const MapInput& input);

/// The texture's format as GLSL calls it.
const char* shader_name_of(opengl::TextureFormat format);

}  // namespace renderers::clustered_visibility
