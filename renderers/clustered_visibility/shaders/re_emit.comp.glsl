// Pass: light that surface points received becomes virtual lights; a thread per point.
// In: points, their receivers (place_receivers.comp.glsl), irradiance of these, W/m2. Out: virtual
// lights, each in its place, (0) where nothing is reflected. Formulas: re_emission.h; ours.

#include "renderers/many_lights/shaders/virtual_light.glsl"
#include "renderers/clustered_visibility/shaders/placed_point.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 3) writeonly buffer VirtualLights { VirtualLight lights[]; };
layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D geometric_normal_map;
layout(binding = 2) uniform sampler2D shading_normal_map;
layout(binding = 3) uniform sampler2D albedo_map;
layout(binding = 4) uniform sampler2D irradiance_map;
uniform float point_area;  // m2

// Rec. 709.
const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);

// W.
vec3 reflected(ivec2 texel) {
  return texelFetch(albedo_map, texel, 0).rgb * texelFetch(irradiance_map, texel, 0).rgb *
         point_area;
}

void main() {
  int own = int(gl_GlobalInvocationID.x);
  if (own >= point_count) return;
  PlacedPoint point = points[own];
  vec3 front = reflected(texel_of(own));
  vec3 back = reflected(texel_of(point_count + own));
  float front_power = dot(front, kLuminance);
  float back_power = dot(back, kLuminance);
  float power = front_power + back_power;

  VirtualLight light = VirtualLight(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  if (power > 0.0) {
    bool is_front = point.position.w * power < front_power;
    ivec2 texel = texel_of(is_front ? own : point_count + own);
    vec3 flux = is_front ? front : back;
    float share = (is_front ? front_power : back_power) / power;
    light.position = texelFetch(position_map, texel, 0);
    light.geometric_normal = vec4(texelFetch(geometric_normal_map, texel, 0).xyz, 0.0);
    light.shading_normal = texelFetch(shading_normal_map, texel, 0);
    light.flux = vec4(flux / share, 0.0);
  }
  lights[point.where.y] = light;
}
