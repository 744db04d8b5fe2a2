// Lookups in layers of hemispherical distance maps (HemisphereMaps). `bind_hemisphere_maps` of
// hemisphere_maps.h sets everything this file declares.
//
// The texel that holds the receiver's direction knows the nearest surface along the texel's own
// ray. It is compared with the distance at which that ray meets the receiver's tangent plane, or
// with the receiver's distance if that is less: on flat receivers no tolerance for slope is needed,
// and at an edge of the receiver the plane beyond it does not count. This is the receiver plane
// bias (Isidoro 2006, "Shadow Mapping: GPU-based Tips and Techniques", GDC, recalled), without its
// linearisation.

#include "renderers/shadow_maps/shaders/hemisphere.glsl"

layout(binding = 8) uniform usampler2DArray hemisphere_maps;  // bits of distances, m

uniform float hemisphere_near_m;         // of the centres above the origins, along the axes
uniform float hemisphere_normal_offset;  // of the receiver towards the light's side, in texels
uniform float hemisphere_depth_bias;     // of the compared distance, in texels

// Float rounding of the stored distance and of the compared one, relative (derived: about 30
// roundings each at 6e-8, in the worst of which a difference loses a decimal digit).
const float kHemisphereRounding = 2.0e-5;

// Distance along a texel's ray before which something stands between a receiver and the centre: to
// the receiver's plane, or the receiver's own if that is less, without the biases.
// local, normal: of the receiver, in the frame, m and unit length; extent_m: of a texel there.
float hemisphere_compared_m(ivec2 texel, vec3 local, vec3 normal, float extent_m) {
  int size_px = textureSize(hemisphere_maps, 0).x;
  vec3 ray = hemisphere_direction(hemisphere_texel_position(texel, size_px));
  // The ray meets the plane at this multiple of `ray`; a negative one or none is no bound.
  float plane = dot(local, normal) / dot(ray, normal);
  float distance_m = length(local);
  float compared_m = plane > 0.0 ? min(distance_m, plane * length(ray)) : distance_m;
  return compared_m - hemisphere_depth_bias * extent_m - kHemisphereRounding * distance_m;
}

// 1 if nothing stands between the origin of a layer and a receiver, else 0. A texel's extent is its
// angle times the receiver's distance; the two biases above are multiples of it.
//
// light_position, light_axis: as in MapOrigins, m and unit length; receiver, receiver_normal: m and
// unit length, geometric, either side. A receiver below the horizon, which the map does not hold,
// is taken as visible.
float hemisphere_visibility(uint layer, vec3 light_position, vec3 light_axis, vec3 receiver,
                            vec3 receiver_normal) {
  int size_px = textureSize(hemisphere_maps, 0).x;
  vec3 center = light_position + hemisphere_near_m * light_axis;
  vec3 to_receiver = receiver - center;
  float distance_m = length(to_receiver);
  float cosine = dot(to_receiver, light_axis) / distance_m;
  float extent_m = hemisphere_texel_angle(cosine, size_px) * distance_m;
  float side = dot(to_receiver, receiver_normal) > 0.0 ? -1.0 : 1.0;
  to_receiver += side * hemisphere_normal_offset * extent_m * receiver_normal;

  vec3 local = to_receiver * hemisphere_frame(light_axis);
  if (local.z <= 0.0) return 1.0;
  ivec2 texel = hemisphere_texel(hemisphere_position(local), size_px);
  vec3 normal = receiver_normal * hemisphere_frame(light_axis);
  float nearest_m =
      uintBitsToFloat(texelFetch(hemisphere_maps, ivec3(texel, int(layer)), 0).r);
  return nearest_m >= hemisphere_compared_m(texel, local, normal, extent_m) ? 1.0 : 0.0;
}
