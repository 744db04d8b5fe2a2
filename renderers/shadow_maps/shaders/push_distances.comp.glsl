// Pass: empty texels of a finer level take the distance of the coarser one.
// In: coarser (r32ui, bits of metres). In, out: finer.
// Source: Ritschel et al. 2008, push phase, recalled.

layout(local_size_x = 8, local_size_y = 8) in;

layout(r32ui, binding = 0) uniform uimage2DArray finer;
layout(r32ui, binding = 1) uniform uimage2DArray coarser;

const uint kInfinity = 0x7f800000u;

void main() {
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel.xy, imageSize(finer).xy))) return;
  if (imageLoad(finer, texel).r != kInfinity) return;
  // An odd last column has no coarser texel of its own.
  ivec2 parent = min(texel.xy / 2, imageSize(coarser).xy - 1);
  imageStore(finer, texel, imageLoad(coarser, ivec3(parent, texel.z)));
}
