// Means over boxes from summed-area tables (summed_area.comp.glsl), edges at any position: the sum
// is taken as linear between texels. What lies beyond the map's edges does not count.
// Needs the define TABLE_SCALE, fixed-point steps per unit.

// 16; a uniform, so that compilers keep the loop: unrolled in every mean it takes them a minute.
uniform int table_corners;

// Sum over all texels whose index is below `corner` in x and y.
ivec4 table_sum(isampler2DArray map, ivec2 corner, int layer) {
  if (any(lessThanEqual(corner, ivec2(0)))) return ivec4(0);
  return texelFetch(map, ivec3(corner - 1, layer), 0);
}

// The box's sum is that of the table at its corners with signs; between texels a corner is a mean
// of four. All differences are taken from one corner in integers, which is exact.
vec4 box_mean(isampler2DArray map, vec2 center, float width, int layer) {
  int side = textureSize(map, 0).x;
  vec2 half_width = vec2(0.5 * max(width * float(side), 1.0));
  vec2 least = clamp(center * float(side) - half_width, vec2(0.0), vec2(float(side)));
  vec2 greatest = clamp(center * float(side) + half_width, vec2(0.0), vec2(float(side)));
  vec2 area = greatest - least;
  ivec2 low = min(ivec2(floor(least)), ivec2(side - 1));
  ivec2 high = min(ivec2(floor(greatest)), ivec2(side - 1));
  vec2 low_part = least - vec2(low);
  vec2 high_part = greatest - vec2(high);
  int xs[4] = int[4](low.x, low.x + 1, high.x, high.x + 1);
  int ys[4] = int[4](low.y, low.y + 1, high.y, high.y + 1);
  float wx[4] = float[4](low_part.x - 1.0, -low_part.x, 1.0 - high_part.x, high_part.x);
  float wy[4] = float[4](low_part.y - 1.0, -low_part.y, 1.0 - high_part.y, high_part.y);
  ivec4 origin = table_sum(map, low, layer);
  vec4 sum = vec4(0.0);
  for (int corner = 0; corner < table_corners; ++corner) {
    int i = corner & 3;
    int j = corner >> 2;
    ivec4 apart = table_sum(map, ivec2(xs[i], ys[j]), layer) - origin;
    sum += wx[i] * wy[j] * vec4(apart);
  }
  return sum / (float(TABLE_SCALE) * area.x * area.y);
}
