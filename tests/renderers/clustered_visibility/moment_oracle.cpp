#include "tests/renderers/clustered_visibility/moment_oracle.h"

#include <cmath>
#include <cstddef>

namespace test_clustered_visibility {

Moments moments_of(const Kernel& kernel) {
  Moments moments{};
  for (const KernelTexel& texel : kernel) {
    double power = texel.weight;
    for (double& moment : moments) {
      moment += power;
      power *= 2.0 * texel.z - 1.0;
    }
  }
  return moments;
}

MomentAtoms atoms_of(const Moments& m, double z) {
  // Means of (x - z) x^i: q = x^2 + a x + b must be orthogonal to 1 and x under this weight.
  const auto weighted = [&](std::size_t i) { return m[i + 1] - z * m[i]; };
  const double determinant = weighted(1) * weighted(1) - weighted(0) * weighted(2);
  const double a = (weighted(0) * weighted(3) - weighted(1) * weighted(2)) / determinant;
  const double b = (weighted(2) * weighted(2) - weighted(1) * weighted(3)) / determinant;
  const double reach = std::sqrt(0.25 * a * a - b);
  MomentAtoms atoms{{-0.5 * a - reach, -0.5 * a + reach, z}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const double own = atoms.depth[i];
    const double first = atoms.depth[(i + 1) % 3];
    const double second = atoms.depth[(i + 2) % 3];
    atoms.mass[i] =
        (m[2] - m[1] * (first + second) + first * second) / ((own - first) * (own - second));
  }
  return atoms;
}

double least_mass_before(const MomentAtoms& atoms) {
  double mass = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (atoms.depth[i] < atoms.depth[2]) mass += atoms.mass[i];
  }
  return mass;
}

}  // namespace test_clustered_visibility
