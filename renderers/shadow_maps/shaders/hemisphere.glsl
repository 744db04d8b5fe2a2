// Hemispheres of directions in a square: the stereographic ("paraboloid") projection
//
//   (x, y) = u.xy / (1 + u.z),   u = (2x, 2y, 1 - r2) / (1 + r2),   r2 = x^2 + y^2,
//
// of unit directions u in the frame of an axis (z). The hemisphere fills the unit disc; circles
// stay circles, angles are kept, d(omega) / d(x, y) = 4 / (1 + r2)^2. hemisphere_projection.h is
// the same in double precision.
// Source: Brabec et al. 2002, "Shadow Mapping for Hemispherical and Omnidirectional Light Sources",
// Sec. 3, recalled; the properties are those of the stereographic projection, derived.

// Columns: tangent, bitangent, axis; right-handed, orthonormal for a unit axis.
// Source: Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1), Listing 3. The
// sign is the sign bit, as that of copysign: it counts for -0.
mat3 hemisphere_frame(vec3 axis) {
  float s = (floatBitsToUint(axis.z) & 0x80000000u) != 0u ? -1.0 : 1.0;
  float a = -1.0 / (s + axis.z);
  float b = axis.x * axis.y * a;
  return mat3(vec3(1.0 + s * axis.x * axis.x * a, s * b, -s * axis.x),
              vec3(b, s + axis.y * axis.y * a, -axis.y), axis);
}

// Position of a direction of any length in the frame; its z must not be minus its length.
vec2 hemisphere_position(vec3 direction) {
  return direction.xy / (length(direction) + direction.z);
}

// Direction of a position, in the frame; its length is 1 + r2.
vec3 hemisphere_direction(vec2 position) {
  return vec3(2.0 * position, 1.0 - dot(position, position));
}

// Position at which a texel is sampled: its centre, or for centres beyond the rim the nearest point
// of the rim, so that no texel sees anything below the horizon.
vec2 hemisphere_texel_position(ivec2 texel, int size_px) {
  vec2 position = (2.0 * vec2(texel) + 1.0) / float(size_px) - 1.0;
  float r2 = dot(position, position);
  return r2 > 1.0 ? position * inversesqrt(r2) : position;
}

// Texel that holds a position.
ivec2 hemisphere_texel(vec2 position, int size_px) {
  return clamp(ivec2(floor((0.5 * position + 0.5) * float(size_px))), ivec2(0), ivec2(size_px - 1));
}

// Angle that a texel spans in the direction of the given cosine to the axis, rad: a texel is
// 2 / size wide, d(angle) / dr = 2 / (1 + r2), 1 + r2 = 2 / (1 + cosine).
float hemisphere_texel_angle(float cosine, int size_px) {
  return 2.0 * (1.0 + cosine) / float(size_px);
}
