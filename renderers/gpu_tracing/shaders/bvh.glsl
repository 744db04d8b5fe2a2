// Walk of a ray through a hierarchy of boxes with triangles; BvhNode and BvhTriangle of
// triangle_bvh.h. World space, metres. Bindings 6 and 7.
//
// Who includes this defines `bool bvh_stops_at(BvhHit hit)`, which is called for every triangle on
// the ray, in no order: true ends the walk. "Is anything there" returns true at once; "all that is
// there" keeps the hit and returns false.
//
// Sources: Smits 1998, doi:10.1080/10867651.1998.10487488 (skip links in place of a stack); Ize
// 2013, "Robust BVH Ray Traversal", JCGT 2(2) (padded box test); the edge functions in Pluecker
// form about the ray's origin, as Embree's robust mode evaluates them (Wald et al. 2014,
// doi:10.1145/2601097.2601199): an edge has the same value, but for its sign, in both triangles
// that share it, so that no ray slips between them.

struct BvhNode {
  vec3 low;
  uint skip;  // the node to go on with if the ray misses the box
  vec3 high;
  uint leaf;  // 0: inner node; else first triangle x 16 + number of triangles
};

struct BvhTriangle {
  vec3 a;  // counter-clockwise from the front
  uint object;
  vec3 b;
  uint triangle;
  vec3 c;
  uint unused;
};

layout(std430, binding = 6) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(std430, binding = 7) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };

uniform uint bvh_node_count;

// Points origin + t direction, 0 <= t <= t_max.
struct BvhRay {
  vec3 origin;
  vec3 direction;
  float t_max;  // may be infinite
};

struct BvhHit {
  float t;
  uint object;
  uint triangle;
  vec2 barycentrics;  // weights of the second and third corner
  bool looks_back;    // the front side looks towards the ray's origin
};

bool bvh_stops_at(BvhHit hit);

// Machine epsilon.
const float kBvhUlp = 1.1920929e-7;
// Directions' coordinates of less than this count as this.
const float kBvhLeastSlope = 1.0e-18;
// Of the far distance of a box: 1 + 2 gamma(3), Ize 2013, Sec. 3.
const float kBvhFarther = 1.0 + 3.0 * kBvhUlp;

vec3 bvh_cross(vec3 a, vec3 b) {
  precise vec3 crossed = vec3(fma(a.y, b.z, -(a.z * b.y)), fma(a.z, b.x, -(a.x * b.z)),
                              fma(a.x, b.y, -(a.y * b.x)));
  return crossed;
}

float bvh_dot(vec3 a, vec3 b) {
  precise float product = fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
  return product;
}

// Normal of a triangle from two of its corners, whichever rounds less, coordinate by coordinate.
vec3 bvh_normal(vec3 edge0, vec3 edge1, vec3 edge2) {
  precise vec3 first = abs(edge0.zxy * edge1.yzx);
  precise vec3 second = abs(edge1.zxy * edge2.yzx);
  return mix(bvh_cross(edge1, edge2), bvh_cross(edge0, edge1), lessThan(first, second));
}

// Whether the ray meets the triangle, on either side; the hit, less its names, if so.
bool bvh_meets(vec3 a, vec3 b, vec3 c, BvhRay ray, out BvhHit hit) {
  precise vec3 v0 = a - ray.origin;
  precise vec3 v1 = b - ray.origin;
  precise vec3 v2 = c - ray.origin;
  precise vec3 edge0 = v2 - v0;
  precise vec3 edge1 = v0 - v1;
  precise vec3 edge2 = v1 - v2;
  precise vec3 sum0 = v2 + v0;
  precise vec3 sum1 = v0 + v1;
  precise vec3 sum2 = v1 + v2;
  // Volumes between the ray and each edge: all of one sign inside.
  precise vec3 volume = vec3(bvh_dot(bvh_cross(edge0, sum0), ray.direction),
                             bvh_dot(bvh_cross(edge1, sum1), ray.direction),
                             bvh_dot(bvh_cross(edge2, sum2), ray.direction));
  precise float all = volume.x + volume.y + volume.z;
  float slack = kBvhUlp * abs(all);
  float least = min(volume.x, min(volume.y, volume.z));
  float greatest = max(volume.x, max(volume.y, volume.z));
  if (!(least >= -slack || greatest <= slack)) return false;

  vec3 normal = bvh_normal(edge0, edge1, edge2);
  precise float slope = bvh_dot(normal, ray.direction);
  if (slope == 0.0) return false;
  precise float t = bvh_dot(v0, normal) / slope;
  if (!(t >= 0.0 && t <= ray.t_max)) return false;
  hit.t = t;
  hit.barycentrics = volume.xy / all;
  hit.looks_back = slope < 0.0;
  return true;
}

// From `node` on, the ray's way through at most so many boxes; 0 is the beginning.
// @return true if `bvh_stops_at` ended it; else it is at its end where node == bvh_node_count, and
//   before it where the boxes were used up: another call goes on.
bool bvh_walk(BvhRay ray, uint most_boxes, inout uint node) {
  // An origin on a box's plane: no 0 x infinity.
  vec3 slope = mix(ray.direction, vec3(kBvhLeastSlope),
                   lessThan(abs(ray.direction), vec3(kBvhLeastSlope)));
  vec3 inverse = 1.0 / slope;
  bool is_stopped = false;
  for (uint i = 0; i < most_boxes && node < bvh_node_count && !is_stopped; ++i) {
    BvhNode box = bvh_nodes[node];
    vec3 to_low = (box.low - ray.origin) * inverse;
    vec3 to_high = (box.high - ray.origin) * inverse;
    vec3 enters = min(to_low, to_high);
    vec3 leaves = max(to_low, to_high);
    float first = max(max(enters.x, enters.y), max(enters.z, 0.0));
    float last = min(min(leaves.x, leaves.y), min(leaves.z, ray.t_max));
    if (first > last * kBvhFarther) {
      node = box.skip;
      continue;
    }
    ++node;
    uint index = box.leaf / 16u;
    uint end = index + box.leaf % 16u;
    for (; index < end && !is_stopped; ++index) {
      BvhTriangle triangle = bvh_triangles[index];
      BvhHit hit;
      if (!bvh_meets(triangle.a, triangle.b, triangle.c, ray, hit)) continue;
      hit.object = triangle.object;
      hit.triangle = triangle.triangle;
      is_stopped = bvh_stops_at(hit);
    }
  }
  return is_stopped;
}
