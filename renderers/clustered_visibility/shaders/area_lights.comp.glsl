// Pass: an area light from the lights of each cluster; a thread per cluster, its lights in order.
// In: virtual lights, indices sorted by cluster, centres. Out: area lights.
// Source: Dong et al. 2009, Sec. 6: the area is that of the bounding rectangle in the light's plane;
// its axes are ours. FROM_COVARIANCE: of the rectangle that has the same variances,
// side^2 = 12 variance along each axis (ours). CLIP_BEHIND: Clip::behind, a height below 0.

#include "renderers/many_lights/shaders/virtual_light.glsl"
#include "renderers/shadow_maps/shaders/hemisphere.glsl"
#include "renderers/clustered_visibility/shaders/area_light.glsl"
#include "renderers/clustered_visibility/shaders/cluster_rule.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = 3) readonly buffer VirtualLights { VirtualLight lights[]; };
layout(std430, binding = 4) readonly buffer Members { int members[]; };
layout(std430, binding = 5) readonly buffer Centers { Center centers[]; };
layout(std430, binding = 6) writeonly buffer AreaLights { AreaLight area_lights[]; };

uniform int area_light_count;  // those beyond cluster_count are empty
uniform vec3 bounds_min;   // m
uniform vec3 bounds_max;
uniform float least_size;  // m
uniform float far_depth;   // of the farthest corner of the bounds

int first_of(int c) {
  int first = 0;
  for (int i = 0; i < c; ++i) first += int(centers[i].normal.w);
  return first;
}

// Loops take four lights a turn: Mesa's software drivers end a thread's loops after 65,535 turns.
void add_to_sums(int i, int end, vec3 origin, inout vec3 offset, inout vec3 direction,
                 inout vec3 flux) {
  if (i >= end) return;
  VirtualLight light = lights[members[i]];
  offset += light.position.xyz - origin;
  direction += light.geometric_normal.xyz;
  flux += light.flux.rgb;
}

struct Extent {
  vec3 least;
  vec3 greatest;
  vec2 squares;
};

void add_to_extent(int i, int end, vec3 origin, mat3 frame, inout Extent extent) {
  if (i >= end) return;
  vec3 local = (lights[members[i]].position.xyz - origin) * frame;
  extent.least = min(extent.least, local);
  extent.greatest = max(extent.greatest, local);
  extent.squares += local.xy * local.xy;
}

// Mean position, mean normal, sum of fluxes. A single light is taken as it is, to the last bit.
AreaLight mean_light(int first, int count, vec3 normal) {
  AreaLight area;
  vec3 origin = lights[members[first]].position.xyz;
  vec3 offset = vec3(0.0);
  vec3 direction = vec3(0.0);
  int end = first + count;
  vec3 flux = vec3(0.0);
  for (int i = first; i < end; i += 4) {
    add_to_sums(i, end, origin, offset, direction, flux);
    add_to_sums(i + 1, end, origin, offset, direction, flux);
    add_to_sums(i + 2, end, origin, offset, direction, flux);
    add_to_sums(i + 3, end, origin, offset, direction, flux);
  }
  float size = length(direction) / float(count);
  area.position = vec4(origin + offset / float(count), 1.0);
  area.axis = vec4(size >= kShortestMean ? normalize(direction) : normal, 0.0);
  if (count == 1) area.axis.xyz = lights[members[first]].geometric_normal.xyz;
  area.flux = vec4(flux, float(first));
  return area;
}

void main() {
  int c = int(gl_GlobalInvocationID.x);
  if (c >= area_light_count) return;
  int count = c < cluster_count ? int(centers[c].normal.w) : 0;
  if (count == 0) {
    area_lights[c] = AreaLight(vec4(0.0), vec4(0.0, 0.0, 1.0, 0.0), vec4(0.0), vec4(0.0));
    return;
  }
  int first = first_of(c);
  AreaLight area = mean_light(first, count, centers[c].normal.xyz);
  mat3 frame = hemisphere_frame(area.axis.xyz);
  int end = first + count;
  vec3 origin = area.position.xyz;
  vec3 corner = (lights[members[first]].position.xyz - origin) * frame;
  Extent extent = Extent(corner, corner, vec2(0.0));
  for (int i = first; i < end; i += 4) {
    add_to_extent(i, end, origin, frame, extent);
    add_to_extent(i + 1, end, origin, frame, extent);
    add_to_extent(i + 2, end, origin, frame, extent);
    add_to_extent(i + 3, end, origin, frame, extent);
  }
#ifdef FROM_COVARIANCE
  vec2 sides = sqrt(12.0 * extent.squares / float(count));
#else
  vec2 sides = extent.greatest.xy - extent.least.xy;
#endif
  float surface = sides.x * sides.y;
  float highest = max(extent.greatest.z, 0.0);
#ifdef CLIP_BEHIND
  highest = -highest;
#endif
  area.axis.w = highest;
  vec3 farthest = max(abs(bounds_min - area.position.xyz), abs(bounds_max - area.position.xyz));
  area.shape = vec4(max(sqrt(surface), least_size), far_depth / length(farthest), surface,
                    float(count));
  area_lights[c] = area;
}
