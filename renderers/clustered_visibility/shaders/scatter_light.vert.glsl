// Pass: lights as points in the column of their cluster, two each: row 0 for the position, row 1 for
// the normal. In: virtual lights, assignments. Out: what is to be summed, in flat colours.

#include "renderers/many_lights/shaders/virtual_light.glsl"

layout(std430, binding = 3) readonly buffer VirtualLights { VirtualLight lights[]; };
layout(std430, binding = 4) readonly buffer Assignments { int assignments[]; };

uniform int columns;
uniform vec3 bounds_min;  // m

layout(location = 0) flat out vec4 addend;  // (position above bounds_min, 1) or (normal, 0)

void main() {
  int light = gl_VertexID / 2;
  int row = gl_VertexID % 2;
  int c = assignments[light];
  addend = row == 0 ? vec4(lights[light].position.xyz - bounds_min, 1.0)
                    : vec4(lights[light].geometric_normal.xyz, 0.0);
  vec2 place = (vec2(c, row) + 0.5) / vec2(columns, 2);
  gl_Position = c < 0 ? vec4(2.0, 2.0, 0.5, 1.0) : vec4(2.0 * place - 1.0, 0.5, 1.0);
}
