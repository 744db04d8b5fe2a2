// Radiance that leaves the pixels' surfaces, added to a sum with a weight.
// Inputs: albedo, irradiance, W/m2, and with WITH_GLOSSY the reflected radiance of the lobes.
// Output: sum += weight (albedo / pi x irradiance + glossy), W/(m2 sr): Lambert's reflection.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D albedo_map;
layout(binding = 2) uniform sampler2D irradiance_map;
layout(binding = 3) uniform sampler2D glossy_map;
layout(rgba32f, binding = 0) uniform image2D sum;
uniform ivec2 size_px;
uniform float weight;

const float kPi = 3.14159265358979;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size_px))) return;
  if (texelFetch(position_map, pixel, 0).w <= 0.0) return;
  vec3 albedo = texelFetch(albedo_map, pixel, 0).rgb;
  vec3 radiance = albedo / kPi * texelFetch(irradiance_map, pixel, 0).rgb;
#ifdef WITH_GLOSSY
  radiance += texelFetch(glossy_map, pixel, 0).rgb;
#endif
  vec4 before = imageLoad(sum, pixel);
  imageStore(sum, pixel, before + weight * vec4(radiance, 1.0));
}
