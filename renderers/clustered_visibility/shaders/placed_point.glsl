// Points of the scene's surfaces that receive light and send it on; PlacedPoint of re_emission.cpp.
// Texels of their receivers: point i has i (front) and point_count + i (back), row-major.

struct PlacedPoint {
  vec4 position;  // xyz: m; w: draw in [0, 1) that chooses between the sides
  ivec4 where;    // triangle; index of the light; 0, 0
};

layout(std430, binding = 4) readonly buffer PlacedPoints { PlacedPoint points[]; };

uniform int point_count;
uniform int width_px;  // of the receivers' textures

ivec2 texel_of(int receiver) { return ivec2(receiver % width_px, receiver / width_px); }
