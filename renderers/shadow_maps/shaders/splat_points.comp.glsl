// Pass: a set of points of the scene into each layer.
// In: points (ScenePoint), world space, m; origins. Out: distances (r32ui, cleared to infinity).
// Source: Ritschel et al. 2008, "Imperfect Shadow Maps for Efficient Computation of Indirect
// Illumination", recalled.

#include "renderers/shadow_maps/shaders/hemisphere.glsl"
#include "renderers/shadow_maps/shaders/map_origins.glsl"

layout(local_size_x = 64) in;

struct ScenePoint {
  vec4 position;  // w: radius
  vec4 normal;
};

layout(std430, binding = 4) readonly buffer ScenePoints { ScenePoint points[]; };
layout(r32ui, binding = 0) uniform uimage2DArray distances;  // bits of metres

uniform int size_px;
uniform int point_sets;
uniform int points_per_map;
uniform float max_splat_px;
uniform float splat_scale;  // of the points' radii
uniform int is_disc;

void main() {
  int index = int(gl_GlobalInvocationID.x);
  int layer = int(gl_WorkGroupID.y);
  MapCenter center = map_center(layer);
  if (index >= points_per_map || center.is_empty) return;
  int set = (first_origin + layer) % point_sets;
  ScenePoint point = points[set * points_per_map + index];
  mat3 frame = hemisphere_frame(center.axis);
  vec3 position = (point.position.xyz - center.position) * frame;
  if (position.z <= 0.0 || is_clipped(center, position.z)) return;
  vec3 normal = point.normal.xyz * frame;
  float radius_m = splat_scale * point.position.w;
  float distance_m = length(position);

  // The square of the disc's angular radius; it always holds the texel of the point itself.
  float angle = atan(radius_m, distance_m);
  float half_px = min(angle / hemisphere_texel_angle(position.z / distance_m, size_px),
                      0.5 * max_splat_px);
  vec2 at_px = (0.5 * hemisphere_position(position) + 0.5) * float(size_px);
  ivec2 own = clamp(ivec2(floor(at_px)), ivec2(0), ivec2(size_px - 1));
  ivec2 least = clamp(ivec2(ceil(at_px - 0.5 - half_px)), ivec2(0), own);
  ivec2 greatest = clamp(ivec2(floor(at_px - 0.5 + half_px)), own, ivec2(size_px - 1));

  float plane = dot(position, normal);
  for (int y = least.y; y <= greatest.y; ++y) {
    for (int x = least.x; x <= greatest.x; ++x) {
      float splat_m = distance_m;
      if (is_disc != 0) {
        // Where the texel's ray meets the disc's plane; the point's own texel takes the nearest
        // distance within the disc.
        vec3 ray = normalize(hemisphere_direction(hemisphere_texel_position(ivec2(x, y), size_px)));
        float facing = dot(ray, normal);
        float met_m = facing != 0.0 ? plane / facing : -1.0;
        bool is_own = own == ivec2(x, y);
        vec3 off_center = met_m * ray - position;
        bool is_met = met_m > 0.0 && dot(off_center, off_center) <= radius_m * radius_m;
        if (!is_own && !is_met) continue;
        if (met_m > 0.0) {
          splat_m = clamp(met_m, max(distance_m - radius_m, 0.0), distance_m + radius_m);
        }
      }
      imageAtomicMin(distances, ivec3(x, y, layer), floatBitsToUint(splat_m));
    }
  }
}
