#pragma once

namespace renderers::clustered_visibility {

/// Depth of the farthest corner of the scene, seen from an area light. The series of the step is a
/// square wave of period 2: a blocker at 0 before a receiver at 1 would count as half.
inline constexpr float kFarDepth = 0.9F;

}  // namespace renderers::clustered_visibility
