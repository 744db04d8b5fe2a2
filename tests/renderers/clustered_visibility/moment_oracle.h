#pragma once

#include <array>

#include "tests/renderers/clustered_visibility/convolution_oracle.h"

/// Moments of depths and what they say about the depths, in double precision.
///
/// Source: Peters and Klein 2015, "Moment Shadow Mapping", I3D, for the idea. The atoms are derived
/// here from orthogonality (Gauss-Radau quadrature), not by the paper's Cholesky decomposition.
namespace test_clustered_visibility {

/// Means of 1, z, z^2, z^3, z^4.
using Moments = std::array<double, 5>;
/// @param kernel  z in [0, 1], taken to 2 z - 1
Moments moments_of(const Kernel& kernel);

/// Depths, the given one last, and masses that have the moments at hand.
struct MomentAtoms {
  std::array<double, 3> depth{};
  std::array<double, 3> mass{};
};
/// @param moments  of at least three depths
MomentAtoms atoms_of(const Moments& moments, double z);

/// Mass of the atoms before z: no distribution with these moments has less there.
double least_mass_before(const MomentAtoms& atoms);

}  // namespace test_clustered_visibility
