// Pass: every triangle against a run of layers. Draws images that cover few texels, queues others.
// In: triangles and their spheres, origins. Out: distances (r32ui, cleared to infinity), queue.
//
// The sphere around a triangle is seen as a cap of directions, whose image is a circle: a cap
// around the unit direction u with angular radius rho has its centre at u.xy / (u.z + cos rho) and
// the radius sin rho / (u.z + cos rho) (from the inverse projection, derived). Most triangles'
// circles hold no texel centre, and cost no more than this.

#include "renderers/shadow_maps/shaders/map_triangle.glsl"
#include "renderers/shadow_maps/shaders/map_queue.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 4) readonly buffer Spheres { vec4 spheres[]; };

uniform int triangle_count;
uniform int layers_per_thread;
uniform int direct_texels;  // at most so many covered are drawn here

void draw_all(int triangle, MapCenter center, int layer, ivec4 covered) {
  MapTriangle t = map_triangle(triangle, center);
  for (int y = covered.y; y <= covered.w; ++y) {
    for (int x = covered.x; x <= covered.z; ++x) draw_texel(t, ivec2(x, y), layer);
  }
#ifdef COUNT_WORK
  atomicAdd(small_pairs, 1u);
  atomicAdd(texels_small, uint((covered.z - covered.x + 1) * (covered.w - covered.y + 1)));
#endif
}

void main() {
  int triangle = int(gl_GlobalInvocationID.x);
  if (triangle >= triangle_count) return;
  vec4 sphere = spheres[triangle];
  int first = int(gl_WorkGroupID.y) * layers_per_thread;
  int end = min(first + layers_per_thread, layer_count);
  for (int layer = first; layer < end; ++layer) {
    MapCenter center = map_center(layer);
    if (center.is_empty) continue;
    vec3 to_sphere = sphere.xyz - center.position;
    float height = dot(to_sphere, center.axis);
    // Wholly below the horizon or the clip height.
    if (height < -sphere.w || is_surely_clipped(center, height + sphere.w)) continue;

    ivec4 covered = ivec4(0, 0, size_px - 1, size_px - 1);
    float tangent2 = dot(to_sphere, to_sphere) - sphere.w * sphere.w;
    float scale = height + sqrt(max(tangent2, 0.0));
    // Else the centre is in the sphere, or the cap reaches to the lower pole.
    if (tangent2 > 0.0 && scale > 1.0e-3 * sphere.w) {
      vec2 middle = (to_sphere * hemisphere_frame(center.axis)).xy / scale;
      covered = texels_of(middle - sphere.w / scale, middle + sphere.w / scale);
    }
    ivec2 extent = covered.zw - covered.xy + 1;
    if (extent.x <= 0 || extent.y <= 0) continue;
    if (extent.x * extent.y > direct_texels) {
      uint slot = atomicAdd(large_pairs_found, 1u);
      if (slot < uint(queue_capacity)) {
        large_pairs[slot] = LargePair(triangle, layer, 0u, 0u);
        continue;
      }
    }
    draw_all(triangle, center, layer, covered);
  }
}
