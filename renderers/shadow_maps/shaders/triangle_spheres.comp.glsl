// Pass: the smallest sphere around each triangle.
// In: triangles, world space, m. Out: centre, w: radius, which covers the rounding.
// The sphere has the longest edge as its diameter if the angle opposite is not acute, else it is
// that of the circumcircle (derived).

#include "renderers/opengl/shaders/scene.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 4) writeonly buffer Spheres { vec4 spheres[]; };

uniform int triangle_count;

// Of the coordinates, relative: the centre and its differences to the vertices.
const float kRounding = 1.0e-6;

void main() {
  int triangle = int(gl_GlobalInvocationID.x);
  if (triangle >= triangle_count) return;
  vec3 a = triangles[triangle].position[0].xyz;
  vec3 b = triangles[triangle].position[1].xyz;
  vec3 c = triangles[triangle].position[2].xyz;
  float ab = dot(b - a, b - a);
  float bc = dot(c - b, c - b);
  float ca = dot(a - c, a - c);
  vec3 center = 0.5 * (a + b);
  if (ab >= bc + ca) {
    center = 0.5 * (a + b);
  } else if (bc >= ca + ab) {
    center = 0.5 * (b + c);
  } else if (ca >= ab + bc) {
    center = 0.5 * (c + a);
  } else {
    // Barycentrics of the circumcentre: a^2 (b^2 + c^2 - a^2) and its rotations, normalised.
    vec3 weight = vec3(bc * (ca + ab - bc), ca * (ab + bc - ca), ab * (bc + ca - ab));
    weight /= weight.x + weight.y + weight.z;
    center = a + weight.y * (b - a) + weight.z * (c - a);
  }
  float radius = sqrt(max(dot(a - center, a - center),
                          max(dot(b - center, b - center), dot(c - center, c - center))));
  vec3 extent = max(abs(a), max(abs(b), abs(c)));
  float largest = max(extent.x, max(extent.y, extent.z));
  spheres[triangle] = vec4(center, radius * (1.0 + kRounding) + largest * kRounding);
}
