// Virtual lights from one map of an emitter: each sample takes what the nearest texel shows.
// Inputs: a geometry buffer seen from the emitter (world space, m); samples of this map: texel,
// index of the light and flux that arrives there, W. Outputs: virtual lights, std430; (0) for
// samples that met nothing or a black surface, or whose light comes from below a horizon.
// Dachsbacher and Stamminger 2005, Sec. 4; flux: flux that arrives x albedo x cos_s / cos_g, the
// cosines at the emitter by shading and geometric normal [derived]: the shading normal takes
// irradiance by its own cosine, the surface collects by the geometric one.
#include "renderers/many_lights/shaders/virtual_light.glsl"

layout(local_size_x = 64) in;

struct MapSample {
  vec4 flux;    // rgb, W
  ivec4 where;  // texel x, y; index of the light; 0
};

layout(std430, binding = 3) writeonly buffer VirtualLights { VirtualLight lights[]; };
layout(std430, binding = 4) readonly buffer MapSamples { MapSample samples[]; };
layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D geometric_normal_map;
layout(binding = 2) uniform sampler2D shading_normal_map;
layout(binding = 3) uniform sampler2D albedo_map;
uniform int first_sample;
uniform int sample_count;
uniform vec4 emitter;  // xyz: its position, w = 1; or the direction to it, w = 0

void main() {
  int index = int(gl_GlobalInvocationID.x);
  if (index >= sample_count) return;
  MapSample drawn = samples[first_sample + index];
  ivec2 texel = drawn.where.xy;
  vec4 position = texelFetch(position_map, texel, 0);
  vec3 geometric_normal = texelFetch(geometric_normal_map, texel, 0).xyz;
  vec3 shading_normal = texelFetch(shading_normal_map, texel, 0).xyz;
  vec3 albedo = texelFetch(albedo_map, texel, 0).rgb;

  vec3 to_emitter = emitter.xyz - emitter.w * position.xyz;
  float cosine_g = dot(geometric_normal, to_emitter);
  float cosine_s = dot(shading_normal, to_emitter);
  bool is_lit = position.w > 0.0 && cosine_g > 0.0 && cosine_s > 0.0;
  vec3 flux = is_lit ? drawn.flux.rgb * albedo * (cosine_s / cosine_g) : vec3(0.0);

  VirtualLight light = VirtualLight(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  if (flux != vec3(0.0)) {
    light.position = vec4(position.xyz, 1.0);
    light.geometric_normal = vec4(geometric_normal, 0.0);
    light.shading_normal = vec4(shading_normal, 0.0);
    light.flux = vec4(flux, 0.0);
  }
  lights[drawn.where.z] = light;
}
