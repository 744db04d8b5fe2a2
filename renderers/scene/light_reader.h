#pragma once

#include "renderers/scene/scene.h"
#include "renderers/scene/scene_layers.h"

#include <memory>
#include <vector>

namespace renderers::scene {

/// Reads {name, type: point, position, intensity} or {name, type: spot, position, direction,
/// intensity, cone_deg: [inner, outer]}; cone angles are half angles from the axis, degrees.
/// @throws base::InputError for unknown keys and types, negative intensity, cone angles that are
///   not 0 <= inner <= outer <= 90
Light read_light(const NamedSource& source);

/// Reads {file, package, scale, rotate_deg} or {constant, scale, rotate_deg}.
/// @return null if the source is absent or null
std::shared_ptr<const Environment> read_environment(const SourceNode& source);

/// Reads {position, look_at, up: [0, 1, 0], vertical_fov_deg}.
/// @param file  of the scene, for the message if there is none
/// @throws base::InputError for a missing camera, a field of view outside (0, 180), a view
///   direction of length 0 or along `up`
Camera read_camera(const SourceNode& source, const base::Place& file);

}  // namespace renderers::scene
