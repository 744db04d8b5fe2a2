// Centres of hemispherical maps: layer i is seen from origin first_origin + i (MapOrigins).

layout(std430, binding = 3) readonly buffer MapOriginWords { vec4 map_origin_words[]; };

uniform int origin_stride;  // in vec4
uniform int first_origin;
uniform int layer_count;
uniform float near_m;       // of the centre above the origin, along the axis

struct MapCenter {
  vec3 position;
  vec3 axis;
  float clip_m;  // surfaces less high above the centre, along the axis, are not seen; 0: all are
  bool clips_behind;  // only of surfaces that turn their backs to the centre
  bool is_empty;
};

MapCenter map_center(int layer) {
  int word = (first_origin + layer) * origin_stride;
  vec4 origin = map_origin_words[word];
  vec4 axis = map_origin_words[word + 1];
  return MapCenter(origin.xyz + near_m * axis.xyz, axis.xyz, abs(axis.w), axis.w < 0.0,
                   origin.w == 0.0);
}

// Whether a surface of this height above the centre is left out. Without a clip height none is, not
// even one that rounding puts below the horizon.
bool is_clipped(MapCenter center, float height_m) {
  return center.clip_m > 0.0 && height_m < center.clip_m;
}

// The same whichever way the surface faces.
bool is_surely_clipped(MapCenter center, float height_m) {
  return !center.clips_behind && is_clipped(center, height_m);
}
