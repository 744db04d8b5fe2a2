// Geometry buffer: places the corners of the scene's triangles. Input: storage buffers of
// scene.glsl, m. Output: clip space, reversed depth; the triangle's index.
#include "renderers/opengl/shaders/scene.glsl"

uniform mat4 clip_from_world;

layout(location = 0) flat out int triangle_index;

void main() {
  triangle_index = gl_VertexID / 3;
  vec3 position = triangles[triangle_index].position[gl_VertexID % 3].xyz;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
