// Pass: counts the crossings of every line. In: fragments. Out: counts per line.

layout(std430, binding = 2) buffer Counts { uint counts[]; };

uniform int width_px;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  atomicAdd(counts[pixel.y * width_px + pixel.x], 1u);
}
