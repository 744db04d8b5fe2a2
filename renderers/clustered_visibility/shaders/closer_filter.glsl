// Means over boxes of a map's texels, one by one, each compared on the receiver's plane
// (hemisphere_map.glsl). What lies beyond the map's edges does not count. Boxes of more texels on a
// side than kMostSteps are looked at in as many steps: Mesa's software drivers end the loops of a
// thread after 65,535 turns in all.

const int kMostSteps = 16;

// Texels whose centres lie in the box; at least the one at its centre.
void box_texels(Kernel kernel, float width, int size_px, out ivec2 least, out ivec2 greatest) {
  vec2 center_px = kernel.center * float(size_px);
  ivec2 own = clamp(ivec2(floor(center_px)), ivec2(0), ivec2(size_px - 1));
  float half_px = 0.5 * width * float(size_px);
  least = clamp(ivec2(ceil(center_px - half_px - 0.5)), ivec2(0), own);
  greatest = clamp(ivec2(floor(center_px + half_px - 0.5)), own, ivec2(size_px - 1));
}

// Steps through a box along both axes, and the texel of one: the middle of its part of the box.
ivec2 steps_of(ivec2 least, ivec2 greatest) {
  return min(greatest - least + 1, ivec2(kMostSteps));
}
ivec2 texel_of_step(ivec2 at, ivec2 least, ivec2 greatest) {
  ivec2 size = greatest - least + 1;
  return least + ((2 * at + 1) * size) / (2 * min(size, ivec2(kMostSteps)));
}

// Distance of what a texel sees, m.
float texel_distance_m(ivec2 texel, int cluster) {
  return uintBitsToFloat(texelFetch(hemisphere_maps, ivec3(texel, cluster), 0).r);
}

float extent_m(Kernel kernel) {
  float cosine = kernel.local.z / kernel.distance_m;
  return hemisphere_texel_angle(cosine, textureSize(hemisphere_maps, 0).x) * kernel.distance_m;
}

// Mean depth of what lies before the receiver; the receiver's own where nothing does.
float blocker_depth(Kernel kernel, float width) {
  ivec2 least;
  ivec2 greatest;
  box_texels(kernel, width, textureSize(hemisphere_maps, 0).x, least, greatest);
  float extent = extent_m(kernel);
  float sum_m = 0.0;
  float count = 0.0;
  ivec2 steps = steps_of(least, greatest);
  for (int y = 0; y < steps.y; ++y) {
    for (int x = 0; x < steps.x; ++x) {
      ivec2 texel = texel_of_step(ivec2(x, y), least, greatest);
      float blocker_m = texel_distance_m(texel, kernel.cluster);
      if (blocker_m >= hemisphere_compared_m(texel, kernel.local, kernel.normal, extent)) continue;
      sum_m += blocker_m;
      count += 1.0;
    }
  }
  return count > 0.0 ? sum_m / count * kernel.depth / kernel.distance_m : kernel.depth;
}

float lit_share(Kernel kernel, float width, float blocker) {
  ivec2 least;
  ivec2 greatest;
  box_texels(kernel, width, textureSize(hemisphere_maps, 0).x, least, greatest);
  float extent = extent_m(kernel);
  float lit = 0.0;
  ivec2 steps = steps_of(least, greatest);
  for (int y = 0; y < steps.y; ++y) {
    for (int x = 0; x < steps.x; ++x) {
      ivec2 texel = texel_of_step(ivec2(x, y), least, greatest);
      float blocker_m = texel_distance_m(texel, kernel.cluster);
      float compared_m = hemisphere_compared_m(texel, kernel.local, kernel.normal, extent);
      lit += blocker_m >= compared_m ? 1.0 : 0.0;
    }
  }
  return lit / float(steps.x * steps.y);
}
