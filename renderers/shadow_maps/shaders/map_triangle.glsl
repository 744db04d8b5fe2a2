// One triangle in one hemispherical map: which texels' rays meet it, and where.

#include "renderers/shadow_maps/shaders/hemisphere.glsl"
#include "renderers/shadow_maps/shaders/triangle_clip.glsl"

layout(r32ui, binding = 0) uniform uimage2DArray distances;  // bits of metres

uniform int size_px;

// In the map's frame, relative to its centre, m.
struct MapTriangle {
  vec3 vertex[3];
  // Normals of the planes through the centre and the edges, on the inner side. Computed as
  // (a + b) x (b - a), which two triangles that share the edge get with opposite signs to the last
  // bit: no ray passes between them.
  vec3 edge[3];
  vec3 normal;  // of the triangle, towards the far side
  float plane;  // dot(vertex, normal); 0 for a triangle without area or seen edge-on
  MapCenter center;
};

MapTriangle map_triangle(int triangle, MapCenter center) {
  mat3 frame = hemisphere_frame(center.axis);
  MapTriangle t;
  t.center = center;
  if (is_spared(center, triangle)) t.center.clip_m = 0.0;
  for (int i = 0; i < 3; ++i) {
    vec3 position = triangles[triangle].position[i].xyz;
    t.vertex[i] = (position - center.position) * frame;
  }
  t.normal = cross(t.vertex[1] - t.vertex[0], t.vertex[2] - t.vertex[0]);
  t.plane = dot(t.vertex[0], t.normal);
  float side = t.plane < 0.0 ? -1.0 : 1.0;
  for (int i = 0; i < 3; ++i) {
    vec3 a = t.vertex[i];
    vec3 b = t.vertex[(i + 1) % 3];
    t.edge[i] = side * cross(a + b, b - a);
  }
  t.normal *= side;
  t.plane *= side;
  return t;
}

// Distance along a ray from the centre to the triangle, m; infinity if the ray does not meet it, or
// below the clip height.
float triangle_distance(MapTriangle t, vec3 ray) {
  float facing = dot(ray, t.normal);
  bool is_hit = dot(ray, t.edge[0]) >= 0.0 && dot(ray, t.edge[1]) >= 0.0 &&
                dot(ray, t.edge[2]) >= 0.0 && facing > 0.0 && t.plane > 0.0;
  float met = t.plane / facing;  // multiple of the ray, if it is hit
  if (!is_hit || is_clipped(t.center, met * ray.z)) return uintBitsToFloat(0x7f800000u);
  return met * length(ray);
}

// Whether a part of the texel lies within the rim.
bool is_used_texel(ivec2 texel) {
  vec2 center = (2.0 * vec2(texel) + 1.0) / float(size_px) - 1.0;
  float reach = 1.0 + 1.41421356 / float(size_px);
  return dot(center, center) <= reach * reach;
}

// Lowers a texel's distance to that of the triangle, if the texel's ray meets it.
void draw_texel(MapTriangle t, ivec2 texel, int layer) {
  if (!is_used_texel(texel)) return;
  vec3 ray = hemisphere_direction(hemisphere_texel_position(texel, size_px));
  uint distance_m = floatBitsToUint(triangle_distance(t, ray));
  if (distance_m < 0x7f800000u) imageAtomicMin(distances, ivec3(texel, layer), distance_m);
}

// Texels (least, greatest; none if least > greatest) whose sampled positions may lie in a rectangle
// of the map. Texels at the rim are sampled up to 1 / sqrt(2) texel inside of their centres.
ivec4 texels_of(vec2 least, vec2 greatest) {
  const float kRounding = 0.01;  // texels; the projection is good to 1e-4 at 1024 texels
  const float kRim = 0.71;
  vec2 farthest = max(abs(least), abs(greatest));
  float rim = 1.0 - 1.5 / float(size_px);
  float margin = kRounding + (dot(farthest, farthest) > rim * rim ? kRim : 0.0);
  float scale = 0.5 * float(size_px);
  // Clamped before the conversion: integers end at 2^31.
  vec2 low = clamp(ceil((least + 1.0) * scale - 0.5 - margin), 0.0, float(size_px));
  vec2 high = clamp(floor((greatest + 1.0) * scale - 0.5 + margin), -1.0, float(size_px - 1));
  return ivec4(ivec2(low), ivec2(high));
}
