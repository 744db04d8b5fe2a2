#pragma once

#include "renderers/scene/keyframes.h"
#include "renderers/scene/scene.h"
#include "renderers/scene/scene_layers.h"

namespace renderers::scene {

/// Reads {position, look_at, up: [0, 1, 0], vertical_fov_deg, animation: {keys: [{frame, position,
/// look_at, vertical_fov_deg}]}}.
/// @param file  of the scene, for the message if there is none
/// @throws base::InputError for a missing camera, a field of view outside (0, 180), a view
///   direction of length 0 or along `up`, at a key or on the way to the next
Track<Camera> read_camera(const SourceNode& source, const base::Place& file);

/// All are mixed linearly.
Camera mix_cameras(const Camera& a, const Camera& b, float t);

}  // namespace renderers::scene
