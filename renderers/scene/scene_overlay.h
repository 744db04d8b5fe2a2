#pragma once

#include "renderers/scene/scene_layers.h"

#include "perception/base/document.h"

#include <filesystem>

namespace renderers::scene {

/// Lays a document over a merged scene, to change parts of what is there.
///
/// {camera, environment, luminance_scale_cd_m2, materials, objects, lights}; the last three are
/// maps from the names of the scene to what changes. Maps are merged key by key at every depth,
/// `null` takes a value away (RFC 7396, JSON Merge Patch), everything else is replaced.
/// Differs from RFC 7396: a map over a list sets its entries by their number, from 0; what is not
/// there cannot be taken away. What is laid over stands at its place in the overlay's file.
///
/// @param folder  where relative paths of values start that the scene has not yet
/// @throws base::InputError for unknown keys, names that the scene lacks, entries beyond a list
void lay_over(SceneLayers& layers, const base::Node& overlay, const std::filesystem::path& folder);

}  // namespace renderers::scene
