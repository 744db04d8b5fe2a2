// Pass: hemispherical maps from the faces of hemicubes.
// In: atlas of faces (r32ui, index of the triangle seen), triangles, origins.
// Out: distances (r32ui, bits of metres, cleared to infinity).
//
// A texel's ray takes the nearest distance at which it meets the triangles seen in the four pixels
// of the face around it: exact wherever the triangle that the ray meets is seen in one of them.
// Where it misses all, at silhouettes and around triangles smaller than a pixel, the plane of the
// nearest pixel's triangle counts, up to its farthest vertex.

#include "renderers/shadow_maps/shaders/hemicube.glsl"
#include "renderers/shadow_maps/shaders/map_triangle.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(r32ui, binding = 1) readonly uniform uimage2D atlas;

uniform int first_layer;  // of the maps, that the atlas begins with

const uint kNoTriangle = 0xffffffffu;
const float kInfinity = uintBitsToFloat(0x7f800000u);

// Where the ray meets the triangle's plane, m.
float plane_distance(MapTriangle t, vec3 ray) {
  float farthest_m = max(length(t.vertex[0]), max(length(t.vertex[1]), length(t.vertex[2])));
  float facing = dot(ray, t.normal);
  return facing > 0.0 ? min(t.plane / facing * length(ray), farthest_m) : farthest_m;
}

float resampled_distance(MapCenter center, int layer, vec3 ray) {
  int face = hemicube_face(ray);
  vec3 view = hemicube_view(face, ray);
  vec2 place = view.xy / view.z;
  vec2 at_px = 0.5 * float(face_px) * vec2(place.x + 1.0, face == 0 ? place.y + 1.0 : place.y);
  ivec2 last = hemicube_size(face) - 1;
  ivec2 nearest = clamp(ivec2(floor(at_px)), ivec2(0), last);
  ivec2 next = clamp(nearest + ivec2(sign(at_px - vec2(nearest) - 0.5)), ivec2(0), last);
  ivec2 corner = hemicube_corner(face, layer);
  uint tried = kNoTriangle;
  float nearest_m = kInfinity;
  float fallback_m = kInfinity;
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = ivec2((i & 1) == 0 ? nearest.x : next.x, (i & 2) == 0 ? nearest.y : next.y);
    uint triangle = imageLoad(atlas, corner + pixel).r;
    if (triangle == tried || triangle == kNoTriangle) continue;
    tried = triangle;
    MapTriangle t = map_triangle(int(triangle), center);
    nearest_m = min(nearest_m, triangle_distance(t, ray));
    if (i == 0) fallback_m = plane_distance(t, ray);
  }
  return nearest_m < kInfinity ? nearest_m : fallback_m;
}

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel.xy, ivec2(size_px))) || !is_used_texel(texel.xy)) return;
  MapCenter center = map_center(texel.z);
  if (center.is_empty) return;
  vec3 ray = hemisphere_direction(hemisphere_texel_position(texel.xy, size_px));
  float distance_m = resampled_distance(center, texel.z, ray);
  imageStore(distances, ivec3(texel.xy, first_layer + texel.z), uvec4(floatBitsToUint(distance_m)));
}
