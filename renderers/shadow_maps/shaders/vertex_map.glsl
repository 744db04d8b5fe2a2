// Depth of hemispherical maps drawn by their vertices: 1 at the centre, 0 at the farthest corner of
// the scene's bounds.

#include "renderers/shadow_maps/shaders/map_origins.glsl"

uniform vec3 bounds_least;     // of the scene, m
uniform vec3 bounds_greatest;

// Distance of depth 0, m.
float depth_range(MapCenter center) {
  return length(max(abs(center.position - bounds_least), abs(center.position - bounds_greatest)));
}
