// Pass: the triangles that may be seen in each face of a layer's hemicube; a work group per layer.
// In: spheres around the triangles, world space, m; origins. Out: lists, in the same order in
// every run, since of two triangles at the same depth the first one drawn stays; draws of them.

#include "renderers/shadow_maps/shaders/hemicube.glsl"
#include "renderers/shadow_maps/shaders/map_origins.glsl"

layout(local_size_x = 64) in;

struct DrawCommand {
  uint vertex_count;
  uint instances;
  uint first_vertex;
  uint first_instance;
};

layout(std430, binding = 4) readonly buffer Spheres { vec4 spheres[]; };
layout(std430, binding = 5) writeonly buffer FaceTriangles { uint face_triangles[]; };
layout(std430, binding = 6) writeonly buffer Draws { DrawCommand draws[]; };

uniform int triangle_count;

const int kThreads = 64;
const int kRun = 32;  // triangles of a thread between two barriers, a bit each

shared uint counts[kHemicubeFaces][kThreads];  // then the places where a thread's triangles begin
shared uint ends[kHemicubeFaces];              // of the lists

// A face's sides lean by 45 degrees; `view` is the sphere's centre as the face sees it.
bool may_be_seen(int face, vec3 view, float radius) {
  float margin = 1.41421356 * radius;
  float low = face == 0 ? view.z + view.y + margin : view.y + radius;
  return view.z + radius > 0.0 && view.z - abs(view.x) + margin >= 0.0 &&
         view.z - view.y + margin >= 0.0 && low >= 0.0;
}

// Bits of a run's triangles in each face: those of the thread are kThreads apart.
void find_seen(MapCenter center, mat3 frame, int first, out uint seen[kHemicubeFaces]) {
  for (int face = 0; face < kHemicubeFaces; ++face) seen[face] = 0u;
  for (int i = 0; i < kRun; ++i) {
    int triangle = first + i * kThreads;
    if (triangle >= triangle_count) break;
    vec4 sphere = spheres[triangle];
    vec3 local = (sphere.xyz - center.position) * frame;
    if (local.z < -sphere.w || is_surely_clipped(center, local.z + sphere.w)) continue;
    for (int face = 0; face < kHemicubeFaces; ++face) {
      bool is_seen = may_be_seen(face, hemicube_view(face, local), sphere.w);
      seen[face] |= is_seen ? 1u << i : 0u;
    }
  }
}

void main() {
  int layer = int(gl_WorkGroupID.x);
  int thread = int(gl_LocalInvocationID.x);
  MapCenter center = map_center(layer);
  mat3 frame = hemisphere_frame(center.axis);
  int count = center.is_empty ? 0 : triangle_count;
  uint first_slot = uint(layer * kHemicubeFaces) * uint(triangle_count);
  if (thread < kHemicubeFaces) ends[thread] = first_slot + uint(thread) * uint(triangle_count);
  barrier();
  for (int base = 0; base < count; base += kThreads * kRun) {
    uint seen[kHemicubeFaces];
    find_seen(center, frame, base + thread, seen);
    for (int face = 0; face < kHemicubeFaces; ++face) {
      counts[face][thread] = uint(bitCount(seen[face]));
    }
    barrier();
    if (thread < kHemicubeFaces) {
      uint end = ends[thread];
      for (int i = 0; i < kThreads; ++i) {
        uint begin = end;
        end += counts[thread][i];
        counts[thread][i] = begin;
      }
      ends[thread] = end;
    }
    barrier();
    for (int face = 0; face < kHemicubeFaces; ++face) {
      uint slot = counts[face][thread];
      for (uint rest = seen[face]; rest != 0u; rest &= rest - 1u) {
        face_triangles[slot] = uint(base + findLSB(rest) * kThreads + thread);
        ++slot;
      }
    }
    barrier();
  }
  if (thread < kHemicubeFaces) {
    uint found = ends[thread] - first_slot - uint(thread) * uint(triangle_count);
    draws[layer * kHemicubeFaces + thread] = DrawCommand(3u * found, 1u, 0u, 0u);
  }
}
