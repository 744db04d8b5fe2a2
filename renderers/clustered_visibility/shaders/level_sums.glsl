// Levels 2 and above of one quantity before they are rounded.

struct LevelSum {
  vec4 first;
  vec4 second;
};

layout(std430, binding = 6) buffer LevelSums { LevelSum level_sums[]; };

uniform int map_size_px;  // a power of two

int level_side(int level) { return map_size_px >> level; }

// Levels of a layer lie behind each other, level 2 first: 4^-2 + 4^-3 + ... of a map's texels.
int level_index(int level, ivec2 texel, int layer) {
  int side = level_side(level);
  int all = (level_side(2) * level_side(2) * 4 - 1) / 3;
  int before = all - (side * side * 4 - 1) / 3;
  return layer * all + before + texel.y * side + texel.x;
}
