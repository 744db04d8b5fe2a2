// Bounds of curved images in hemispherical maps.

#include "renderers/shadow_maps/shaders/hemisphere.glsl"

// Bounds of the arc of a great circle: those of its ends and of the circle's extreme points that
// lie on it. The plane through the centre with normal n meets the map in the circle
// r2 - 2 (x n.x + y n.y) / n.z = 1 (from the inverse projection): centre n.xy / n.z, radius
// |n| / |n.z|.
//
// a, b: ends in the map's frame, any length, not below the horizon.
void add_arc(vec3 a, vec3 b, inout vec2 least, inout vec2 greatest) {
  const float kStraight = 1.0e-6;  // the sagitta of the arc is then below 1e-6
  vec2 ends[2] = vec2[2](hemisphere_position(a), hemisphere_position(b));
  least = min(least, min(ends[0], ends[1]));
  greatest = max(greatest, max(ends[0], ends[1]));
  vec3 n = cross(a, b);
  float length_n = length(n);
  if (abs(n.z) <= kStraight * length_n) return;
  vec2 center = n.xy / n.z;
  float radius = length_n / abs(n.z);
  vec3 from_a = cross(n, a);
  vec3 to_b = cross(b, n);
  for (int i = 0; i < 4; ++i) {
    vec2 extreme = center;
    extreme[i >> 1] += (i & 1) == 0 ? -radius : radius;
    vec3 direction = hemisphere_direction(extreme);
    if (dot(direction, from_a) > 0.0 && dot(direction, to_b) > 0.0) {
      least = min(least, extreme);
      greatest = max(greatest, extreme);
    }
  }
}

// Bounds (least, greatest) of a triangle's part above the horizon; least > greatest if there is
// none. The part is a convex polygon, whose image is bounded by arcs.
vec4 triangle_bounds(vec3 vertex[3]) {
  vec2 least = vec2(2.0);
  vec2 greatest = vec2(-2.0);
  vec3 crossing[2] = vec3[2](vec3(0.0), vec3(0.0));
  int crossings = 0;
  for (int i = 0; i < 3; ++i) {
    vec3 a = vertex[i];
    vec3 b = vertex[(i + 1) % 3];
    if (a.z < 0.0 && b.z < 0.0) continue;
    if ((a.z < 0.0) != (b.z < 0.0)) {
      vec3 cut = vec3((a.xy * b.z - b.xy * a.z) / (b.z - a.z), 0.0);
      crossing[min(crossings, 1)] = cut;
      ++crossings;
      if (a.z < 0.0) a = cut;
      else b = cut;
    }
    add_arc(a, b, least, greatest);
  }
  if (crossings == 2) add_arc(crossing[0], crossing[1], least, greatest);
  return vec4(least, greatest);
}
