// Pass: the scene drawn along a bundle. In: triangles, world space, m; frame. Out: corners in a
// raster of size_px pixels, row 0 at the bottom; depth is not the rasteriser's affair.
// Source: Hermes et al. 2010, Sec. 4.2.

#include "renderers/ray_bundles/shaders/bundle_triangles.glsl"

layout(std430, binding = 0) readonly buffer Triangles { SourceTriangle triangles[]; };

uniform vec2 size_px;  // of the whole raster

// The same in every pass of a direction.
invariant gl_Position;

layout(location = 0) flat out uint triangle;

void main() {
  triangle = uint(gl_VertexID) / 3u;
  vec3 offset_m = triangles[triangle].corners[gl_VertexID % 3].xyz - corner;
  vec2 place_px = vec2(dot(offset_m, axis_x), dot(offset_m, axis_y)) / pixel_m;
  gl_Position = vec4(2.0 * place_px / size_px - 1.0, 0.5, 1.0);
}
