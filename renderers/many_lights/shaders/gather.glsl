// Light of virtual lights at the pixels of a geometry buffer, added to a sum; the body of gather
// shaders, which may define who sees a light.
// Inputs: surfaces (world space, m), lights (std430), the range of lights to work on. Output:
// irradiance, W/m2; with GLOSSY instead the radiance that the receivers' lobes reflect towards
// the camera, W/(m2 sr), a pass of its own since most pixels have none and a power costs more than
// all else. Pixels without a surface, and those whose run lies outside the range, are left alone.
//
// Interleaved: pixel (x, y) of class s = (y mod n) n + x mod n reads the run of lights
// [s N / n^2, (s + 1) N / n^2) and multiplies by n^2 (Segovia et al. 2006). Orders:
//   ORDER_IN_PLACE  all threads of a group share one class and scatter to their pixels
//   ORDER_NAIVE     one thread a pixel, in the picture's order
//   ORDER_SPLIT     surfaces and targets are sorted by class (split.comp.glsl), n x n blocks
//
// WITH_VISIBILITY: the file that includes this one defines `light_visibility`, the share of a light
// that reaches a receiver. WITH_GROUPS: lights of one group (flux.w) share it; it is asked for once
// for neighbours in the list of lights, after `begin_group` of their group. WITH_LONG_GROUPS: it is
// asked for ahead of each group, whatever the group gives; software drivers run what stands under a
// condition for every light, met or not.
#include "renderers/many_lights/shaders/virtual_light.glsl"
#ifdef GLOSSY
#include "renderers/opengl/shaders/scene.glsl"
#endif

layout(local_size_x = LOCAL_SIZE, local_size_y = LOCAL_SIZE) in;

layout(std430, binding = 3) readonly buffer VirtualLights { VirtualLight lights[]; };
layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D geometric_normal_map;
layout(binding = 2) uniform sampler2D shading_normal_map;
layout(binding = 3) uniform sampler2D albedo_map;
layout(rgba32f, binding = 0) uniform image2D sum_image;
uniform ivec2 size_px;
uniform ivec2 cells;  // pixels of a class, ceil(size / n)
uniform int interleave;
uniform int first_class;
uniform int light_count;
uniform int first_light;
uniform int end_light;
uniform float geometry_clamp;
uniform vec3 camera_position;

struct Receiver {
  ivec2 texel;
  bool is_lit;  // a surface, with GLOSSY one that has a lobe
  vec3 position;
  vec3 geometric_normal;
  vec3 shading_normal;  // zero where nothing is lit: receives nothing
  vec3 sum;
#ifdef WITH_GROUPS
  float group_visibility;  // of the group at hand; negative: not asked for yet
#endif
#ifdef GLOSSY
  vec3 mirror;  // direction of the viewer, mirrored about the shading normal
  vec3 lobe;    // rho_s
  float shape;  // exponent of Phong, or -alpha of GGX
#ifdef WITH_GGX
  vec3 to_viewer;
#endif
#endif
};

#ifdef WITH_VISIBILITY
// index: of the light, from the first of the batch.
float light_visibility(VirtualLight light, int index, Receiver receiver);
#ifdef WITH_GROUPS
void begin_group(int group);
#endif
#endif

Receiver receiver_at(ivec2 texel, bool is_inside) {
  Receiver receiver;
  texel = is_inside ? texel : ivec2(0);
  receiver.texel = texel;
  vec4 position = is_inside ? texelFetch(position_map, texel, 0) : vec4(0.0);
  vec4 geometric_normal = texelFetch(geometric_normal_map, texel, 0);
  receiver.is_lit = position.w > 0.0;
#ifdef GLOSSY
  receiver.is_lit = receiver.is_lit && texelFetch(albedo_map, texel, 0).w > 0.0;
#endif
  receiver.position = position.xyz;
  receiver.geometric_normal = geometric_normal.xyz;
  receiver.shading_normal =
      receiver.is_lit ? texelFetch(shading_normal_map, texel, 0).xyz : vec3(0.0);
  receiver.sum = vec3(0.0);
#ifdef WITH_GROUPS
  receiver.group_visibility = -1.0;
#endif
#ifdef GLOSSY
  Material material = materials[receiver.is_lit ? int(geometric_normal.w) : 0];
  vec3 to_viewer = normalize(camera_position - position.xyz);
  vec3 normal = receiver.shading_normal;
  receiver.mirror = 2.0 * dot(normal, to_viewer) * normal - to_viewer;
  receiver.shape = material.lobe.w;
  receiver.lobe = material.lobe.rgb;
#ifdef WITH_GGX
  receiver.to_viewer = to_viewer;
#endif
#endif
  return receiver;
}

#ifdef WITH_VISIBILITY
float visibility_of(VirtualLight light, int index, inout Receiver receiver) {
#ifdef WITH_LONG_GROUPS
  return receiver.group_visibility;
#elif defined(WITH_GROUPS)
  if (receiver.group_visibility < 0.0) {
    receiver.group_visibility = light_visibility(light, index, receiver);
  }
  return receiver.group_visibility;
#else
  return light_visibility(light, index, receiver);
#endif
}
#endif

#ifdef GLOSSY
float phong_value(Receiver receiver, vec3 direction) {
  float cosine = dot(receiver.mirror, direction);
  if (cosine <= 0.0) return 0.0;
  return (receiver.shape + 2.0) / (2.0 * kPi) * pow(cosine, receiver.shape);
}

#ifdef WITH_GGX
float ggx_slope(float a2, float cosine) { return sqrt(a2 + (1.0 - a2) * cosine * cosine); }

float ggx_value(Receiver receiver, vec3 direction) {
  float a2 = receiver.shape * receiver.shape;
  float outward = dot(receiver.shading_normal, receiver.to_viewer);
  float inward = dot(receiver.shading_normal, direction);
  if (outward <= 0.0 || inward <= 0.0) return 0.0;
  vec3 h = normalize(receiver.to_viewer + direction);
  float cosine = dot(receiver.shading_normal, h);
  vec3 aside = h - cosine * receiver.shading_normal;
  float term = a2 * cosine * cosine + dot(aside, aside);
  float slopes = inward * ggx_slope(a2, outward) + outward * ggx_slope(a2, inward);
  return a2 / (2.0 * kPi * term * term * slopes);
}
#endif

// Of an albedo of 1, 1/sr; formulas and sources in renderers/ray_tracing/glossy_lobe.h.
float lobe_value(Receiver receiver, vec3 direction) {
#ifdef WITH_GGX
  if (receiver.shape < 0.0) return ggx_value(receiver, direction);
#endif
  return phong_value(receiver, direction);
}
#endif

void add_light(VirtualLight light, int index, inout Receiver receiver) {
  vec3 to_light = light.position.xyz - receiver.position;
  float geometry = light_geometry(to_light, receiver.geometric_normal, receiver.shading_normal,
                                  light, geometry_clamp);
#ifdef WITH_VISIBILITY
  if (geometry > 0.0) geometry *= visibility_of(light, index - first_light, receiver);
#endif
  precise vec3 received = light.flux.rgb * geometry;
#ifdef GLOSSY
  if (geometry > 0.0) {
    vec3 direction = to_light * inversesqrt(dot(to_light, to_light));
    receiver.sum += received * receiver.lobe * lobe_value(receiver, direction);
  }
#else
  receiver.sum += received;
#endif
}

void store(Receiver receiver) {
  if (!receiver.is_lit) return;
  float scale = float(interleave * interleave) / kPi;
  vec3 sum = imageLoad(sum_image, receiver.texel).rgb + receiver.sum * scale;
  imageStore(sum_image, receiver.texel, vec4(sum, 1.0));
}

// Texel of a pixel's surface and light.
ivec2 texel_of(ivec2 pixel, ivec2 cell, ivec2 within) {
#ifdef ORDER_SPLIT
  return within * cells + cell;
#else
  return pixel;
#endif
}

// A thread makes so many pixels of its class, x by y, a group's size apart: each load of a light,
// which is most of the work on software drivers, serves them all.
const ivec2 kPixels = ivec2(PIXELS_X, PIXELS_Y);

void main() {
#ifdef ORDER_NAIVE
  ivec2 first_cell = ivec2(gl_GlobalInvocationID.xy) / interleave;
  ivec2 within = ivec2(gl_GlobalInvocationID.xy) - first_cell * interleave;
  int own_class = within.y * interleave + within.x;
#else
  // Classes run fastest, so that their accesses to the same lines of the picture fall together.
  int own_class = first_class + int(gl_WorkGroupID.x);
  ivec2 within = ivec2(own_class % interleave, own_class / interleave);
  ivec2 first_cell =
      ivec2(gl_WorkGroupID.yz) * LOCAL_SIZE * kPixels + ivec2(gl_LocalInvocationID.xy);
#endif
  int classes = interleave * interleave;
  int first = max(first_light, own_class * light_count / classes);
  int end = min(end_light, (own_class + 1) * light_count / classes);
  if (first >= end) return;

  Receiver receivers[PIXELS_X * PIXELS_Y];
  bool is_idle = true;
  for (int k = 0; k < PIXELS_X * PIXELS_Y; ++k) {
    ivec2 cell = first_cell + LOCAL_SIZE * ivec2(k % PIXELS_X, k / PIXELS_X);
    ivec2 pixel = cell * interleave + within;
    bool is_inside = all(lessThan(pixel, size_px));
    receivers[k] = receiver_at(texel_of(pixel, cell, within), is_inside);
    is_idle = is_idle && !receivers[k].is_lit;
  }
  if (is_idle) return;
#ifdef WITH_LONG_GROUPS
  for (int i = first; i < end;) {
    VirtualLight leader = lights[i];
    int group = int(leader.flux.w);
    if (leader.position.w > 0.0) {
      begin_group(group);
      for (int k = 0; k < PIXELS_X * PIXELS_Y; ++k) {
        receivers[k].group_visibility = light_visibility(leader, i - first_light, receivers[k]);
      }
    }
    for (bool is_member = true; is_member;) {
      VirtualLight light = lights[i];
      for (int k = 0; k < PIXELS_X * PIXELS_Y; ++k) add_light(light, i, receivers[k]);
      ++i;
      is_member = i < end && int(lights[i].flux.w) == group;
    }
  }
#else
#ifdef WITH_GROUPS
  int group = -1;
#endif
  for (int i = first; i < end; ++i) {
    VirtualLight light = lights[i];
#ifdef WITH_GROUPS
    if (int(light.flux.w) != group && light.position.w > 0.0) {
      group = int(light.flux.w);
      begin_group(group);
      for (int k = 0; k < PIXELS_X * PIXELS_Y; ++k) receivers[k].group_visibility = -1.0;
    }
#endif
    for (int k = 0; k < PIXELS_X * PIXELS_Y; ++k) add_light(light, i, receivers[k]);
  }
#endif
  for (int k = 0; k < PIXELS_X * PIXELS_Y; ++k) store(receivers[k]);
}
