// Shares of boxes of a map's texels that lie before a receiver, from the moments of their depths:
// soft shadows with two lookups, or two in each of several boxes.
// Sources: Peters and Klein 2015 (moment_atoms.glsl); Peters, Muenstermann, Wetzstein and Klein 2017,
// "Improved Moment Shadow Maps", JCGT 6(1), for two lookups in place of percentage-closer soft
// shadows', its details recalled.

#include "renderers/clustered_visibility/shaders/moment_atoms.glsl"

layout(binding = 4) uniform sampler2DArray moment_map;

uniform float moment_finer_levels;
uniform float moment_slope;   // see `blockers_of`
uniform float moment_bias;    // see `atoms_of`
uniform float blocked_bias;   // share of blockers taken to lie at the receiver

const float kMostRise = 0.15;    // of the receiver's depth; ours, measured
const float kLeastTexels = 2.0;  // width of what a lookup of the finest level reaches over
const float kLeastRise = 1e-6;   // ours

// Trilinear, at the box's centre; finer_levels as in convolution_filter.glsl.
Atoms atoms_in(Kernel kernel, float width) {
  float texels = max(width * float(textureSize(moment_map, 0).x), 1.0);
  float level = max(log2(texels) - moment_finer_levels, 0.0);
  vec4 moments = textureLod(moment_map, vec3(kernel.center, float(kernel.cluster)), level);
  return atoms_of(moments, 2.0 * kernel.depth - 1.0, moment_bias);
}

// Masses of the atoms before the receiver. Those nearer to it than `moment_slope` times what its
// plane rises within the box may be the receiver's own and do not count; at twice that they count in
// full (ours). Unlike a bias this leaves the mass at the receiver where it is, out of the others'.
vec2 blockers_of(Atoms atoms, Kernel kernel, float width) {
  int size_px = textureSize(moment_map, 0).x;
  float reached = max(width, kLeastTexels / float(size_px));
  float share = moment_slope * plane_rise(kernel, reached, size_px);
  float rise = max(min(share, kMostRise) * kernel.depth, kLeastRise);
  vec2 before = kernel.depth - (0.5 * atoms.depth + 0.5);
  return atoms.mass * clamp(before / rise - 1.0, 0.0, 1.0);
}

// Boxes side by side that a kernel's box is made of: a lookup each, as several surfaces behind each
// other are fewer in a smaller one. MOMENT_TAPS: along a side.
const int kBoxes = MOMENT_TAPS * MOMENT_TAPS;

// Masses before the receiver in box i of the kernel's; their depths in `depth`.
vec2 blockers_in(int i, Kernel kernel, float width, out vec2 depth) {
  Kernel part = kernel;
  vec2 place = (vec2(i % MOMENT_TAPS, i / MOMENT_TAPS) + 0.5) / float(MOMENT_TAPS) - 0.5;
  part.center += width * place;
  Atoms atoms = atoms_in(part, width / float(MOMENT_TAPS));
  depth = 0.5 * atoms.depth + 0.5;
  return blockers_of(atoms, kernel, width);
}

// Mean depth of what lies before the receiver; the receiver's own where nothing does.
float blocker_depth(Kernel kernel, float width) {
  float blocked = 0.0;
  float sum = 0.0;
  for (int i = 0; i < kBoxes; ++i) {
    vec2 depth;
    vec2 blockers = blockers_in(i, kernel, width, depth);
    blocked += (blockers.x + blockers.y) / float(kBoxes);
    sum += dot(blockers, depth) / float(kBoxes);
  }
  if (blocked <= 0.0) return kernel.depth;
  sum += blocked_bias * kernel.depth;
  return clamp(sum / (blocked + blocked_bias), 0.0, kernel.depth);
}

float lit_share(Kernel kernel, float width, float blocker) {
  float blocked = 0.0;
  for (int i = 0; i < kBoxes; ++i) {
    vec2 depth;
    vec2 blockers = blockers_in(i, kernel, width, depth);
    blocked += clamp(blockers.x + blockers.y, 0.0, 1.0) / float(kBoxes);
  }
  return 1.0 - blocked;
}
