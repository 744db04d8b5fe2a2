// What the first four moments of depths say about the depths.
// Source: Peters and Klein 2015, "Moment Shadow Mapping", I3D, doi:10.1145/2699276.2699277, recalled
// and checked against the law that it rests on: exactly one distribution with a given depth as one of
// three atoms has the moments at hand, and no other with these moments has less mass before it.

// The two other atoms, the nearer first, and the masses of all three; masses sum to 1.
struct Atoms {
  vec2 depth;
  vec2 mass;
  float own_mass;  // at the depth asked for
};

// Moments of what is spread evenly over [-1, 1].
const vec4 kEvenMoments = vec4(0.0, 1.0 / 3.0, 0.0, 1.0 / 5.0);

// moments: means of z, z^2, z^3, z^4, z in [-1, 1]. bias: share of kEvenMoments mixed in, which keeps
// the matrix positive definite in spite of rounding (the paper mixes in a vector of its own).
//
// The other atoms are the roots of the quadratic that is orthogonal to 1 and to x - z (Gauss-Radau
// nodes): its coefficients solve H c = (1, z, z^2), H the Hankel matrix of the moments, here by
// Cholesky decomposition (the paper's Algorithm).
Atoms atoms_of(vec4 moments, float z, float bias) {
  vec4 b = mix(moments, kEvenMoments, bias);
  float variance = b.y - b.x * b.x;
  float skew = b.z - b.x * b.y;
  float rest = (b.w - b.y * b.y) * variance - skew * skew;
  float l = skew / variance;
  vec3 c = vec3(1.0, z - b.x, z * z - b.y);
  c.z = (c.z - l * c.y) * variance / rest;
  c.y = c.y / variance - l * c.z;
  c.x -= dot(c.yz, b.xy);
  float center = -0.5 * c.y / c.z;
  float reach = sqrt(max(center * center - c.x / c.z, 0.0));
  Atoms atoms;
  atoms.depth = vec2(center - reach, center + reach);
  // Mass of an atom: the mean of the polynomial that is 1 there and 0 at the two others.
  vec2 other = atoms.depth.yx;
  atoms.mass = clamp((b.y - b.x * (z + other) + z * other) /
                         ((atoms.depth - z) * (atoms.depth - other)),
                     0.0, 1.0);
  atoms.own_mass = max(1.0 - atoms.mass.x - atoms.mass.y, 0.0);
  return atoms;
}
