#pragma once

#include "renderers/scene/scene.h"

namespace suites {

/// How far the camera is turned for `new_view_s`, degrees; ours: near enough to show the same
/// things, far enough that no pixel stays as it was.
inline constexpr float kNewViewAngle_deg = 5.0F;

/// The camera, moved by kNewViewAngle_deg on a circle about its look_at point, the axis being its
/// up direction; it keeps its distance and still looks at that point.
renderers::scene::Camera turned_camera(const renderers::scene::Camera& camera);

}  // namespace suites
