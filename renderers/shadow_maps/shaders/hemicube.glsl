// The upper half of a cube around a map's centre: the face above (0) and the upper halves of those
// towards +x, -x, +y, -y of the map's frame (1 to 4), each a perspective view of 90 degrees
// (Cohen and Greenberg 1985, "The Hemi-Cube", recalled). A layer's faces lie in a block of 2 x 1.5
// faces of the atlas; hemicube_maps.cpp knows the same places.

#include "renderers/shadow_maps/shaders/hemisphere.glsl"

const int kHemicubeFaces = 5;

uniform int face_px;        // width of a face, even
uniform int atlas_columns;  // blocks in a row of the atlas

// A direction as a face sees it: right, up, forward.
vec3 hemicube_view(int face, vec3 direction) {
  if (face == 0) return direction;
  if (face <= 2) return vec3(direction.y, direction.z, face == 1 ? direction.x : -direction.x);
  return vec3(direction.x, direction.z, face == 3 ? direction.y : -direction.y);
}

// The face that a direction of the hemisphere goes through.
int hemicube_face(vec3 direction) {
  vec2 across = abs(direction.xy);
  if (direction.z >= max(across.x, across.y)) return 0;
  if (across.x >= across.y) return direction.x >= 0.0 ? 1 : 2;
  return direction.y >= 0.0 ? 3 : 4;
}

// First pixel of a face, in the atlas.
ivec2 hemicube_corner(int face, int layer) {
  const ivec2 kHalves[kHemicubeFaces] =
      ivec2[](ivec2(0, 0), ivec2(2, 0), ivec2(2, 1), ivec2(0, 2), ivec2(2, 2));
  ivec2 block = ivec2(layer % atlas_columns, layer / atlas_columns) * ivec2(4, 3);
  return (block + kHalves[face]) * (face_px / 2);
}

ivec2 hemicube_size(int face) { return ivec2(face_px, face == 0 ? face_px : face_px / 2); }
