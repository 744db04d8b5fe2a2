// Share of a virtual area light that a receiver sees, from the light's one shadow map.
// `bind_area_visibility` of area_visibility.h sets everything this file declares.
//
// VISIBILITY_HARD: one test. VISIBILITY_PCF: percentage-closer soft shadows by brute force, box
// kernels (Fernando 2005, "Percentage-closer Soft Shadows", recalled). Else convolution soft shadow
// maps (Annen et al. 2008, recalled; Dong et al. 2009, Sec. 4.1 and 4.2): the same kernels, their
// means from a filtered Fourier series of the depth comparison; VISIBILITY_MOMENTS: from filtered
// moments of the depths (moment_filter.glsl; ours in this place).

#include "renderers/clustered_visibility/shaders/area_light.glsl"
#include "renderers/shadow_maps/shaders/hemisphere_map.glsl"

layout(std430, binding = 7) readonly buffer AreaLights { AreaLight area_lights[]; };

#ifndef VISIBILITY_HARD
#include "renderers/clustered_visibility/shaders/soft_kernel.glsl"
#ifdef VISIBILITY_PCF
#include "renderers/clustered_visibility/shaders/closer_filter.glsl"
#elif defined(VISIBILITY_MOMENTS)
#include "renderers/clustered_visibility/shaders/moment_filter.glsl"
#else
#include "renderers/clustered_visibility/shaders/convolution_filter.glsl"
#endif
#endif

// The area light that is looked at, and the frame of its map.
struct Seen {
  int cluster;
  AreaLight area;
  vec3 center;  // of the map, m
  mat3 frame;
};
Seen seen;

// cluster: with lights.
void look_at_area(int cluster) {
  seen.cluster = cluster;
  seen.area = area_lights[cluster];
  seen.center = seen.area.position.xyz + hemisphere_near_m * seen.area.axis.xyz;
  seen.frame = hemisphere_frame(seen.area.axis.xyz);
}

// Share of the area light at hand that a receiver sees. position, normal: m, unit length
// (geometric). Receivers behind the light's plane are taken to see all of it (Dong et al. 2009,
// Sec. 5.1).
float area_visibility(vec3 position, vec3 normal) {
  AreaLight area = seen.area;
#ifdef VISIBILITY_HARD
  return hemisphere_visibility(uint(seen.cluster), area.position.xyz, area.axis.xyz, position,
                               normal);
#else
  vec3 local = (position - seen.center) * seen.frame;
  if (local.z <= 0.0) return 1.0;
  Kernel kernel;
  kernel.distance_m = length(local);
  vec2 place = hemisphere_position(local);
  kernel.radius2 = dot(place, place);
  kernel.center = 0.5 * place + 0.5;
  kernel.cluster = seen.cluster;
  kernel.local = local;
  kernel.normal = normal * seen.frame;
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
