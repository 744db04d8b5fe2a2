// Which triangles a map's clip height spares.

#include "renderers/opengl/shaders/scene.glsl"
#include "renderers/shadow_maps/shaders/map_origins.glsl"

// Whether nothing of a triangle is clipped: it faces the centre, and only backs are.
bool is_spared(MapCenter center, int triangle) {
  vec3 towards = center.position - triangles[triangle].position[0].xyz;
  return center.clips_behind && dot(triangles[triangle].geometric_normal.xyz, towards) > 0.0;
}
