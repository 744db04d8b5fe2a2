// Pass: pieces of triangles into hemispherical maps. In: a triangle of vertex_map.vert.glsl. Out:
// the same, in its layer.

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

layout(location = 0) flat in int layer[];

void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Layer = layer[0];
    gl_Position = gl_in[i].gl_Position;
    gl_ClipDistance[0] = gl_in[i].gl_ClipDistance[0];
    EmitVertex();
  }
}
