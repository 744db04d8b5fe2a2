// Pass: distances from the depths of maps drawn by their vertices.
// In: depths (depth32f), origins. Out: distances (r32ui, bits of metres, cleared to infinity).
//
// The rasteriser samples texels at their centres, and the horizon's arc is made of chords: texels
// at the rim that nothing covers take the distance of one inwards of them.

#include "renderers/shadow_maps/shaders/hemisphere.glsl"
#include "renderers/shadow_maps/shaders/vertex_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2DArray depths;
layout(r32ui, binding = 0) writeonly uniform uimage2DArray distances;

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  int size_px = imageSize(distances).x;
  if (any(greaterThanEqual(texel.xy, ivec2(size_px)))) return;
  vec2 position = (2.0 * vec2(texel.xy) + 1.0) / float(size_px) - 1.0;
  float radius = length(position);
  // A texel is 2 / size wide, half its diagonal is sqrt(2) / size.
  float half_diagonal = 1.41421356 / float(size_px);
  if (radius > 1.0 + half_diagonal) return;
  float depth = texelFetch(depths, texel, 0).r;
  if (depth <= 0.0 && radius > 1.0 - half_diagonal) {
    ivec2 inwards = hemisphere_texel(position / radius * (1.0 - 2.0 * half_diagonal), size_px);
    depth = texelFetch(depths, ivec3(inwards, texel.z), 0).r;
  }
  if (depth <= 0.0) return;
  float distance_m = (1.0 - depth) * depth_range(map_center(texel.z));
  imageStore(distances, texel, uvec4(floatBitsToUint(distance_m)));
}
