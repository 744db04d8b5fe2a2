// Geometry buffer: surface seen through a pixel's centre. Inputs: storage buffers of scene.glsl, m;
// the view (View of view.h). Outputs: the textures of GeometryBuffer.
//
// Position and weights come from the pixel's ray and the triangle's plane, not from interpolation:
// rasterisers move corners to a grid of 1/256 pixel.
#include "renderers/opengl/shaders/scene.glsl"

layout(location = 0) flat in int triangle_index;

layout(location = 0) out vec4 out_position;          // xyz: m; w: 1
layout(location = 1) out vec4 out_geometric_normal;  // w: material index
layout(location = 2) out vec4 out_shading_normal;    // w: 0
layout(location = 3) out vec4 out_albedo;            // w: 1 if glossy

uniform vec3 view_origin;
uniform vec3 view_forward;
uniform vec3 corner;      // from the forward axis to the picture's top left corner
uniform vec3 step_right;  // one pixel to the right
uniform vec3 step_down;   // one pixel down
uniform int is_orthographic;

void main() {
  Triangle triangle = triangles[triangle_index];
  vec3 normal = triangle.geometric_normal.xyz;
  vec3 across = corner + gl_FragCoord.x * step_right + gl_FragCoord.y * step_down;
  vec3 origin = is_orthographic != 0 ? view_origin + across : view_origin;
  vec3 direction = is_orthographic != 0 ? view_forward : view_forward + across;

  // The plane's point on the ray.
  float approach = dot(normal, direction);
  if (approach == 0.0) discard;
  float distance = dot(normal, triangle.position[0].xyz - origin) / approach;
  vec3 position = origin + distance * direction;

  vec3 weights = corner_weights(triangle, position);
  vec3 shading_normal = shading_normal_at(triangle, weights);
  float side = approach > 0.0 ? -1.0 : 1.0;
  int index = material_of(triangle);
  Material material = materials[index];

  out_position = vec4(position, 1.0);
  out_geometric_normal = vec4(side * normal, float(index));
  out_shading_normal = vec4(side * shading_normal, 0.0);
  out_albedo = vec4(albedo_at(material, uv_at(triangle, weights)),
                    any(greaterThan(material.lobe.rgb, vec3(0.0))) ? 1.0 : 0.0);
}
