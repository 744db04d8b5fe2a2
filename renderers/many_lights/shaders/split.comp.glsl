// A picture sorted by the pixels' classes into n x n blocks of `cells` texels, or with MERGE back.
// Inputs: `source`, any rgba texture. Outputs: `target`. The explicit form of interleaved shading,
// Segovia et al. 2006, Sec. 3.
layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 0) uniform sampler2D source;
layout(rgba32f, binding = 0) writeonly uniform image2D target;
uniform ivec2 size_px;
uniform ivec2 cells;  // ceil(size / n)
uniform int interleave;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size_px))) return;
  ivec2 cell = pixel / interleave;
  ivec2 sorted = (pixel - cell * interleave) * cells + cell;
#ifdef MERGE
  imageStore(target, pixel, texelFetch(source, sorted, 0));
#else
  imageStore(target, sorted, texelFetch(source, pixel, 0));
#endif
}
