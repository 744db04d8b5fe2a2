// Shares of boxes of a map's texels that lie before a receiver, from the moments of their depths:
// soft shadows with two lookups.
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

// Mean depth of what lies before the receiver; the receiver's own where nothing does.
float blocker_depth(Kernel kernel, float width) {
  Atoms atoms = atoms_in(kernel, width);
  vec2 blockers = blockers_of(atoms, kernel, width);
  float blocked = blockers.x + blockers.y;
  if (blocked <= 0.0) return kernel.depth;
  float sum = dot(blockers, 0.5 * atoms.depth + 0.5) + blocked_bias * kernel.depth;
  return clamp(sum / (blocked + blocked_bias), 0.0, kernel.depth);
}

float lit_share(Kernel kernel, float width, float blocker) {
  vec2 blockers = blockers_of(atoms_in(kernel, width), kernel, width);
  return clamp(1.0 - blockers.x - blockers.y, 0.0, 1.0);
}
