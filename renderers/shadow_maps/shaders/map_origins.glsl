// Centres of hemispherical maps: layer i is seen from origin first_origin + i (MapOrigins).

layout(std430, binding = 3) readonly buffer MapOriginWords { vec4 map_origin_words[]; };

uniform int origin_stride;  // in vec4
uniform int first_origin;
uniform int layer_count;
uniform float near_m;       // of the centre above the origin, along the axis

struct MapCenter {
  vec3 position;
  vec3 axis;
  bool is_empty;
};

MapCenter map_center(int layer) {
  int word = (first_origin + layer) * origin_stride;
  vec4 origin = map_origin_words[word];
  vec3 axis = map_origin_words[word + 1].xyz;
  return MapCenter(origin.xyz + near_m * axis, axis, origin.w == 0.0);
}
