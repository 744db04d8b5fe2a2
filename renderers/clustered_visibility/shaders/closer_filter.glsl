// Means over boxes of a map's texels, one by one. What lies beyond the map's edges does not count.

uniform float depth_bias;  // in the map's units

// Texels whose centres lie in the box; at least the one at its centre.
void box_texels(Kernel kernel, float width, int size_px, out ivec2 least, out ivec2 greatest) {
  vec2 center_px = kernel.center * float(size_px);
  ivec2 own = clamp(ivec2(floor(center_px)), ivec2(0), ivec2(size_px - 1));
  float half_px = 0.5 * width * float(size_px);
  least = clamp(ivec2(ceil(center_px - half_px - 0.5)), ivec2(0), own);
  greatest = clamp(ivec2(floor(center_px + half_px - 0.5)), own, ivec2(size_px - 1));
}

float texel_depth(ivec2 texel, int cluster) {
  return uintBitsToFloat(texelFetch(hemisphere_maps, ivec3(texel, cluster), 0).r) *
         area_lights[cluster].shape.y;
}

// Mean depth of what lies before the receiver; the receiver's own where nothing does.
float blocker_depth(Kernel kernel, float width) {
  ivec2 least;
  ivec2 greatest;
  box_texels(kernel, width, textureSize(hemisphere_maps, 0).x, least, greatest);
  float sum = 0.0;
  float count = 0.0;
  for (int y = least.y; y <= greatest.y; ++y) {
    for (int x = least.x; x <= greatest.x; ++x) {
      float z = texel_depth(ivec2(x, y), kernel.cluster);
      if (z >= kernel.depth - depth_bias) continue;
      sum += z;
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : kernel.depth;
}

float lit_share(Kernel kernel, float width, float blocker) {
  ivec2 least;
  ivec2 greatest;
  box_texels(kernel, width, textureSize(hemisphere_maps, 0).x, least, greatest);
  float lit = 0.0;
  for (int y = least.y; y <= greatest.y; ++y) {
    for (int x = least.x; x <= greatest.x; ++x) {
      if (texel_depth(ivec2(x, y), kernel.cluster) >= kernel.depth - depth_bias) lit += 1.0;
    }
  }
  ivec2 extent = greatest - least + 1;
  return lit / float(extent.x * extent.y);
}
