// Pass: what every texel receives from a bundle, and what it sends from here on; a thread per
// texel. The sums are made in the order of the lines: the same every time.
// In: crossings by texel, their links; texels; light that senders reflect and emit, radiance; known
// direct light. In, out: sums of directions, feed; counts. Out: light sent in the next bundle.
// `Scatter::add_bucket` and `LightSolution::receive` are the same on the CPU. Light: J = E / pi.
//
// EMISSION: bundles carry emission. RUNNING_MEAN: the feed, else the growing step (`FeedKind`).
// SELF: sums are divided by their weights, else by N / 2.

#include "renderers/ray_bundles/shaders/list_node.glsl"
#include "renderers/ray_bundles/shaders/loop_probe.glsl"
#include "renderers/ray_bundles/shaders/thread_index.glsl"

struct ExchangeTexel {
  vec4 normal;   // xyz: geometric; w: area, m2
  vec4 shading;  // xyz: shading normal
};
// Of one texel: light of both sides and what it weighs.
struct Sums {
  float light[6];
  float weight;
};
struct Counts {
  uint receivers;
  uint pairs;
  uint lit_pairs;
  uint pairs_high;  // of all directions, times 2^32
  uint lit_pairs_high;
  uint cut_off;  // bundles that loops have not come to an end with (loop_probe.glsl)
};

layout(std430, binding = 0) readonly buffer Texels { ExchangeTexel texels[]; };
layout(std430, binding = 1) readonly buffer Links { uvec2 links[]; };
layout(std430, binding = 2) readonly buffer TexelStarts { uint texel_starts[]; };
layout(std430, binding = 3) buffer TexelNodes { uint texel_nodes[]; };
layout(std430, binding = 4) readonly buffer Albedos { float albedos[]; };  // 3 per texel
// 3 per side, as all below.
layout(std430, binding = 5) readonly buffer Known { float known[]; };
layout(std430, binding = 6) readonly buffer Emitted { float emitted[]; };
layout(std430, binding = 7) readonly buffer Sent { float sent[]; };
layout(std430, binding = 8) writeonly buffer NextSent { float next_sent[]; };
layout(std430, binding = 9) buffer Feed { float feed[]; };
layout(std430, binding = 10) buffer Direct { Sums direct[]; };
layout(std430, binding = 11) buffer Window { Sums window[]; };
layout(std430, binding = 12) buffer TexelCounts { Counts counts[]; };

uniform uint texel_count;
uniform vec3 direction;
uniform float pixel_area_m2;
uniform float direction_weight;
uniform float directions;  // this one included
uniform float step_count;  // i of the growing step; <= 0: bundles carry no reflected light yet
uniform float step_k;
uniform vec3 light_ahead;  // of the environment
uniform vec3 light_behind;
uniform int has_back_sides;

vec3 sent_by(uint side) { return vec3(sent[3 * side], sent[3 * side + 1], sent[3 * side + 2]); }
vec3 emitted_by(uint side) {
  return vec3(emitted[3 * side], emitted[3 * side + 1], emitted[3 * side + 2]);
}

// Of a side, from one direction.
struct SideLight {
  vec3 emitted;
  vec3 reflected;
};

void add_sender(uint sender, inout SideLight light, inout Counts here) {
  if (sender >= kBehind) {
    light.emitted += sender == kAhead ? light_ahead : light_behind;
    return;
  }
  vec3 reflected = sent_by(sender);
  light.reflected += reflected;
  bool is_lit = reflected != vec3(0.0);
#ifdef EMISSION
  vec3 own = emitted_by(sender);
  light.emitted += own;
  is_lit = is_lit || own != vec3(0.0);
#endif
  here.pairs += 1u;
  here.lit_pairs += is_lit ? 1u : 0u;
}

#define COMES_BEFORE(a, b) a < b
#define SORTED_TYPE uint
#define SORTED texel_nodes
#include "renderers/ray_bundles/shaders/shell_sort.glsl"

vec3 mean(vec3 sum, float weight) {
#ifdef SELF
  return weight > 0.0 ? sum / weight : vec3(0.0);
#else
  return sum * (2.0 / directions);
#endif
}

void receive_side(uint texel, uint s, float weight, SideLight light) {
  uint side = 2u * texel + s;
  vec3 fed = vec3(feed[3 * side], feed[3 * side + 1], feed[3 * side + 2]);
  // In the dark, and so far always: nothing changes. Half of all sides look out of closed scenes.
  if (light.reflected == vec3(0.0) && light.emitted == vec3(0.0) && fed == vec3(0.0) &&
      sent_by(side) == vec3(0.0)) {
    for (int c = 0; c < 3; ++c) next_sent[3 * side + c] = 0.0;
    return;
  }
  vec3 incident = vec3(known[3 * side], known[3 * side + 1], known[3 * side + 2]);
  if (step_count > 0.0) {
    for (int c = 0; c < 3; ++c) window[texel].light[3 * s + c] += light.reflected[c];
#ifdef RUNNING_MEAN
    vec3 sum = vec3(window[texel].light[3 * s], window[texel].light[3 * s + 1],
                    window[texel].light[3 * s + 2]);
    fed = mean(sum, direct[texel].weight);
#else
    float share = min(1.0, 2.0 * weight * step_k / (step_count + step_k));
    fed += share * (light.reflected / weight - fed);
#endif
    for (int c = 0; c < 3; ++c) feed[3 * side + c] = fed[c];
  }
  incident += fed;
#ifdef EMISSION
  for (int c = 0; c < 3; ++c) direct[texel].light[3 * s + c] += light.emitted[c];
  incident += mean(vec3(direct[texel].light[3 * s], direct[texel].light[3 * s + 1],
                        direct[texel].light[3 * s + 2]),
                   direct[texel].weight);
#endif
  for (int c = 0; c < 3; ++c) next_sent[3 * side + c] = albedos[3 * texel + c] * incident[c];
}

void main() {
  uint texel = thread_index();
  if (texel >= texel_count) return;
  uint begin = texel_starts[texel];
  uint end = texel_starts[texel + 1u];
  sort(begin, end);

  SideLight sides[2];
  sides[0] = SideLight(vec3(0.0), vec3(0.0));
  sides[1] = sides[0];
  Counts here = Counts(0u, 0u, 0u, 0u, 0u, 0u);
  for (uint i = begin; i < end; ++i) {
    uint node = texel_nodes[i];
    uvec2 link = links[node >> 1];
    bool is_turned = (node & 1u) != 0u;
    add_sender(is_turned ? link.y : link.x, sides[0], here);
    add_sender(is_turned ? link.x : link.y, sides[1], here);
  }
  if (are_loops_cut_off()) counts[texel].cut_off += 1u;

  ExchangeTexel t = texels[texel];
  float geometric = dot(t.normal.xyz, direction);
  float shading = dot(t.shading.xyz, direction);
  // Seen from the side to the last bit: crossings there are rounding, a density has none.
  float weight = geometric == 0.0 ? 0.0 : float(end - begin);
  if (weight > 0.0) {
    // Lines meet the surface with density |n_g . w|; the shading normal's cosine takes its place.
    float per_line = pixel_area_m2 / (t.normal.w * abs(geometric));
    float lit = direction_weight * per_line * max(0.0, geometric < 0.0 ? -shading : shading);
    weight *= direction_weight * per_line * abs(shading);
    for (int s = 0; s < 2; ++s) {
      sides[s].emitted *= lit;
      sides[s].reflected *= lit;
    }
    here.receivers = 2u;
  }
  if (weight <= 0.0) {
    // A texel that the bundle misses goes on sending what it sent.
    for (uint i = 6u * texel; i < 6u * texel + 6u; ++i) next_sent[i] = sent[i];
    if (here.pairs == 0u) return;
  }
  counts[texel].receivers += here.receivers;
  uint carry;
  counts[texel].pairs = uaddCarry(counts[texel].pairs, here.pairs, carry);
  counts[texel].pairs_high += carry;
  counts[texel].lit_pairs = uaddCarry(counts[texel].lit_pairs, here.lit_pairs, carry);
  counts[texel].lit_pairs_high += carry;
  if (weight <= 0.0) return;
  direct[texel].weight += weight;
  if (step_count > 0.0) window[texel].weight += weight;
  receive_side(texel, 0u, weight, sides[0]);
  if (has_back_sides != 0) receive_side(texel, 1u, weight, sides[1]);
}
