// Pass: triangles in a face of a hemicube. In: the triangle's index. Out: the same, r32ui.

layout(location = 0) flat in uint triangle_index;
layout(location = 0) out uint out_triangle;

void main() { out_triangle = triangle_index; }
