// Share of a virtual area light that a receiver sees, from the light's one shadow map.
// `bind_area_visibility` of area_visibility.h sets everything this file declares.
//
// VISIBILITY_HARD: one test. VISIBILITY_PCF: percentage-closer soft shadows by brute force, box
// kernels (Fernando 2005, "Percentage-closer Soft Shadows", recalled). Else convolution soft shadow
// maps (Annen et al. 2008, recalled; Dong et al. 2009, Sec. 4.1 and 4.2): the same kernels, their
// means from a filtered Fourier series of the depth comparison.

#include "renderers/clustered_visibility/shaders/area_light.glsl"
#include "renderers/shadow_maps/shaders/hemisphere_map.glsl"

layout(std430, binding = 7) readonly buffer AreaLights { AreaLight area_lights[]; };

#ifndef VISIBILITY_HARD
#include "renderers/clustered_visibility/shaders/soft_kernel.glsl"
#ifdef VISIBILITY_PCF
#include "renderers/clustered_visibility/shaders/closer_filter.glsl"
#else
#include "renderers/clustered_visibility/shaders/convolution_filter.glsl"
#endif
#endif

// cluster: with lights; position, normal: of the receiver, m, unit length (geometric). Receivers
// behind the light's plane are taken to see all of it (Dong et al. 2009, Sec. 6).
float area_visibility(int cluster, vec3 position, vec3 normal) {
  AreaLight area = area_lights[cluster];
#ifdef VISIBILITY_HARD
  return hemisphere_visibility(uint(cluster), area.position.xyz, area.axis.xyz, position, normal);
#else
  vec3 to_receiver = position - (area.position.xyz + hemisphere_near_m * area.axis.xyz);
  vec3 local = to_receiver * hemisphere_frame(area.axis.xyz);
  if (local.z <= 0.0) return 1.0;
  Kernel kernel;
  kernel.distance_m = length(local);
  vec2 place = hemisphere_position(local);
  kernel.radius2 = dot(place, place);
  kernel.center = 0.5 * place + 0.5;
  kernel.cluster = cluster;
  kernel.depth = kernel.distance_m * area.shape.y;
  float size_m = area.shape.x;
#ifdef FORESHORTENED
  size_m *= sqrt(local.z / kernel.distance_m);
#endif
  float search = search_width(area.shape.z * local.z / kernel.distance_m, kernel);
  float blocker = blocker_depth(kernel, search);
  if (blocker >= kernel.depth) return 1.0;
  return lit_share(kernel, penumbra_width(size_m, blocker, kernel), blocker);
#endif
}
