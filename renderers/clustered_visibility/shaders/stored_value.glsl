// What to store in an image of format FORMAT so that the nearest number that it holds stays.

// OpenGL leaves the rounding of stores into normalised formats to the implementation, which may cut
// the fraction off. A quarter of a step beyond the number wanted ends there either way.
vec4 stored_value(vec4 value) {
#ifdef EIGHT_BITS
  vec4 steps = round(value * 127.0);
  return (steps + 0.25 * sign(steps)) / 127.0;
#else
  return value;
#endif
}
