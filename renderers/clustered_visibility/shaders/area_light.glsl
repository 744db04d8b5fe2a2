// A virtual area light; AreaLight of light_clusters.h.

struct AreaLight {
  vec4 position;  // xyz: m; w: 1, or 0 without lights
  vec4 axis;      // unit length; w: clip height, m (MapOrigins of hemisphere_maps.h)
  vec4 shape;     // size D, m; depth units per metre; area, m2; number of lights
  vec4 flux;      // rgb: W; w: index of its first light among those sorted by cluster
};
