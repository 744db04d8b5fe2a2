// Pass: the triangles' planes over the raster, a thread per triangle, in double precision as the
// CPU's rasteriser has them. In: triangles, frame. Out: planes.

#include "renderers/ray_bundles/shaders/bundle_triangles.glsl"
#include "renderers/ray_bundles/shaders/thread_index.glsl"

layout(std430, binding = 0) readonly buffer Triangles { SourceTriangle triangles[]; };
layout(std430, binding = 1) writeonly buffer Planes { TrianglePlane planes[]; };

uniform uint triangle_count;

void main() {
  uint index = thread_index();
  if (index >= triangle_count) return;
  SourceTriangle source = triangles[index];
  dvec3 right = dvec3(axis_x) / double(pixel_m);
  dvec3 up = dvec3(axis_y) / double(pixel_m);
  dvec3 origin = dvec3(corner);
  dvec3 along = dvec3(direction);
  dvec2 places[3];
  double depths[3];
  for (int i = 0; i < 3; ++i) {
    dvec3 p = dvec3(source.corners[i].xyz);
    places[i] = dvec2(dot(p, right), dot(p, up)) - dvec2(dot(origin, right), dot(origin, up));
    depths[i] = dot(p, along) - dot(origin, along);
  }
  // Weights of the second and third corner per pixel.
  dvec2 u = places[1] - places[0];
  dvec2 v = places[2] - places[0];
  double area = u.x * v.y - u.y * v.x;
  // Rounding to the raster may have given a line an area: its first corner stands for it.
  double scale = area != 0.0LF ? 1.0LF / area : 0.0LF;
  dvec2 second = scale * dvec2(v.y, -v.x);
  dvec2 third = scale * dvec2(-u.y, u.x);
  dvec2 along_u = dvec2(source.along.xy);
  dvec2 along_v = dvec2(source.along.zw);
  vec2 slope = vec2((depths[1] - depths[0]) * second + (depths[2] - depths[0]) * third);
  TrianglePlane plane;
  plane.origin = vec4(vec2(places[0]), source.corners[0].w, source.corners[1].w);
  plane.depth_m =
      vec4(float(depths[0]), slope, float(min(depths[0], min(depths[1], depths[2]))));
  plane.place_slopes = vec4(vec2(second.x * along_u + third.x * along_v),
                            vec2(second.y * along_u + third.y * along_v));
  plane.bounds = vec4(float(max(depths[0], max(depths[1], depths[2]))), 0.0, 0.0, 0.0);
  plane.weights = vec4(vec2(second), vec2(third));
  planes[index] = plane;
}
