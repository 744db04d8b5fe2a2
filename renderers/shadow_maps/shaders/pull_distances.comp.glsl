// Pass: a coarser level from a finer one: the mean of those of four distances that are like the
// nearest of them; infinity where all four are empty.
// In: finer (r32ui, bits of metres). Out: coarser, half as wide (rounded down).
// Source: Ritschel et al. 2008, pull phase, recalled.

layout(local_size_x = 8, local_size_y = 8) in;

layout(r32ui, binding = 0) uniform uimage2DArray finer;
layout(r32ui, binding = 1) uniform uimage2DArray coarser;

// Relative distance up to which two texels are taken as one surface.
const float kLike = 0.1;
const uint kInfinity = 0x7f800000u;

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel.xy, imageSize(coarser).xy))) return;
  float distances_m[4];
  float nearest_m = uintBitsToFloat(kInfinity);
  for (int i = 0; i < 4; ++i) {
    ivec3 child = ivec3(2 * texel.xy + ivec2(i & 1, i >> 1), texel.z);
    distances_m[i] = uintBitsToFloat(imageLoad(finer, child).r);
    nearest_m = min(nearest_m, distances_m[i]);
  }
  uint pulled = kInfinity;
  if (floatBitsToUint(nearest_m) != kInfinity) {
    float sum_m = 0.0;
    float count = 0.0;
    for (int i = 0; i < 4; ++i) {
      if (distances_m[i] > nearest_m * (1.0 + kLike)) continue;
      sum_m += distances_m[i];
      count += 1.0;
    }
    pulled = floatBitsToUint(sum_m / count);
  }
  imageStore(coarser, texel, uvec4(pulled));
}
