// Pass: writes every crossing into its line's list, in any order. In: fragments; starts of the
// lists; counts per line, which end as 0. Out: a word per crossing: its triangle, and in the lowest
// bit whether that runs counter-clockwise in the raster, so that its back side is the near one.

layout(std430, binding = 2) buffer Counts { uint counts[]; };
layout(std430, binding = 3) readonly buffer Starts { uint starts[]; };
layout(std430, binding = 4) writeonly buffer Words { uint words[]; };

layout(location = 0) flat in uint triangle;

uniform int width_px;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  int line = pixel.y * width_px + pixel.x;
  uint left = atomicAdd(counts[line], 0xffffffffu);
  // Was not counted: order_lines.comp.glsl finds the count beyond 0.
  if (left - 1u >= starts[line + 1] - starts[line]) return;
  words[starts[line] + left - 1u] = 2u * triangle + uint(gl_FrontFacing);
}
