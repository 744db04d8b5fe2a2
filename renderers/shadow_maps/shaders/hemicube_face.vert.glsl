// Pass: triangles in a face of a hemicube. In: the face's list, triangles, world space, m; origins.
// Out: clip space of the face, depth reversed without a far plane; the height above the clip height
// as a clip distance, which is linear here; the triangle's index.

#include "renderers/shadow_maps/shaders/hemicube.glsl"
#include "renderers/shadow_maps/shaders/triangle_clip.glsl"

layout(std430, binding = 5) readonly buffer FaceTriangles { uint face_triangles[]; };

uniform int layer;
uniform int face;
uniform int triangle_count;
uniform float nearest_m;  // surfaces nearer to the face's plane are not seen

layout(location = 0) flat out uint triangle_index;

void main() {
  int list = (layer * kHemicubeFaces + face) * triangle_count;
  triangle_index = face_triangles[list + gl_VertexID / 3];
  MapCenter center = map_center(layer);
  vec3 position = triangles[triangle_index].position[gl_VertexID % 3].xyz;
  vec3 local = (position - center.position) * hemisphere_frame(center.axis);
  vec3 view = hemicube_view(face, local);
  // The upper half of a side face fills its picture.
  float up = face == 0 ? view.y : 2.0 * view.y - view.z;
  gl_Position = vec4(view.x, up, nearest_m, view.z);
  bool is_kept = center.clip_m == 0.0 || is_spared(center, int(triangle_index));
  gl_ClipDistance[0] = is_kept ? 1.0 : local.z - center.clip_m;
}
