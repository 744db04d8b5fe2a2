// Pass: pieces of triangles into hemispherical maps. In: their vertices, world space, m; origins.
// Out: the vertices' positions in the map and their depths; rasterisation draws the edges straight
// and makes depth linear between them, which is right for small pieces only. The height above the
// horizon, or above the clip height, is the clip distance.
// Source: Brabec et al. 2002, "Shadow Mapping for Hemispherical and Omnidirectional Light Sources",
// Sec. 3, recalled.
//
// VERTEX_LAYER: this shader chooses the layer. GEOMETRY_LAYER: a geometry shader does. Neither: the
// target is one layer.
#ifdef VERTEX_LAYER
#extension GL_ARB_shader_viewport_layer_array : require
#endif

#include "renderers/shadow_maps/shaders/hemisphere.glsl"
#include "renderers/shadow_maps/shaders/vertex_map.glsl"

layout(std430, binding = 4) readonly buffer Vertices { float vertices[]; };  // 3 each

// The same in all of the programs that this shader is part of.
invariant gl_Position;

uniform int first_layer;  // that the first instance is drawn into

#ifdef GEOMETRY_LAYER
layout(location = 0) flat out int layer;
#endif

void main() {
#ifndef GEOMETRY_LAYER
  int layer;
#endif
  layer = first_layer + gl_InstanceID;
#ifdef VERTEX_LAYER
  gl_Layer = layer;
#endif
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
  gl_ClipDistance[0] = -1.0;
  MapCenter center = map_center(layer);
  if (center.is_empty) return;
  int word = 3 * gl_VertexID;
  vec3 position = vec3(vertices[word], vertices[word + 1], vertices[word + 2]);
  vec3 local = (position - center.position) * hemisphere_frame(center.axis);
  // Directions near the lower pole have no place in the map; what has a vertex there is cut off
  // long before it.
  const float kLeast = 0.05;  // 1 + z of unit directions
  float distance_m = length(local);
  vec2 place = local.xy / max(distance_m + local.z, kLeast * distance_m);
  gl_Position = vec4(distance_m > 0.0 ? place : vec2(0.0),
                     1.0 - distance_m / depth_range(center), 1.0);
  gl_ClipDistance[0] = local.z - center.clip_m;
}
