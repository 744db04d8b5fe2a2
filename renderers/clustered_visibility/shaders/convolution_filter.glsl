// Means over boxes of a map's texels from a series of the depth comparison f(d, z) = [d <= z]:
//   f ~ 1/2 + sum_k w_k sin(c_k (z - d)),   c_k = pi (2k - 1),   w_k = 2 / c_k exp(-a (k / K)^2),
// Annen et al. 2007, recalled; damping a: the same, recalled. The means of sin(c_k z), cos(c_k z)
// give that of f, those times z and that of z the mean of f z (Annen et al. 2008, recalled).
// SERIES_WEIGHTS: w_k, four to a vector. PREFILTER_SAT: summed-area tables, else levels.
//
// At d = z the series gives 1/2. FIX_OFFSET: it is taken at d - 1 / (2K), its first maximum. Else
// it is doubled and clamped (both recalled from Annen et al. 2007).

#ifdef PREFILTER_SAT
layout(binding = 4) uniform isampler2DArray sine_map;
layout(binding = 5) uniform isampler2DArray cosine_map;
layout(binding = 6) uniform isampler2DArray weighted_sine_map;
layout(binding = 7) uniform isampler2DArray weighted_cosine_map;
layout(binding = 9) uniform isampler2DArray depth_map;
#define BasisMap isampler2DArray
#include "renderers/clustered_visibility/shaders/table_mean.glsl"
#else
layout(binding = 4) uniform sampler2DArray sine_map;
layout(binding = 5) uniform sampler2DArray cosine_map;
layout(binding = 6) uniform sampler2DArray weighted_sine_map;
layout(binding = 7) uniform sampler2DArray weighted_cosine_map;
layout(binding = 9) uniform sampler2DArray depth_map;
#define BasisMap sampler2DArray
#endif

uniform float slope_bias;        // see `biased_depth`
uniform float contact_strength;  // A of s^(1 + A exp(-B (d - z_avg))); 0: off
uniform float contact_range;     // B

const vec4 kWeights[GROUPS] = SERIES_WEIGHTS;
const float kLeastBlocked = 0.05;  // share below which a receiver is taken as lit; ours
const float kMostBias = 0.5;       // of the receiver's depth; ours
const float kFirstMaximum = 0.5 / float(TERMS);

#ifndef PREFILTER_SAT
uniform float finer_levels;

// Trilinear, at the box's centre: the level whose texels are as wide as the box, less finer_levels.
// A level's texel reaches over twice its width; half a level finer it has the box's variance
// (derived: T^2 / 6 of a tent of half width T, w^2 / 12 of a box of width w).
vec4 box_mean(sampler2DArray map, vec2 center, float width, int layer) {
  float level = max(log2(max(width * float(textureSize(map, 0).x), 1.0)) - finer_levels, 0.0);
  return textureLod(map, vec3(center, float(layer)), level);
}
#endif

// sum_k w_k sin(c_k (z - depth)) of the means of sines and cosines.
float series(BasisMap sines, BasisMap cosines, Kernel kernel, float width, float depth) {
  float sum = 0.0;
  for (int group = 0; group < GROUPS; ++group) {
    vec4 k = float(4 * group) + vec4(1.0, 2.0, 3.0, 4.0);
    vec4 angle = kHalfTurn * (2.0 * k - 1.0) * depth;
    int layer = kernel.cluster * GROUPS + group;
    vec4 terms = box_mean(sines, kernel.center, width, layer) * cos(angle) -
                 box_mean(cosines, kernel.center, width, layer) * sin(angle);
    sum += dot(kWeights[group], terms);
  }
  return sum;
}

// Depth that a box is compared with: the receiver's less `slope_bias` times what its plane rises
// from the box's centre to its edge, so that a slanted receiver does not shadow itself (ours).
float biased_depth(Kernel kernel, float width) {
  float share = slope_bias * plane_rise(kernel, width, textureSize(sine_map, 0).x);
  return kernel.depth * (1.0 - min(share, kMostBias));
}

// Dong et al. 2009, Sec. 4.1: the mean depth of what lies before the receiver, [w * f z] / [w * f]
// with f = [z < d]; the receiver's own depth where nothing does.
//
// As printed, what lies at the receiver's own depth counts as half a blocker, which draws the mean
// towards the receiver. BLOCKER_CORRECTED: with FIX_OFFSET it counts as none; else its share is
// taken out: with A and B the two means, f = 2B - 1 and z_avg = (A - (1 - B) d) / (2B - 1) (derived).
float blocker_depth(Kernel kernel, float width) {
#if defined(BLOCKER_CORRECTED) && defined(FIX_OFFSET)
  float depth = biased_depth(kernel, width) - kFirstMaximum;
#else
  float depth = biased_depth(kernel, width);
#endif
  float blocked = 0.5 - series(sine_map, cosine_map, kernel, width, depth);
  float z = box_mean(depth_map, kernel.center, width, kernel.cluster).r;
  float sum = 0.5 * z - series(weighted_sine_map, weighted_cosine_map, kernel, width, depth);
#if defined(BLOCKER_CORRECTED) && !defined(FIX_OFFSET)
  sum -= (1.0 - blocked) * depth;
  blocked = 2.0 * blocked - 1.0;
#endif
#ifdef BLOCKER_CORRECTED
  if (blocked < kLeastBlocked) return kernel.depth;
#else
  if (blocked <= 0.0) return kernel.depth;
#endif
  return clamp(sum / blocked, 0.0, kernel.depth);
}

float lit_share(Kernel kernel, float width, float blocker) {
  float depth = biased_depth(kernel, width);
#ifdef FIX_OFFSET
  float share = 0.5 + series(sine_map, cosine_map, kernel, width, depth - kFirstMaximum);
#else
  float share = 1.0 + 2.0 * series(sine_map, cosine_map, kernel, width, depth);
#endif
  share = clamp(share, 0.0, 1.0);
  if (contact_strength > 0.0) {
    // Darker contacts: the first author's later text on the same maps, recalled.
    float apart = kernel.depth - blocker;
    share = pow(share, 1.0 + contact_strength * exp(-contact_range * apart));
  }
  return share;
}
