#pragma once

#include "renderers/scene/keyframes.h"
#include "renderers/scene/scene.h"
#include "renderers/scene/scene_layers.h"

#include <memory>

namespace renderers::scene {

/// Reads {name, type: point, position, intensity} or {name, type: spot, position, direction,
/// intensity, cone_deg: [inner, outer]}, each with animation: {keys: [{frame, position, direction,
/// intensity}]}; cone angles are half angles from the axis, degrees.
/// @throws base::InputError for unknown keys and types, negative intensity, cone angles that are
///   not 0 <= inner <= outer <= 90, a spot that turns by 180 degrees between two keys
Track<Light> read_light(const NamedSource& source);

/// Position and intensity are mixed linearly, a spot's direction turns at constant speed.
Light mix_lights(const Light& a, const Light& b, float t);

/// Reads {file, package, scale, rotate_deg} or {constant, scale, rotate_deg}.
/// @return null if the source is absent or null
std::shared_ptr<const Environment> read_environment(const SourceNode& source);

}  // namespace renderers::scene
