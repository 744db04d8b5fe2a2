// Geometry-aware blur over the window of an interleaved gather; one pass, along rows or columns or
// over the whole window. Inputs: values (irradiance or radiance), positions (m) and shading normals
// of the same pixels. Output: the mean of the accepted values; 0 without a surface.
// A neighbour p' is accepted if it is a surface, |p - p'| < alpha and n . n' > beta; weights are 0
// and 1 (Segovia et al. 2006, Sec. 4); the pixel itself always counts.
//
// Taps reach from -BEFORE to +AFTER along the pass's axis, those at both ends with half the weight
// if HALF_ENDS. Rows across the axis: from -ROWS_BEFORE to +ROWS_AFTER. A thread makes kRun
// pixels in a line, which share their taps.
layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(binding = 0) uniform sampler2D position_map;
layout(binding = 1) uniform sampler2D normal_map;
layout(binding = 2) uniform sampler2D value_map;
layout(rgba32f, binding = 0) writeonly uniform image2D blurred;
uniform ivec2 size_px;
uniform ivec2 axis;    // (1, 0): rows; (0, 1): columns
uniform float alpha2;  // m2
uniform float beta;

const int kRun = 8;

// A surface in reach, and the pixels that may take it.
struct Neighbour {
  vec4 position;  // w: 0 where there is no surface
  vec3 normal;
  vec3 value;
};
struct Center {
  vec4 position;
  vec3 normal;
  vec4 sum;  // w: weight
};

void take(Neighbour neighbour, int offset, int row, inout Center center) {
  vec3 between = neighbour.position.xyz - center.position.xyz;
  bool is_alike = dot(between, between) < alpha2 && dot(neighbour.normal, center.normal) > beta;
  bool is_own = offset == 0 && row == 0;
  bool is_in_window = offset >= -BEFORE && offset <= AFTER;
  float weight = is_in_window && (is_alike || is_own) ? neighbour.position.w : 0.0;
#ifdef HALF_ENDS
  if (offset == -BEFORE || offset == AFTER) weight *= 0.5;
#endif
  center.sum += weight * vec4(neighbour.value, 1.0);
}

void main() {
  ivec2 across = axis.yx;
  ivec2 id = ivec2(gl_GlobalInvocationID.xy);
  ivec2 first = id * (axis * (kRun - 1) + 1);
  if (any(greaterThanEqual(first, size_px))) return;

  Center centers[kRun];
  for (int i = 0; i < kRun; ++i) {
    ivec2 pixel = min(first + i * axis, size_px - 1);
    centers[i].position = texelFetch(position_map, pixel, 0);
    centers[i].normal = texelFetch(normal_map, pixel, 0).xyz;
    centers[i].sum = vec4(0.0);
  }

  for (int row = -ROWS_BEFORE; row <= ROWS_AFTER; ++row) {
    for (int tap = -BEFORE; tap < kRun + AFTER; ++tap) {
      ivec2 pixel = first + tap * axis + row * across;
      ivec2 inside = clamp(pixel, ivec2(0), size_px - 1);
      Neighbour neighbour;
      neighbour.position = texelFetch(position_map, inside, 0);
      neighbour.normal = texelFetch(normal_map, inside, 0).xyz;
      neighbour.value = texelFetch(value_map, inside, 0).rgb;
      if (pixel != inside) neighbour.position.w = 0.0;
      // Written out: an array that is indexed by a variable lives in slow memory.
      take(neighbour, tap, row, centers[0]);
      take(neighbour, tap - 1, row, centers[1]);
      take(neighbour, tap - 2, row, centers[2]);
      take(neighbour, tap - 3, row, centers[3]);
      take(neighbour, tap - 4, row, centers[4]);
      take(neighbour, tap - 5, row, centers[5]);
      take(neighbour, tap - 6, row, centers[6]);
      take(neighbour, tap - 7, row, centers[7]);
    }
  }

  for (int i = 0; i < kRun; ++i) {
    ivec2 pixel = first + i * axis;
    if (any(greaterThanEqual(pixel, size_px))) return;
    bool is_surface = centers[i].position.w > 0.0;
    vec3 mean = is_surface ? centers[i].sum.rgb / centers[i].sum.w : vec3(0.0);
    imageStore(blurred, pixel, vec4(mean, is_surface ? 1.0 : 0.0));
  }
}
